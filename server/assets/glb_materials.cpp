#include "server/assets/glb_materials.hpp"

#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "server/assets/png_writer.hpp"

namespace tweend::assets {
namespace {

/// IEC 61966-2-1.
float linear_of(float srgb) {
  const double c = srgb;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

std::uint16_t wrap_name(model::TextureWrap wrap) {
  switch (wrap) {
    case model::TextureWrap::Repeat:
      return 10497;
    case model::TextureWrap::MirroredRepeat:
      return 33648;
    case model::TextureWrap::ClampToEdge:
      return 33071;
  }
  return 10497;
}

class MaterialWriter {
 public:
  explicit MaterialWriter(GlbDocument& document) : document_(document) {}

  Result<std::size_t> add(const model::Material& material, bool has_texcoords) {
    GlbMaterial out{.name = material.name};
    const glm::vec3& color = material.base_color;
    out.base_color = {linear_of(color.x), linear_of(color.y), linear_of(color.z), material.alpha};
    out.alpha_cutoff = material.alpha_cutoff;
    out.unlit = material.unlit;
    if (material.base_color_texture && has_texcoords) {
      TWEEND_ASSIGN(const std::size_t image, add_image(*material.base_color_texture));
      document_.textures.push_back({image, wrap_name(material.wrap_u), wrap_name(material.wrap_v)});
      out.texture = document_.textures.size() - 1;
    }
    document_.materials.push_back(std::move(out));
    return document_.materials.size() - 1;
  }

 private:
  Result<std::size_t> add_image(const model::Image& image) {
    if (const auto known = images_.find(image.hash()); known != images_.end()) return known->second;
    TWEEND_ASSIGN(const std::string png, write_png(image));
    document_.png_images.push_back(add_view(document_, std::as_bytes(std::span(png)), GlbUse::None));
    images_.emplace(image.hash(), document_.png_images.size() - 1);
    return document_.png_images.size() - 1;
  }

  GlbDocument& document_;
  std::map<model::ContentHash, std::size_t> images_;
};

}  // namespace

Result<std::vector<std::size_t>> add_materials(const model::Mesh& mesh, GlbDocument& document) {
  MaterialWriter writer(document);
  const bool has_texcoords = !mesh.texcoords().empty();
  std::vector<std::size_t> places;
  for (const model::Material& material : mesh.surface().materials) {
    TWEEND_ASSIGN(const std::size_t place, writer.add(material, has_texcoords));
    places.push_back(place);
  }
  if (places.empty()) {
    TWEEND_ASSIGN(const std::size_t place, writer.add(model::Material(), has_texcoords));
    places.push_back(place);
  }
  return places;
}

}  // namespace tweend::assets
