#include "server/model/vertex_key.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "server/animation/vertex_normals.hpp"
#include "server/animation/vertex_tangents.hpp"

namespace tweend::model {
namespace {

Status check_block(std::span<const float> values, std::size_t vertex_count, const char* name) {
  if (values.size() != 3 * vertex_count) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected {} numbers for {} vertices, found {} for {}", 3 * vertex_count, vertex_count,
                            values.size(), values.size() / 3),
                name);
  }
  const auto bad = std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
  if (bad != values.end()) {
    const auto at = bad - values.begin();
    return fail(ErrorCode::InvalidParams, fmt::format("expected finite numbers, found {} at position {}", *bad, at), name);
  }
  return {};
}

// Unit length; false for a direction too short (or too long for its square) to have one.
bool normalise(float* xyz) noexcept {
  const double x = xyz[0], y = xyz[1], z = xyz[2];
  const double length = std::sqrt(x * x + y * y + z * z);
  if (!(length > 1e-30)) return false;
  for (int i = 0; i < 3; ++i) xyz[i] = static_cast<float>(xyz[i] / length);
  return true;
}

Status fill_normals(const Mesh& mesh, std::span<const float> positions, std::span<const float> given, std::span<float> out) {
  if (given.empty()) return animation::compute_normals(positions, mesh.indices(), out);
  std::copy(given.begin(), given.end(), out.begin());
  std::vector<float> computed;  // only where a given normal has no direction
  for (std::size_t i = 0; i < out.size(); i += 3) {
    if (normalise(&out[i])) continue;
    if (computed.empty()) {
      computed.resize(out.size());
      TWEEND_TRY(animation::compute_normals(positions, mesh.indices(), computed));
    }
    std::copy_n(&computed[i], 3, &out[i]);
  }
  return {};
}

Bounds bounds_of(std::span<const float> positions) noexcept {
  Bounds b{{positions[0], positions[1], positions[2]}, {positions[0], positions[1], positions[2]}};
  for (std::size_t i = 3; i < positions.size(); i += 3) {
    const glm::vec3 p(positions[i], positions[i + 1], positions[i + 2]);
    b.min = glm::vec3(std::min(b.min.x, p.x), std::min(b.min.y, p.y), std::min(b.min.z, p.z));
    b.max = glm::vec3(std::max(b.max.x, p.x), std::max(b.max.y, p.y), std::max(b.max.z, p.z));
  }
  return b;
}

}  // namespace

Result<VertexKeyPtr> VertexKey::make(const Mesh& mesh, std::span<const float> positions, std::span<const float> normals) {
  const std::size_t count = mesh.vertex_count();
  TWEEND_TRY(check_block(positions, count, "positions"));
  if (!normals.empty()) TWEEND_TRY(check_block(normals, count, "normals"));

  const std::shared_ptr<VertexKey> key(new VertexKey);
  key->vertex_count_ = count;
  const bool with_tangents = !mesh.texcoords().empty();
  key->block_.resize((with_tangents ? 9 : 6) * count);
  const std::span<float> block(key->block_);
  std::copy(positions.begin(), positions.end(), block.begin());
  const auto own_normals = block.subspan(3 * count, 3 * count);
  TWEEND_TRY(fill_normals(mesh, positions, normals, own_normals));
  if (with_tangents) {
    TWEEND_TRY(animation::compute_tangents(positions, own_normals, mesh.texcoords(), mesh.indices(), block.subspan(6 * count)));
  }
  key->bounds_ = bounds_of(positions);
  key->hash_ = hash_bytes(std::as_bytes(std::span(key->block_)));
  return VertexKeyPtr(key);
}

Result<VertexKeyPtr> VertexKey::from_block(const Mesh& mesh, std::vector<float> block) {
  const std::size_t expected = (mesh.texcoords().empty() ? 6 : 9) * mesh.vertex_count();
  const bool finite = std::all_of(block.begin(), block.end(), [](float v) { return std::isfinite(v); });
  if (block.size() != expected || !finite) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected {} finite numbers for {} vertices, found {}", expected,
                                                      mesh.vertex_count(), finite ? std::to_string(block.size()) : "others"));
  }
  const std::shared_ptr<VertexKey> key(new VertexKey);
  key->vertex_count_ = mesh.vertex_count();
  key->block_ = std::move(block);
  key->bounds_ = bounds_of(key->positions());
  key->hash_ = hash_bytes(std::as_bytes(std::span(key->block_)));
  return VertexKeyPtr(key);
}

std::span<const float> VertexKey::positions() const noexcept { return std::span(block_).first(3 * vertex_count_); }
std::span<const float> VertexKey::normals() const noexcept {
  return std::span(block_).subspan(3 * vertex_count_, 3 * vertex_count_);
}
std::span<const float> VertexKey::tangents() const noexcept { return std::span(block_).subspan(6 * vertex_count_); }

animation::VertexAttributes VertexKey::attributes() const noexcept { return {positions(), normals(), tangents()}; }

}  // namespace tweend::model
