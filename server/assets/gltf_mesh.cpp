#include "server/assets/gltf_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "server/assets/gltf_skins.hpp"
#include "server/assets/unique_names.hpp"

namespace tweend::assets {
namespace {

/// Puts `more` behind `all`, of which there are `before` × `width` numbers already, or none: then zeros or ones stand for them.
void append(std::vector<float>& all, std::size_t before, std::size_t width, const std::vector<float>& more, float missing) {
  if (all.empty() && more.empty()) return;
  all.resize(before * width, missing);
  all.insert(all.end(), more.begin(), more.end());
}

class MeshBuilder {
 public:
  MeshBuilder(const GltfFile& file, const GltfScene& scene, GltfAccessors& accessors, GltfPrimitives& primitives,
              GltfMaterials& materials, const Limits& limits, GltfProgress& progress)
      : file_(file),
        scene_(scene),
        skins_(file, scene, accessors),
        primitives_(primitives),
        materials_(materials),
        limits_(limits),
        progress_(progress),
        room_{limits.vertices_per_actor, limits.triangles_per_actor, limits.morphed_vertices} {
    out_.weights_of_node.resize(file.count("nodes"));
  }

  Result<GltfMesh> build() {
    for (std::uint32_t joint = 0; joint < scene_.nodes.size(); ++joint) {
      const auto reference = scene_.nodes[joint].find("mesh");
      if (!reference) continue;
      TWEEND_ASSIGN(const JsonNode mesh, file_.refer(*reference, "meshes"));
      TWEEND_TRY(add_node(joint, mesh));
      progress_.part_done();
    }
    if (indices_.empty()) return std::move(out_);
    TWEEND_TRY(finish());
    return std::move(out_);
  }

 private:
  Status add_node(std::uint32_t joint, const JsonNode& mesh) {
    const JsonNode& node = scene_.nodes[joint];
    TWEEND_ASSIGN(const JsonNode primitives, mesh.get("primitives"));
    TWEEND_TRY(primitives.expect_array(1));
    const auto skin = node.find("skin");
    std::optional<GltfSkins::Run> run;
    std::optional<std::size_t> targets;
    const std::size_t first_vertex = vertices();
    const std::size_t first_target = targets_.size();
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      TWEEND_ASSIGN(std::optional<GltfPrimitive> primitive, primitives_.read(primitives.at(i), room_));
      if (!primitive) continue;
      if (!run) {
        TWEEND_ASSIGN(run, skin ? skins_.skin(*skin) : skins_.node(joint));
      }
      TWEEND_TRY(add_influences(primitives.at(i), *primitive, *run, skin.has_value()));
      if (!targets) {
        targets = primitive->targets.size();
        TWEEND_TRY(begin_targets(mesh, node, *targets, first_vertex));
      }
      if (primitive->targets.size() != *targets) {
        return primitives.at(i).error(fmt::format("expected {} morph targets as in the mesh's first primitive, found {}",
                                                  *targets, primitive->targets.size()));
      }
      add_targets(*primitive, first_target);
      add_shape(*primitive);
    }
    if (targets.value_or(0) > 0) {
      out_.weights_of_node[node.position()] = {static_cast<std::uint32_t>(first_target), static_cast<std::uint32_t>(*targets)};
    }
    return {};
  }

  [[nodiscard]] std::size_t vertices() const noexcept { return positions_.size() / 3; }

  void add_shape(const GltfPrimitive& p) {
    const std::size_t before = vertices();
    append(texcoords_, before, 2, p.texcoords, 0.0F);
    append(colors_, before, 4, p.colors, 1.0F);
    positions_.insert(positions_.end(), p.positions.begin(), p.positions.end());
    normals_.insert(normals_.end(), p.normals.begin(), p.normals.end());
    const auto first_index = static_cast<std::uint32_t>(indices_.size());
    for (const std::uint32_t i : p.indices) indices_.push_back(static_cast<std::uint32_t>(before) + i);
    const auto count = static_cast<std::uint32_t>(p.indices.size());
    if (!parts_.empty() && parts_.back().material == p.material) {
      parts_.back().index_count += count;
    } else {
      parts_.push_back({first_index, count, p.material});
    }
    if (!texcoords_.empty()) texcoords_.resize(2 * vertices(), 0.0F);
    if (!colors_.empty()) colors_.resize(4 * vertices(), 1.0F);
  }

  /// Brings all vertices to the same number of influences, those so far and those of `p`.
  Status add_influences(const JsonNode& at, const GltfPrimitive& p, const GltfSkins::Run& run, bool skinned) {
    const std::size_t own = skinned ? p.influences : 1;
    if (own == 0) return at.error("expected JOINTS_0 and WEIGHTS_0 for the skin of its node, found none");
    if (own > per_vertex_) widen(own);
    const std::size_t before = joints_.size();
    joints_.resize(before + p.vertex_count() * per_vertex_, static_cast<std::uint16_t>(run.first));
    weights_.resize(joints_.size(), 0.0F);
    for (std::size_t v = 0; v < p.vertex_count(); ++v) {
      if (!skinned) weights_[before + v * per_vertex_] = 1.0F;
      for (std::size_t i = 0; skinned && i < own; ++i) {
        const std::size_t joint = p.joints[v * own + i];
        if (joint >= run.count) {
          return at.error(fmt::format("expected joints below the {} of the skin, found {} at vertex {}", run.count, joint, v));
        }
        joints_[before + v * per_vertex_ + i] = static_cast<std::uint16_t>(run.first + joint);
        weights_[before + v * per_vertex_ + i] = p.weights[v * own + i];
      }
    }
    return {};
  }

