#include "server/assets/glb_rig.hpp"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "server/assets/export_names.hpp"
#include "server/assets/rest_vertices.hpp"

namespace tweend::assets {
namespace {

GlbNode node_of(const model::Joint& joint, std::string name) {
  // Once more to unit length: readers are strict, and this costs nothing.
  const glm::dquat q = glm::normalize(glm::dquat(joint.rest.rotation));
  const glm::vec3& t = joint.rest.translation;
  const glm::vec3& s = joint.rest.scale;
  GlbNode node;
  node.name = std::move(name);
  node.translation = {t.x, t.y, t.z};
  node.rotation = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
  node.scale = {s.x, s.y, s.z};
  return node;
}

/// What clips or the skin say of a joint.
std::vector<bool> busy_joints(const model::Actor& actor) {
  std::vector<bool> busy(actor.model->joint_count(), false);
  if (actor.model->skin) {
    for (const model::SkinEntry& entry : actor.model->skin->entries()) busy[entry.joint] = true;
  }
  for (const model::Joint& joint : actor.model->skeleton->joints()) {
    if (joint.parent >= 0) busy[static_cast<std::size_t>(joint.parent)] = true;
  }
  for (const model::ClipPtr& clip : actor.clips) {
    for (const model::Keyframe& keyframe : clip->keyframes) {
      if (!keyframe.pose) break;
      for (const model::KeyedValue& v : keyframe.pose->values()) {
        if (v.channel.property != animation::Property::Weight) busy[v.channel.target] = true;
      }
    }
  }
  return busy;
}

std::optional<std::size_t> idle_root(const model::Actor& actor) {
  const std::vector<model::Joint>& joints = actor.model->skeleton->joints();
  const std::vector<bool> busy = busy_joints(actor);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].parent < 0 && !busy[j] && joints[j].rest == animation::JointPose()) return j;
  }
  return std::nullopt;
}

class RigWriter {
 public:
  RigWriter(const model::Actor& actor, GlbDocument& document) : actor_(actor), model_(*actor.model), document_(document) {}

  std::size_t write() {
    if (model_.skeleton) add_joint_nodes();
    const std::size_t mesh_node = model_.mesh ? find_mesh_node() : 0;
    if (model_.mesh && model_.skin && !rigid_joint(model_)) {
      document_.nodes[mesh_node].skin = add_skin();
      unite_roots(mesh_node);
    }
    return mesh_node;
  }

 private:
  std::size_t add_node(GlbNode node) {
    document_.nodes.push_back(std::move(node));
    return document_.nodes.size() - 1;
  }

  void add_joint_nodes() {
    const std::vector<model::Joint>& joints = model_.skeleton->joints();
    for (const model::Joint& joint : joints) add_node(node_of(joint, names_.unique(joint.name)));
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].parent < 0) {
        document_.roots.push_back(j);
      } else {
        document_.nodes[static_cast<std::size_t>(joints[j].parent)].children.push_back(j);
      }
    }
  }

  std::size_t find_mesh_node() {
    if (model_.skeleton) {
      if (const auto joint = rigid_joint(model_)) return *joint;
      if (const auto idle = idle_root(actor_)) return *idle;
    }
    document_.roots.push_back(add_node({names_.unique(actor_.name)}));
    return document_.roots.back();
  }

  /// The node that stands for an entry of the skin.
  std::size_t entry_node(std::size_t joint, std::vector<bool>& used) {
    if (!used[joint]) {
      used[joint] = true;
      return joint;
    }
    const std::size_t twin = add_node({names_.unique(document_.nodes[joint].name)});
    document_.nodes[joint].children.push_back(twin);
    return twin;
  }

  std::size_t add_skin() {
    GlbSkin skin;
    std::vector<float> matrices;
    std::vector<bool> used(model_.joint_count(), false);
    for (const model::SkinEntry& entry : model_.skin->entries()) {
      skin.joints.push_back(entry_node(entry.joint, used));
      const glm::mat4 columns = animation::to_mat4(entry.joint_from_mesh);
      for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) matrices.push_back(columns[c][r]);
      }
    }
    skin.inverse_bind_matrices = add_floats(document_, matrices, GlbShape::Mat4, GlbUse::None, false);
    document_.skins.push_back(std::move(skin));
    return document_.skins.size() - 1;
  }

  /// The joints of a skin need a common root; a mesh that has one hangs outside of it.
  void unite_roots(std::size_t mesh_node) {
    std::vector<std::size_t> others;
    std::ranges::copy_if(document_.roots, std::back_inserter(others), [&](std::size_t r) { return r != mesh_node; });
    if (others.size() < 2) return;
    const std::size_t root = add_node({names_.unique("root")});
    document_.nodes[root].children = std::move(others);
    document_.roots = {root, mesh_node};
  }

  const model::Actor& actor_;
  const model::Model& model_;
  GlbDocument& document_;
  ExportNames names_;
};

}  // namespace

std::size_t add_rig(const model::Actor& actor, GlbDocument& document) { return RigWriter(actor, document).write(); }

}  // namespace tweend::assets
