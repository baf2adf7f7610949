#include "server/model/skin.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

namespace tweend::model {
namespace {

constexpr float kRounding = 1e-6F;

Status check_lengths(std::size_t entries, std::size_t per_vertex, std::size_t joints, std::size_t weights,
                     std::size_t vertices) {
  if (entries == 0 || entries > 65'536) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected 1 to 65536 matrices of a skin, found {}", entries));
  }
  if (per_vertex != 1 && per_vertex != 4 && per_vertex != 8) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected 1, 4 or 8 influences a vertex, found {}", per_vertex));
  }
  if (joints == vertices * per_vertex && weights == joints) return {};
  return fail(ErrorCode::InvalidParams, fmt::format("expected {} joints and weights for {} vertices, found {} and {}",
                                                    vertices * per_vertex, vertices, joints, weights));
}

/// Scales a vertex' weights to sum 1.
Status settle(std::span<const std::uint16_t> joints, std::span<float> weights, std::size_t entries, std::size_t vertex) {
  float sum = 0.0F;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (joints[i] >= entries) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected joints below {} of the skin, found {} at vertex {}", entries, joints[i], vertex));
    }
    if (!(weights[i] >= 0.0F) || !std::isfinite(weights[i])) {
      return fail(ErrorCode::InvalidParams, fmt::format("expected weights >= 0, found {} at vertex {}", weights[i], vertex));
    }
    sum += weights[i];
  }
  // As near to 1 as rounding leaves it: weights that were scaled once stay what they are.
  if (std::abs(sum - 1.0F) <= kRounding) return {};
  if (sum <= 0.0F || !std::isfinite(sum)) {
    for (float& w : weights) w = 0.0F;
    weights[0] = 1.0F;
  } else {
    for (float& w : weights) w /= sum;
  }
  return {};
}

}  // namespace

Result<SkinPtr> Skin::make(std::vector<SkinEntry> entries, std::size_t per_vertex, std::vector<std::uint16_t> joints,
                           std::vector<float> weights, std::span<const float> positions) {
  const std::size_t vertices = positions.size() / 3;
  TWEEND_TRY(check_lengths(entries.size(), per_vertex, joints.size(), weights.size(), vertices));
  const std::shared_ptr<Skin> skin(new Skin);
  constexpr float kFar = std::numeric_limits<float>::infinity();
  skin->entry_bounds_.assign(entries.size(), {glm::vec3(kFar), glm::vec3(-kFar)});
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::span<const std::uint16_t> own = std::span(joints).subspan(v * per_vertex, per_vertex);
    const std::span<float> of_own = std::span(weights).subspan(v * per_vertex, per_vertex);
    TWEEND_TRY(settle(own, of_own, entries.size(), v));
    const glm::vec3 at(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
    for (std::size_t i = 0; i < per_vertex; ++i) {
      if (of_own[i] <= 0.0F) continue;
      Bounds& box = skin->entry_bounds_[own[i]];
      box = {glm::min(box.min, at), glm::max(box.max, at)};
    }
  }
  skin->entries_ = std::move(entries);
  skin->per_vertex_ = per_vertex;
  skin->joints_ = std::move(joints);
  skin->weights_ = std::move(weights);
  std::vector<std::uint32_t> of_entries;
  std::vector<animation::Affine> matrices;
  for (const SkinEntry& e : skin->entries_) {
    of_entries.push_back(e.joint);
    matrices.push_back(e.joint_from_mesh);
  }
  const ContentHash a = hash_bytes(std::as_bytes(std::span(skin->joints_)));
  const ContentHash b = hash_bytes(std::as_bytes(std::span(skin->weights_)));
  const ContentHash c = hash_bytes(std::as_bytes(std::span(of_entries)));
  const ContentHash d = hash_bytes(std::as_bytes(std::span(matrices)));
  const std::array<std::uint64_t, 9> words{per_vertex, a.high, a.low, b.high, b.low, c.high, c.low, d.high, d.low};
  skin->hash_ = hash_bytes(std::as_bytes(std::span(words)));
  return SkinPtr(skin);
}

}  // namespace tweend::model
