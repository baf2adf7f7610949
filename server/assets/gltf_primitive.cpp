#include "server/assets/gltf_primitive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/vec3.hpp>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include "server/assets/flat_normals.hpp"
#include "server/assets/gltf_attribute_rules.hpp"

namespace tweend::assets {
namespace {

constexpr std::size_t kTriangles = 4;
constexpr std::size_t kTriangleStrip = 5;
constexpr std::size_t kTriangleFan = 6;

/// Three indices a triangle, from the list of a mode's vertices (glTF 2.0, section 3.7.2.1).
std::vector<std::uint32_t> triangulate(std::vector<std::uint32_t> list, std::size_t mode) {
  if (mode == kTriangles) return list;
  std::vector<std::uint32_t> triangles;
  triangles.reserve(3 * (list.size() - 2));
  for (std::size_t i = 0; i + 2 < list.size(); ++i) {
    if (mode == kTriangleStrip) {
      triangles.insert(triangles.end(), {list[i], list[i + 1 + i % 2], list[i + 2 - i % 2]});
    } else {
      triangles.insert(triangles.end(), {list[i + 1], list[i + 2], list[0]});
    }
  }
  return triangles;
}

std::uint32_t restart_value(GltfComponent component) noexcept {
  return component == GltfComponent::U8 ? 0xFFU : component == GltfComponent::U16 ? 0xFFFFU : 0xFFFFFFFFU;
}

Error no_room(const JsonNode& node, std::string_view what, std::size_t room, std::size_t found) {
  return node.error(fmt::format("expected at most {} more {}, found {}", room, what, found), ErrorCode::Limit);
}

/// Repeats the elements `from` (each `width` numbers) at the end.
template <class T>
void append_copies(std::vector<T>& values, std::size_t width, std::span<const std::uint32_t> from) {
  if (values.empty() || width == 0) return;
  values.reserve(values.size() + width * from.size());
  for (const std::uint32_t vertex : from) {
    for (std::size_t i = 0; i < width; ++i) values.push_back(values[vertex * width + i]);
  }
}

/// glTF asks for flat normals where a primitive has none: vertices that belong to triangles of several directions are
/// repeated behind the others.
Status flatten(const JsonNode& node, GltfRoom& room, GltfPrimitive& p) {
  FlatNormals flat = compute_flat_normals(p.positions, p.indices);
  if (flat.copies.size() > room.vertices) return no_room(node, "vertices", room.vertices, flat.copies.size());
  room.vertices -= flat.copies.size();
  append_copies(p.positions, 3, flat.copies);
  append_copies(p.texcoords, 2, flat.copies);
  append_copies(p.colors, 4, flat.copies);
  append_copies(p.joints, p.influences, flat.copies);
  append_copies(p.weights, p.influences, flat.copies);
  for (GltfTarget& target : p.targets) {
    append_copies(target.positions, 3, flat.copies);
    append_copies(target.normals, 3, flat.copies);
    append_copies(target.tangents, 3, flat.copies);
  }
  p.normals = std::move(flat.normals);
  return {};
}

}  // namespace

GltfPrimitives::GltfPrimitives(const GltfFile& file, GltfAccessors& accessors, GltfMaterials& materials, GltfWarnings& warnings)
    : accessors_(accessors), materials_(materials), warnings_(warnings), quantized_(file.uses("KHR_mesh_quantization")) {}

Result<std::optional<GltfPrimitive>> GltfPrimitives::read(const JsonNode& node, GltfRoom& room) {
  TWEEND_TRY(node.expect_object());
  TWEEND_ASSIGN(const std::size_t mode, node.whole_or("mode", kTriangles, 0, kTriangleFan));
  if (mode < kTriangles) {
    warnings_.add(node, "expected triangles, found points or lines: they are left out");
    return std::optional<GltfPrimitive>();
  }
  TWEEND_ASSIGN(const JsonNode attributes, node.get("attributes"));
  TWEEND_TRY(attributes.expect_object());
  if (!attributes.find("POSITION")) {
    warnings_.add(attributes, "expected a POSITION, found none: the primitive is left out");
    return std::optional<GltfPrimitive>();
  }
  GltfPrimitive out;
  TWEEND_TRY(read_shape(node, mode, room, out));
  TWEEND_ASSIGN(const GltfMaterial material, materials_.of_primitive(node));
  out.material = material.number;
  TWEEND_TRY(read_texcoords(attributes, material, out));
  TWEEND_TRY(read_colors(attributes, out));
  TWEEND_TRY(read_influences(attributes, out));
  TWEEND_TRY(read_targets(node, room, out));
  if (out.normals.empty()) TWEEND_TRY(flatten(node, room, out));
  return std::optional(std::move(out));
}

Status GltfPrimitives::read_shape(const JsonNode& node, std::size_t mode, GltfRoom& room, GltfPrimitive& out) {
  TWEEND_ASSIGN(const JsonNode attributes, node.get("attributes"));
  TWEEND_ASSIGN(const JsonNode position, attributes.get("POSITION"));
  TWEEND_ASSIGN(const GltfAccessor accessor, accessors_.describe(position, position_rule(quantized_)));
  if (accessor.count > room.vertices) {
    // Whose bytes back so many would have had to be looked at first: what is too long for its bytes is damaged.
    TWEEND_TRY(accessors_.check_backed(accessor));
    return no_room(accessor.node, "vertices", room.vertices, accessor.count);
  }
  room.vertices -= accessor.count;
  TWEEND_ASSIGN(out.positions, accessors_.floats(accessor));
  TWEEND_TRY(read_indices(node, mode, room, out));
  TWEEND_ASSIGN(out.normals, attribute(attributes, "NORMAL", accessor.count, normal_rule(quantized_)));
  return {};
}

Status GltfPrimitives::read_indices(const JsonNode& node, std::size_t mode, GltfRoom& room, GltfPrimitive& out) {
  const auto reference = node.find("indices");
  const auto most = mode == kTriangles ? 3 * room.triangles : room.triangles + 2;
  std::vector<std::uint32_t> list;
  if (reference) {
    TWEEND_ASSIGN(const GltfAccessor accessor, accessors_.describe(*reference, kIndexRule));
    if (accessor.count > most) {
      TWEEND_TRY(accessors_.check_backed(accessor));
      return no_room(accessor.node, "triangles", room.triangles, mode == kTriangles ? accessor.count / 3 : accessor.count - 2);
    }
    TWEEND_ASSIGN(list, accessors_.wholes(accessor));
    const std::uint32_t restart = restart_value(accessor.number.component);
    const auto bad =
        std::find_if(list.begin(), list.end(), [&](std::uint32_t i) { return i >= out.vertex_count() || i == restart; });
    if (bad != list.end()) {
      return accessor.node.error(
          fmt::format("expected indices below the {} vertices (and below {}, which restarts), found {} at place {}",
                      out.vertex_count(), restart, *bad, bad - list.begin()));
    }
  } else {
    if (out.vertex_count() > most) return no_room(node, "triangles", room.triangles, out.vertex_count() / 3);
    list.resize(out.vertex_count());
    std::iota(list.begin(), list.end(), 0U);
  }
  if (list.size() < 3 || (mode == kTriangles && list.size() % 3 != 0)) {
    return reference.value_or(node).error(fmt::format(
        "expected {}, found {}", mode == kTriangles ? "three vertices a triangle" : "at least three vertices", list.size()));
  }
  out.indices = triangulate(std::move(list), mode);
  room.triangles -= out.indices.size() / 3;
  return {};
}

Result<std::vector<float>> GltfPrimitives::attribute(const JsonNode& attributes, std::string_view name, std::size_t vertices,
                                                     const GltfAccessorRule& rule) {
  const auto reference = attributes.find(name);
  if (!reference) return std::vector<float>();
  TWEEND_ASSIGN(const GltfAccessor accessor, accessors_.describe(*reference, rule));
  TWEEND_TRY(expect_count(accessor, vertices, *reference));
  return accessors_.floats(accessor);
}

Status GltfPrimitives::read_texcoords(const JsonNode& attributes, const GltfMaterial& material, GltfPrimitive& out) {
  // Without a texture there is nothing to map; the first set is kept all the same, since another material may come.
  const std::string name = fmt::format("TEXCOORD_{}", material.texcoord.value_or(0));
  TWEEND_ASSIGN(out.texcoords, attribute(attributes, name, out.vertex_count(), texcoord_rule(quantized_)));
  for (std::size_t i = 0; i < out.texcoords.size(); i += 2) {
    const glm::dvec3 uv = material.uv_from_texcoord * glm::dvec3(out.texcoords[i], out.texcoords[i + 1], 1.0);
    out.texcoords[i] = static_cast<float>(uv.x);
    out.texcoords[i + 1] = static_cast<float>(1.0 - uv.y);
  }
  return expect_finite(out.texcoords, attributes);
}

Status GltfPrimitives::read_colors(const JsonNode& attributes, GltfPrimitive& out) {
  const auto reference = attributes.find("COLOR_0");
  if (!reference) return {};
  TWEEND_ASSIGN(const bool opaque, accessors_.has_type(*reference, "VEC3"));
  TWEEND_ASSIGN(std::vector<float> colors, attribute(attributes, "COLOR_0", out.vertex_count(), color_rule(opaque)));
  const std::size_t width = opaque ? 3 : 4;
  out.colors.resize(4 * out.vertex_count(), 1.0F);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    out.colors[i / width * 4 + i % width] = std::clamp(colors[i], 0.0F, 1.0F);
  }
  return {};
}