  void widen(std::size_t per_vertex) {
    std::vector<std::uint16_t> joints(vertices() * per_vertex);
    std::vector<float> weights(joints.size(), 0.0F);
    for (std::size_t v = 0; v < vertices(); ++v) {
      for (std::size_t i = 0; i < per_vertex; ++i) {
        joints[v * per_vertex + i] = joints_[v * per_vertex_ + std::min(i, per_vertex_ - 1)];
        if (i < per_vertex_) weights[v * per_vertex + i] = weights_[v * per_vertex_ + i];
      }
    }
    joints_ = std::move(joints);
    weights_ = std::move(weights);
    per_vertex_ = per_vertex;
  }

  Status begin_targets(const JsonNode& mesh, const JsonNode& node, std::size_t count, std::size_t first_vertex) {
    if (count > limits_.morph_targets_per_actor - targets_.size()) {
      return mesh.error(fmt::format("expected at most {} more morph targets, found {}",
                                    limits_.morph_targets_per_actor - targets_.size(), count),
                        ErrorCode::Limit);
    }
    std::vector<float> weights(count, 0.0F);
    const auto own = node.find("weights");
    if (const auto given = own ? own : mesh.find("weights"); given && count > 0) {
      TWEEND_ASSIGN(weights, given->floats(count));
    }
    const auto extras = mesh.find("extras");
    const auto names = extras ? extras->find("targetNames") : std::nullopt;
    for (std::size_t i = 0; i < count; ++i) {
      model::MorphTarget target;
      // A convention of exporters, not the format's: what does not follow it is as good as nothing.
      if (names && i < names->size()) target.name = names->at(i).text() ? *names->at(i).text() : std::string_view();
      target.default_weight = weights[i];
      target.first_vertex = first_vertex;
      targets_.push_back(std::move(target));
      local_number_.push_back(i);
    }
    return {};
  }

  void add_targets(GltfPrimitive& p, std::size_t first_target) {
    for (std::size_t i = 0; i < p.targets.size(); ++i) {
      model::MorphTarget& target = targets_[first_target + i];
      const std::size_t before = vertices() - target.first_vertex;
      const auto extend = [&](std::vector<float>& all, const std::vector<float>& more) {
        append(all, before, 3, more, 0.0F);
        if (!all.empty()) all.resize(3 * (before + p.vertex_count()), 0.0F);
      };
      target.positions.resize(3 * before, 0.0F);
      target.positions.insert(target.positions.end(), p.targets[i].positions.begin(), p.targets[i].positions.end());
      target.positions.resize(3 * (before + p.vertex_count()), 0.0F);
      extend(target.normals, p.targets[i].normals);
      extend(target.tangents, p.targets[i].tangents);
    }
  }

  Status finish() {
    const auto own_error = [&](const Error& e) { return file_.root().error(e.message); };
    model::Surface surface{materials_.take(), std::move(parts_)};
    auto mesh =
        model::Mesh::make(vertices(), std::move(indices_), std::move(texcoords_), std::move(surface), std::move(colors_));
    if (!mesh) return own_error(mesh.error());
    out_.mesh = *mesh;
    auto rest = model::VertexKey::make(**mesh, positions_, normals_);
    if (!rest) return own_error(rest.error());
    out_.rest = *rest;
    auto skin = model::Skin::make(skins_.take(), per_vertex_, std::move(joints_), std::move(weights_), positions_);
    if (!skin) return own_error(skin.error());
    out_.skin = *skin;
    if (targets_.empty()) return {};
    std::vector<std::string> names;
    for (model::MorphTarget& target : targets_) names.push_back(std::move(target.name));
    names = make_unique(std::move(names), [&](std::size_t i) { return fmt::format("target_{}", local_number_[i]); });
    for (std::size_t i = 0; i < names.size(); ++i) targets_[i].name = std::move(names[i]);
    auto morphs = model::MorphTargets::make(std::move(targets_), vertices());
    if (!morphs) return own_error(morphs.error());
    out_.morphs = *morphs;
    return {};
  }

  const GltfFile& file_;
  const GltfScene& scene_;
  GltfSkins skins_;
  GltfPrimitives& primitives_;
  GltfMaterials& materials_;
  const Limits& limits_;
  GltfProgress& progress_;
  GltfRoom room_;
  std::vector<float> positions_, normals_, texcoords_, colors_;
  std::vector<std::uint32_t> indices_;
  std::vector<model::MeshPart> parts_;
  std::size_t per_vertex_ = 1;
  std::vector<std::uint16_t> joints_;
  std::vector<float> weights_;
  std::vector<model::MorphTarget> targets_;
  std::vector<std::size_t> local_number_;  ///< of each target, in its mesh
  GltfMesh out_;
};

}  // namespace

Result<GltfMesh> read_gltf_mesh(const GltfFile& file, const GltfScene& scene, GltfAccessors& accessors,
                                GltfPrimitives& primitives, GltfMaterials& materials, const Limits& limits,
                                GltfProgress& progress) {
  return MeshBuilder(file, scene, accessors, primitives, materials, limits, progress).build();
}

}  // namespace tweend::assets
