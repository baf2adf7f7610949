#include "server/assets/mtl_writer.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "server/assets/export_names.hpp"
#include "server/assets/png_writer.hpp"

namespace tweend::assets {
namespace {

std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name) plain += c > ' ' && c <= '~' && c != '#' ? c : '_';
  return plain.empty() ? "material" : plain;
}

/// Saves each picture once.
class Textures {
 public:
  Textures(std::string_view prefix, std::vector<NewFile>& files) : prefix_(prefix), files_(files) {}

  Result<std::string> name_of(const model::Image& image) {
    if (const auto known = names_.find(image.hash()); known != names_.end()) return known->second;
    TWEEND_ASSIGN(std::string png, write_png(image));
    std::string name = fmt::format("{}_{}.png", prefix_, names_.size());
    names_.emplace(image.hash(), name);
    files_.push_back({name, std::move(png)});
    return name;
  }

 private:
  std::string_view prefix_;
  std::vector<NewFile>& files_;
  std::map<model::ContentHash, std::string> names_;
};

}  // namespace

Result<MtlFiles> write_mtl(const model::Surface& surface, bool textured, std::string_view prefix) {
  MtlFiles out;
  if (surface.materials.empty()) return out;
  ExportNames names;
  Textures textures(prefix, out.files);
  std::string text;
  for (const model::Material& material : surface.materials) {
    out.names.push_back(names.unique(plain_name(material.name)));
    const glm::vec3& color = material.base_color;
    text += fmt::format("newmtl {}\nKd {} {} {}\n", out.names.back(), color.x, color.y, color.z);
    if (material.alpha < 1.0F) text += fmt::format("d {}\n", material.alpha);
    if (!textured || !material.base_color_texture) continue;
    TWEEND_ASSIGN(const std::string picture, textures.name_of(*material.base_color_texture));
    text += fmt::format("map_Kd {}\n", picture);
  }
  out.files.push_back({fmt::format("{}.mtl", prefix), std::move(text)});
  return out;
}

}  // namespace tweend::assets
