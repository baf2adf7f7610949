#include "server/assets/gltf_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <string_view>
#include <utility>

#include "server/assets/texture_reader.hpp"

namespace tweend::assets {
namespace {

constexpr std::string_view kUnlit = "KHR_materials_unlit";
constexpr std::string_view kTransform = "KHR_texture_transform";
constexpr std::size_t kMostTexcoords = 1'000;
constexpr std::size_t kMaxFullTextures = 16;  // of Limits::texture_pixels each: a small file can hold a large picture

/// IEC 61966-2-1.
float srgb_from_linear(float linear) noexcept {
  const double c = std::clamp(static_cast<double>(linear), 0.0, 1.0);
  return static_cast<float>(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055);
}

Result<glm::dvec3> read_pair(const JsonNode& node, std::string_view key, double fallback) {
  const auto member = node.find(key);
  if (!member) return glm::dvec3(fallback, fallback, 0.0);
  TWEEND_ASSIGN(const std::vector<float> pair, member->floats(2));
  return glm::dvec3(pair[0], pair[1], 0.0);
}

/// translation · rotation · scale, as KHR_texture_transform has it: in its v-down coordinates.
Result<glm::dmat3> read_transform(const JsonNode& node) {
  TWEEND_ASSIGN(const glm::dvec3 offset, read_pair(node, "offset", 0.0));
  TWEEND_ASSIGN(const glm::dvec3 scale, read_pair(node, "scale", 1.0));
  TWEEND_ASSIGN(const double angle, node.number_or("rotation", 0.0));
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return glm::dmat3(glm::dvec3(c * scale.x, -s * scale.x, 0.0), glm::dvec3(s * scale.y, c * scale.y, 0.0),
                    glm::dvec3(offset.x, offset.y, 1.0));
}

Result<model::TextureWrap> read_wrap(const JsonNode& sampler, std::string_view key) {
  constexpr double kClampToEdge = 33071;
  constexpr double kMirroredRepeat = 33648;
  constexpr double kRepeat = 10497;
  TWEEND_ASSIGN(const double mode, sampler.number_or(key, kRepeat));
  if (mode == kRepeat) return model::TextureWrap::Repeat;
  if (mode == kMirroredRepeat) return model::TextureWrap::MirroredRepeat;
  if (mode == kClampToEdge) return model::TextureWrap::ClampToEdge;
  return sampler.find(key)->expected("33071, 33648 or 10497");
}

}  // namespace

Result<GltfMaterial> GltfMaterials::of_primitive(const JsonNode& primitive) {
  const auto reference = primitive.find("material");
  std::size_t index = file_.count("materials");
  if (reference) {
    TWEEND_ASSIGN(const JsonNode node, file_.refer(*reference, "materials"));
    index = node.position();
  }
  if (const auto known = known_.find(index); known != known_.end()) return known->second;
  GltfMaterial how;
  if (reference) {
    TWEEND_ASSIGN(const JsonNode node, file_.refer(*reference, "materials"));
    TWEEND_ASSIGN(how, read(node));
  } else {
    how.number = static_cast<std::uint32_t>(materials_.size());
    model::Material white;
    white.base_color = glm::vec3(1.0F);
    materials_.push_back(std::move(white));
  }
  known_.emplace(index, how);
  return how;
}

Result<GltfMaterial> GltfMaterials::read(const JsonNode& node) {
  GltfMaterial how;
  model::Material material;
  TWEEND_ASSIGN(const std::string_view name, node.text_or_empty("name"));
  material.name = name;
  material.base_color = glm::vec3(1.0F);
  if (const auto pbr = node.find("pbrMetallicRoughness")) TWEEND_TRY(read_color(*pbr, how, material));
  TWEEND_TRY(read_alpha(node, material));
  material.unlit = find_extension(node, kUnlit).has_value();
  how.number = static_cast<std::uint32_t>(materials_.size());
  materials_.push_back(std::move(material));
  return how;
}

Status GltfMaterials::read_color(const JsonNode& pbr, GltfMaterial& how, model::Material& material) {
  if (const auto factor = pbr.find("baseColorFactor")) {
    TWEEND_ASSIGN(const std::vector<float> c, factor->floats(4));
    material.base_color = {srgb_from_linear(c[0]), srgb_from_linear(c[1]), srgb_from_linear(c[2])};
    material.alpha = std::clamp(c[3], 0.0F, 1.0F);
  }
  if (const auto info = pbr.find("baseColorTexture")) return read_texture_info(*info, how, material);
  return {};
}

Status GltfMaterials::read_alpha(const JsonNode& node, model::Material& material) {
  const auto mode = node.find("alphaMode");
  if (!mode) return {};
  TWEEND_ASSIGN(const std::string_view text, mode->text());
  if (text == "MASK") {
    TWEEND_ASSIGN(const double cutoff, node.number_or("alphaCutoff", 0.5));
    material.alpha_cutoff = static_cast<float>(std::clamp(cutoff, 0.0, 2.0));
  } else if (text == "BLEND") {
    warnings_.add(*mode, "expected OPAQUE or MASK, found BLEND: it is drawn opaque");
  } else if (text != "OPAQUE") {
    return mode->expected("OPAQUE, MASK or BLEND");
  }
  return {};
}

Status GltfMaterials::read_texture_info(const JsonNode& info, GltfMaterial& how, model::Material& material) {
  TWEEND_ASSIGN(const JsonNode reference, info.get("index"));
  TWEEND_ASSIGN(const JsonNode texture, file_.refer(reference, "textures"));
  TWEEND_ASSIGN(how.texcoord, info.whole_or("texCoord", 0, 0, kMostTexcoords));
  if (const auto transform = find_extension(info, kTransform)) {
    TWEEND_ASSIGN(how.uv_from_texcoord, read_transform(*transform));
    TWEEND_ASSIGN(how.texcoord, transform->whole_or("texCoord", *how.texcoord, 0, kMostTexcoords));
  }
  TWEEND_TRY(read_sampler(texture, material));
  const auto source = texture.find("source");
  if (!source) {
    warnings_.add(texture, "expected a source that is PNG or JPEG, found none: it is left out");
    how.texcoord.reset();
    return {};
  }
  TWEEND_ASSIGN(material.base_color_texture, image(*source));
  return {};
}

Status GltfMaterials::read_sampler(const JsonNode& texture, model::Material& material) const {
  const auto reference = texture.find("sampler");
  if (!reference) return {};
  TWEEND_ASSIGN(const JsonNode sampler, file_.refer(*reference, "samplers"));
  TWEEND_ASSIGN(material.wrap_u, read_wrap(sampler, "wrapS"));
  TWEEND_ASSIGN(material.wrap_v, read_wrap(sampler, "wrapT"));
  return {};
}

Result<model::ImagePtr> GltfMaterials::image(const JsonNode& reference) {
  TWEEND_ASSIGN(const JsonNode node, file_.refer(reference, "images"));
  if (const auto known = images_.find(node.position()); known != images_.end()) return known->second;
  model::ImagePtr image;
  if (const auto uri = node.find("uri")) {
    TWEEND_ASSIGN(const std::string bytes, uris_.fetch(*uri));
    TWEEND_ASSIGN(image, read_texture(bytes, node.place(), limits_));
  } else {
    TWEEND_ASSIGN(const JsonNode view_reference, node.get("bufferView"));
    TWEEND_ASSIGN(const GltfView view, buffers_.view(view_reference));
    const std::string_view bytes(reinterpret_cast<const char*>(view.bytes.data()), view.bytes.size());
    TWEEND_ASSIGN(image, read_texture(bytes, node.place(), limits_));
  }
  pixels_ += std::uint64_t{image->width()} * image->height();
  // Divided, since a limit may be as large as any number.
  if ((pixels_ + kMaxFullTextures - 1) / kMaxFullTextures > limits_.texture_pixels) {
    return node.error(fmt::format("expected textures of at most {} x {} pixels together, found more", kMaxFullTextures,
                                  limits_.texture_pixels),
                      ErrorCode::Limit);
  }
  images_.emplace(node.position(), image);
  return image;
}

}  // namespace tweend::assets
