#include "server/assets/gltf_skins.hpp"

#include <fmt/format.h>

#include "server/animation/affine.hpp"
#include "server/assets/gltf_attribute_rules.hpp"

namespace tweend::assets {
namespace {

constexpr std::size_t kMostEntries = 65'536;
constexpr GltfAccessorRule kMatrixRule{"MAT4", gltf_numbers::kFloat};

/// @param m  16 numbers, column by column
animation::Affine affine_of(const float* m) {
  animation::Affine affine;
  for (std::size_t row = 0; row < 3; ++row) affine.rows[row] = {m[row], m[4 + row], m[8 + row], m[12 + row]};
  return affine;
}

}  // namespace

Status GltfSkins::check_room(const JsonNode& at, std::size_t count) const {
  if (count <= kMostEntries - entries_.size()) return {};
  return at.error(fmt::format("expected at most {} joints of all skins together, found more", kMostEntries), ErrorCode::Limit);
}

Result<GltfSkins::Run> GltfSkins::skin(const JsonNode& reference) {
  TWEEND_ASSIGN(const JsonNode node, file_.refer(reference, "skins"));
  if (const auto known = runs_.find(node.position()); known != runs_.end()) return known->second;
  TWEEND_ASSIGN(const JsonNode joints, node.get("joints"));
  TWEEND_TRY(joints.expect_array(1));
  TWEEND_TRY(check_room(joints, joints.size()));
  std::vector<float> matrices;
  if (const auto inverse = node.find("inverseBindMatrices")) {
    TWEEND_ASSIGN(const GltfAccessor accessor, accessors_.describe(*inverse, kMatrixRule));
    if (accessor.count < joints.size()) {
      return accessor.node.error(
          fmt::format("expected at least {} matrices for {}, found {}", joints.size(), joints.pointer(), accessor.count));
    }
    TWEEND_TRY(accessors_.check_backed(accessor));
    if (accessor.count > kMostEntries) {
      return accessor.node.error(fmt::format("expected at most {} matrices, found {}", kMostEntries, accessor.count),
                                 ErrorCode::Limit);
    }
    TWEEND_ASSIGN(matrices, accessors_.floats(accessor));
  }
  const Run run{entries_.size(), joints.size()};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    TWEEND_ASSIGN(const std::size_t joint_node, joints.at(i).index(scene_.joint_of_node.size(), "nodes"));
    const auto joint = scene_.joint_of_node[joint_node];
    if (!joint) return joints.at(i).error(fmt::format("expected a node of the default scene, found /nodes/{}", joint_node));
    model::SkinEntry entry{*joint, {}};
    if (!matrices.empty()) entry.joint_from_mesh = affine_of(&matrices[16 * i]);
    entries_.push_back(entry);
  }
  runs_.emplace(node.position(), run);
  return run;
}

Result<GltfSkins::Run> GltfSkins::node(std::uint32_t joint) {
  TWEEND_TRY(check_room(scene_.nodes[joint], 1));
  entries_.push_back({joint, {}});
  return Run{entries_.size() - 1, 1};
}

}  // namespace tweend::assets
