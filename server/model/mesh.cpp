#include "server/model/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace tweend::model {
namespace {

Status check_surface(const Surface& surface, std::size_t index_count) {
  std::size_t covered = 0;
  for (const MeshPart& part : surface.parts) {
    const bool follows = part.first_index == covered && part.index_count > 0 && part.index_count % 3 == 0;
    if (!follows || part.index_count > index_count - covered) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected a part of whole triangles from index {} of {}, found {} from {}", covered, index_count,
                              part.index_count, part.first_index));
    }
    if (part.material >= surface.materials.size()) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected one of {} materials, found {}", surface.materials.size(), part.material));
    }
    covered += part.index_count;
  }
  if (covered == index_count || (surface.parts.empty() && surface.materials.empty())) return {};
  return fail(ErrorCode::InvalidParams, fmt::format("expected parts of all {} indices, found {}", index_count, covered));
}

ContentHash hash_surface(const Surface& surface) {
  std::vector<std::uint64_t> words;
  for (const MeshPart& part : surface.parts) words.insert(words.end(), {part.first_index, part.index_count, part.material});
  for (const Material& material : surface.materials) {
    const ContentHash name = hash_bytes(std::as_bytes(std::span(material.name)));
    const ContentHash color = hash_bytes(std::as_bytes(std::span(&material.base_color, 1)));
    const ContentHash image = material.base_color_texture ? material.base_color_texture->hash() : ContentHash{};
    const std::array rest{material.alpha, material.alpha_cutoff.value_or(-1.0F), material.unlit ? 1.0F : 0.0F,
                          static_cast<float>(material.wrap_u), static_cast<float>(material.wrap_v)};
    const ContentHash other = hash_bytes(std::as_bytes(std::span(rest)));
    words.insert(words.end(), {name.high, name.low, color.high, color.low, image.high, image.low, other.high, other.low});
  }
  return hash_bytes(std::as_bytes(std::span(words)));
}

}  // namespace

Result<MeshPtr> Mesh::make(std::size_t vertex_count, std::vector<std::uint32_t> indices, std::vector<float> texcoords,
                           Surface surface, std::vector<float> colors) {
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
  if (!colors.empty() && colors.size() != 4 * vertex_count) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected {} numbers of colours for {} vertices, found {}",
                                                      4 * vertex_count, vertex_count, colors.size()));
  }
  TWEEND_TRY(check_surface(surface, indices.size()));
  const std::shared_ptr<Mesh> mesh(new Mesh);
  mesh->vertex_count_ = vertex_count;
  mesh->indices_ = std::move(indices);
  mesh->texcoords_ = std::move(texcoords);
  mesh->colors_ = std::move(colors);
  mesh->surface_ = std::move(surface);
  const ContentHash a = hash_bytes(std::as_bytes(std::span(mesh->indices_)));
  const ContentHash b = hash_bytes(std::as_bytes(std::span(mesh->texcoords_)));
  const ContentHash c = hash_surface(mesh->surface_);
  const ContentHash d = hash_bytes(std::as_bytes(std::span(mesh->colors_)));
  const std::uint64_t parts[] = {vertex_count, a.high, a.low, b.high, b.low, c.high, c.low, d.high, d.low};
  mesh->hash_ = hash_bytes(std::as_bytes(std::span(parts)));
  return MeshPtr(mesh);
}

}  // namespace tweend::model
