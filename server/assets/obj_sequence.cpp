#include "server/assets/obj_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "server/animation/vertex_normals.hpp"
#include "server/assets/asset_name.hpp"
#include "server/assets/obj_surface.hpp"
#include "server/assets/obj_topology.hpp"
#include "server/assets/token.hpp"
#include "server/assets/vertex_classes.hpp"

namespace tweend::assets {
namespace {

constexpr std::int64_t kMaxFrame = std::int64_t{1} << 53U;  // whole numbers up to here are exact in a double

Status check_input(std::span<const ObjFile> files, std::span<const std::int64_t> frames, const Limits& limits) {
  if (files.empty() || files.size() != frames.size()) {
    return fail(ErrorCode::Internal, fmt::format("expected a frame number for each of one or more files, found {} for {}",
                                                 frames.size(), files.size()));
  }
  if (files.size() > limits.keyframes_per_clip) {
    return fail(ErrorCode::Limit,
                fmt::format("expected at most {} keyframes, found {} files", limits.keyframes_per_clip, files.size()));
  }
  if (std::adjacent_find(frames.begin(), frames.end(), std::greater_equal<>()) != frames.end()) {
    return fail(ErrorCode::Internal, "expected frame numbers in strictly ascending order");
  }
  for (const ObjFile& file : files.subspan(1)) TWEEND_TRY(check_same_topology(files.front(), file));
  return {};
}

VertexClasses find_vertices(std::span<const ObjFile> files) {
  const ObjFile& first = files.front();
  VertexClasses vertices(first.corners.size());
  vertices.split_by(first.corners, &ObjCorner::v);
  vertices.split_by(first.corners, &ObjCorner::vt);
  for (const ObjFile& file : files) vertices.split_by(file.corners, &ObjCorner::vn);
  return vertices;
}

/// Triangle corners as places in `file.corners`, each face fanned from its first corner. Shape [triangles × 3].
std::vector<std::uint32_t> fan(const ObjFile& file) {
  std::vector<std::uint32_t> places;
  places.reserve(3 * (file.corners.size() - 2 * file.faces.size()));
  for (const ObjFace& face : file.faces) {
    for (std::uint32_t i = 2; i < face.corner_count; ++i) {
      places.insert(places.end(), {face.first_corner, face.first_corner + i - 1, face.first_corner + i});
    }
  }
  return places;
}

/// Each vertex's first corner, as a place in the files' corners. Shape [vertices].
std::vector<std::uint32_t> first_corners(const VertexClasses& vertices) {
  std::vector<std::uint32_t> places;
  places.reserve(vertices.count());
  const auto vertex_of_corner = vertices.vertex_of_corner();
  for (std::uint32_t corner = 0; corner < vertex_of_corner.size(); ++corner) {
    if (vertex_of_corner[corner] == places.size()) places.push_back(corner);
  }
  return places;
}

void append_row(std::vector<float>& out, const std::vector<float>& rows, std::int32_t row, std::size_t width) {
  const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(width) * row;
  out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
}

/// Shape [vertices × 2]; empty where no corner has texture coordinates, (0, 0) where only some lack them.
std::vector<float> gather_texcoords(const ObjFile& file, std::span<const std::uint32_t> corners) {
  std::vector<float> out;
  if (!has_texcoords(file)) return out;
  out.reserve(2 * corners.size());
  for (const std::uint32_t corner : corners) {
    const std::int32_t vt = file.corners[corner].vt;
    if (vt < 0) {
      out.insert(out.end(), 2, 0.0F);
    } else {
      append_row(out, file.texcoords, vt, 2);
    }
  }
  return out;
}

std::vector<float> gather_positions(const ObjFile& file, std::span<const std::uint32_t> corners) {
  std::vector<float> out;
  out.reserve(3 * corners.size());
  for (const std::uint32_t corner : corners) append_row(out, file.positions, file.corners[corner].v, 3);
  return out;
}

/// Whether the corner has a normal that points somewhere.
bool has_normal(const ObjFile& file, const ObjCorner& corner) {
  if (corner.vn < 0) return false;
  const float* const n = &file.normals[3 * static_cast<std::size_t>(corner.vn)];
  return std::hypot(double{n[0]}, double{n[1]}, double{n[2]}) > 1e-30;
}

/// Shape [vertices × 3]. What is missing is computed per `v`, not per vertex: a seam of the texture doesn't show.
Result<std::vector<float>> gather_normals(const ObjFile& file, std::span<const std::uint32_t> corners,
                                          std::span<const std::uint32_t> v_indices) {
  std::vector<float> computed;
  std::vector<float> out;
  out.reserve(3 * corners.size());
  for (const std::uint32_t place : corners) {
    const ObjCorner& corner = file.corners[place];
    if (has_normal(file, corner)) {
      append_row(out, file.normals, corner.vn, 3);
      continue;
    }
    if (computed.empty()) {
      computed.resize(file.positions.size());
      TWEEND_TRY(animation::compute_normals(file.positions, v_indices, computed));
    }
    append_row(out, computed, corner.v, 3);
  }
  return out;
}

/// A lower layer's error, as one of the asset `name`.
Error asset_error(std::string_view name, const Error& error) {
  return fail(ErrorCode::BadAsset, fmt::format("{}: {}", name, error.message));
}

}  // namespace

Result<ObjModel> build_obj_model(std::string source, std::span<const ObjFile> files, std::span<const std::int64_t> frames,
                                 const Limits& limits, std::span<const std::optional<model::Material>> materials) {
  TWEEND_TRY(check_input(files, frames, limits));
  const VertexClasses vertices = find_vertices(files);
  if (vertices.count() > limits.vertices_per_actor) {
    return fail(ErrorCode::Limit,
                fmt::format("{}: expected at most {} vertices, found {} with their texture coordinates and normals", source,
                            limits.vertices_per_actor, vertices.count()));
  }
  const ObjFile& first = files.front();
  const std::vector<std::uint32_t> corners = first_corners(vertices);
  std::vector<std::uint32_t> indices = fan(first);
  std::vector<std::uint32_t> v_indices(indices.size());
  std::transform(indices.begin(), indices.end(), v_indices.begin(),
                 [&](std::uint32_t place) { return static_cast<std::uint32_t>(first.corners[place].v); });
  std::transform(indices.begin(), indices.end(), indices.begin(),
                 [&](std::uint32_t place) { return vertices.vertex_of_corner()[place]; });

  auto mesh =
      model::Mesh::make(vertices.count(), std::move(indices), gather_texcoords(first, corners), make_surface(first, materials));
  if (!mesh) return asset_error(source, mesh.error());
  ObjModel imported{std::move(source), std::move(*mesh), {}, {}};
  imported.keys.reserve(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    TWEEND_ASSIGN(const std::vector<float> normals, gather_normals(files[i], corners, v_indices));
    auto key = model::VertexKey::make(*imported.mesh, gather_positions(files[i], corners), normals);
    if (!key) return asset_error(files[i].name, key.error());
    imported.keys.push_back({static_cast<double>(frames[i]), std::move(*key)});
  }
  return imported;
}

std::optional<SequenceMember> parse_sequence_name(std::string_view file_name) {
  constexpr std::string_view kExtension = ".obj";
  if (!has_extension(file_name, kExtension)) return std::nullopt;
  file_name.remove_suffix(kExtension.size());
  const std::size_t underscore = file_name.rfind('_');
  if (underscore == std::string_view::npos || underscore == 0) return std::nullopt;
  const std::string_view digits = file_name.substr(underscore + 1);
  if (digits.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  const std::optional<std::int64_t> frame = parse_integer(digits);
  if (!frame || *frame > kMaxFrame) return std::nullopt;
  return SequenceMember{std::string(file_name.substr(0, underscore)), *frame};
}

}  // namespace tweend::assets
