#include "server/model/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tweend::model {

Result<MeshPtr> Mesh::make(std::size_t vertex_count, std::vector<std::uint32_t> indices, std::vector<float> texcoords) {
  if (vertex_count == 0) return fail(ErrorCode::InvalidParams, "expected at least one vertex, found none");
  if (indices.empty() || indices.size() % 3 != 0) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected three indices a triangle and at least one triangle, found {} indices", indices.size()));
  }
  const auto bad = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= vertex_count; });
  if (bad != indices.end()) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected indices below the {} vertices, found {} at position {}",
                                                      vertex_count, *bad, bad - indices.begin()));
  }
  if (!texcoords.empty() && texcoords.size() != 2 * vertex_count) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected {} numbers of texture coordinates for {} vertices, found {}",
                                                      2 * vertex_count, vertex_count, texcoords.size()));
  }
  const std::shared_ptr<Mesh> mesh(new Mesh);
  mesh->vertex_count_ = vertex_count;
  mesh->indices_ = std::move(indices);
  mesh->texcoords_ = std::move(texcoords);
  const ContentHash a = hash_bytes(std::as_bytes(std::span(mesh->indices_)));
  const ContentHash b = hash_bytes(std::as_bytes(std::span(mesh->texcoords_)));
  const std::uint64_t parts[] = {vertex_count, a.high, a.low, b.high, b.low};
  mesh->hash_ = hash_bytes(std::as_bytes(std::span(parts)));
  return MeshPtr(mesh);
}

}  // namespace tweend::model
