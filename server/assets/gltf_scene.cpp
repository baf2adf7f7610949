#include "server/assets/gltf_scene.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "server/assets/gltf_transform.hpp"
#include "server/assets/unique_names.hpp"

namespace tweend::assets {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

class SceneReader {
 public:
  SceneReader(const GltfFile& file, const Limits& limits, GltfWarnings& warnings)
      : file_(file), limits_(limits), warnings_(warnings), parent_(file.count("nodes"), kNone) {}

  Result<GltfScene> read() {
    TWEEND_TRY(find_parents());
    TWEEND_TRY(refuse_cycles());
    TWEEND_ASSIGN(const std::vector<JsonNode> roots, find_roots());
    scene_.joint_of_node.resize(parent_.size());
    for (const JsonNode& root : roots) TWEEND_TRY(walk(root));
    name_joints();
    return std::move(scene_);
  }

 private:
  [[nodiscard]] JsonNode node_at(std::size_t i) const { return file_.root().find("nodes")->at(i); }

  Status find_parents() {
    if (parent_.empty()) return file_.root().error("expected at least one of \"nodes\", found none");
    for (std::uint32_t i = 0; i < parent_.size(); ++i) {
      const auto children = node_at(i).find("children");
      if (!children) continue;
      TWEEND_TRY(children->expect_array());
      for (std::size_t c = 0; c < children->size(); ++c) {
        TWEEND_ASSIGN(const std::size_t child, children->at(c).index(parent_.size(), "nodes"));
        if (parent_[child] != kNone) {
          return children->at(c).error(fmt::format(
              "expected a node without another parent, found /nodes/{}, a child of /nodes/{}", child, parent_[child]));
        }
        parent_[child] = i;
      }
    }
    return {};
  }

  /// Where every node has one parent at most, one that isn't above itself has a root above it.
  Status refuse_cycles() const {
    std::vector<std::uint32_t> seen_by(parent_.size(), kNone);  // the node whose way up came by
    for (std::uint32_t start = 0; start < parent_.size(); ++start) {
      for (std::uint32_t at = start; at != kNone; at = parent_[at]) {
        if (seen_by[at] == start) return node_at(at).error("expected a way up to a root, found a node that is above itself");
        if (seen_by[at] != kNone) break;  // from here the way is known to end
        seen_by[at] = start;
      }
    }
    return {};
  }

  Result<std::vector<JsonNode>> find_roots() const {
    std::vector<JsonNode> roots;
    if (file_.count("scenes") == 0) {
      for (std::size_t i = 0; i < parent_.size(); ++i) {
        if (parent_[i] == kNone) roots.push_back(node_at(i));
      }
      return roots;
    }
    std::size_t number = 0;
    if (const auto scene = file_.root().find("scene")) {
      TWEEND_ASSIGN(number, scene->index(file_.count("scenes"), "scenes"));
    }
    const JsonNode scene = file_.root().find("scenes")->at(number);
    TWEEND_ASSIGN(const JsonNode nodes, scene.get("nodes"));
    TWEEND_TRY(nodes.expect_array(1));
    std::vector<bool> listed(parent_.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      TWEEND_ASSIGN(const std::size_t index, nodes.at(i).index(parent_.size(), "nodes"));
      if (parent_[index] != kNone || listed[index]) {
        return nodes.at(i).error(fmt::format("expected a node without a parent, listed once; found /nodes/{} {}", index,
                                             listed[index] ? "again" : "to have one"));
      }
      listed[index] = true;
      roots.push_back(node_at(index));
    }
    return roots;
  }

  /// Adds `root` and what is below it; without recursion, since a file may be nothing but depth.
  Status walk(const JsonNode& root) {
    std::vector<std::pair<JsonNode, std::int32_t>> waiting{{root, -1}};
    while (!waiting.empty()) {
      const auto [node, parent] = waiting.back();
      waiting.pop_back();
      if (scene_.joints.size() >= limits_.joints_per_actor) {
        return node.error(fmt::format("expected at most {} nodes in the scene, found more", limits_.joints_per_actor),
                          ErrorCode::Limit);
      }
      const auto joint = static_cast<std::uint32_t>(scene_.joints.size());
      TWEEND_ASSIGN(const std::string_view name, node.text_or_empty("name"));
      TWEEND_ASSIGN(const animation::JointPose rest, read_gltf_transform(node, warnings_));
      scene_.joints.push_back({std::string(name), parent, rest});
      scene_.nodes.push_back(node);
      scene_.joint_of_node[node.position()] = joint;
      const auto children = node.find("children");
      for (std::size_t c = children ? children->size() : 0; c > 0; --c) {
        TWEEND_ASSIGN(const std::size_t child, children->at(c - 1).index(parent_.size(), "nodes"));
        waiting.emplace_back(node_at(child), static_cast<std::int32_t>(joint));
      }
    }
    return {};
  }

  void name_joints() {
    std::vector<std::string> names;
    for (model::Joint& joint : scene_.joints) names.push_back(std::move(joint.name));
    names = make_unique(std::move(names), [&](std::size_t i) { return fmt::format("node_{}", scene_.nodes[i].position()); });
    for (std::size_t i = 0; i < names.size(); ++i) scene_.joints[i].name = std::move(names[i]);
  }

  const GltfFile& file_;
  const Limits& limits_;
  GltfWarnings& warnings_;
  std::vector<std::uint32_t> parent_;  ///< shape [nodes of the file]
  GltfScene scene_;
};

}  // namespace

Result<GltfScene> read_gltf_scene(const GltfFile& file, const Limits& limits, GltfWarnings& warnings) {
  return SceneReader(file, limits, warnings).read();
}

}  // namespace tweend::assets