Status GltfPrimitives::read_influences(const JsonNode& attributes, GltfPrimitive& out) {
  if (!attributes.find("JOINTS_0")) return {};
  const bool second = attributes.find("JOINTS_1").has_value();
  if (attributes.find("JOINTS_2"))
    warnings_.add(attributes, "expected at most 8 joints a vertex, found more: they are left out");
  out.influences = second ? 8 : 4;
  out.joints.resize(out.influences * out.vertex_count());
  out.weights.resize(out.joints.size());
  for (std::size_t set = 0; set < out.influences / 4; ++set) {
    TWEEND_ASSIGN(const JsonNode joints_reference, attributes.get(fmt::format("JOINTS_{}", set)));
    TWEEND_ASSIGN(const JsonNode weights_reference, attributes.get(fmt::format("WEIGHTS_{}", set)));
    TWEEND_ASSIGN(const GltfAccessor joints_accessor, accessors_.describe(joints_reference, kJointsRule));
    TWEEND_TRY(expect_count(joints_accessor, out.vertex_count(), joints_reference));
    TWEEND_ASSIGN(const GltfAccessor weights_accessor, accessors_.describe(weights_reference, kWeightsRule));
    TWEEND_TRY(expect_count(weights_accessor, out.vertex_count(), weights_reference));
    TWEEND_ASSIGN(const std::vector<std::uint32_t> joints, accessors_.wholes(joints_accessor));
    TWEEND_ASSIGN(const std::vector<float> weights, accessors_.floats(weights_accessor));
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (weights[i] < 0.0F) {
        return weights_accessor.node.error(fmt::format("expected weights >= 0, found {} at vertex {}", weights[i], i / 4));
      }
      const std::size_t at = i / 4 * out.influences + set * 4 + i % 4;
      out.joints[at] = static_cast<std::uint16_t>(joints[i]);
      out.weights[at] = weights[i];
    }
  }
  return {};
}

Status GltfPrimitives::read_targets(const JsonNode& node, GltfRoom& room, GltfPrimitive& out) {
  const auto targets = node.find("targets");
  if (!targets) return {};
  TWEEND_TRY(targets->expect_array());
  const std::size_t vertices = out.vertex_count();
  for (std::size_t i = 0; i < targets->size(); ++i) {
    if (vertices > room.morphed_vertices)
      return no_room(targets->at(i), "vertices of morph targets", room.morphed_vertices, vertices);
    room.morphed_vertices -= vertices;
    TWEEND_TRY(targets->at(i).expect_object());
    GltfTarget target;
    const GltfAccessorRule rule = displacement_rule(quantized_);
    TWEEND_ASSIGN(target.positions, attribute(targets->at(i), "POSITION", vertices, rule));
    TWEEND_ASSIGN(target.normals, attribute(targets->at(i), "NORMAL", vertices, rule));
    TWEEND_ASSIGN(target.tangents, attribute(targets->at(i), "TANGENT", vertices, rule));
    out.targets.push_back(std::move(target));
  }
  return {};
}

}  // namespace tweend::assets
