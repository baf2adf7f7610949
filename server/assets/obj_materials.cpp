#include "server/assets/obj_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "server/assets/asset_name.hpp"
#include "server/assets/mtl_reader.hpp"
#include "server/assets/obj_surface.hpp"
#include "server/assets/texture_reader.hpp"
#include "server/assets/token.hpp"

namespace tweend::assets {
namespace {

constexpr std::size_t kMaxWarnings = 16;
constexpr std::size_t kMaxLibraries = 256;    // names looked for
constexpr std::size_t kMaxFullTextures = 16;  // of Limits::texture_pixels each: a small file can hold a large picture
constexpr glm::vec3 kWhite{1.0F, 1.0F, 1.0F};

std::string_view folder_of(std::string_view name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string_view::npos ? std::string_view() : name.substr(0, slash);
}

/// The tokens of a `mtllib` statement, without a comment.
std::vector<std::string_view> split(std::string_view statement) {
  constexpr std::string_view kBlanks = " \t";
  std::vector<std::string_view> names;
  for (;;) {
    statement.remove_prefix(std::min(statement.find_first_not_of(kBlanks), statement.size()));
    if (statement.empty() || statement.front() == '#') return names;
    names.push_back(statement.substr(0, statement.find_first_of(kBlanks)));
    statement.remove_prefix(names.back().size());
  }
}

std::vector<bool> used_materials(const ObjFile& file) {
  std::vector<bool> used(file.material_names.size(), false);
  for (const ObjFace& face : file.faces) {
    if (face.material != kNoMaterial) used[static_cast<std::size_t>(face.material)] = true;
  }
  return used;
}

class Loader {
 public:
  Loader(const AssetRoot& root, const ObjFile& file, std::size_t max_bytes, const Limits& limits)
      : root_(root), file_(file), limits_(limits), bytes_left_(max_bytes), has_texcoords_(has_texcoords(file)) {}

  Result<ObjMaterials> load() {
    for (const std::string& statement : file_.material_libraries) TWEEND_TRY(read_libraries(statement));
    const std::vector<bool> used = used_materials(file_);
    std::vector<std::optional<model::Material>> materials(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      TWEEND_ASSIGN(materials[i], make_material(file_.material_names[i]));
    }
    if (left_out_ > 0) warnings_.push_back(fmt::format("{}: and {} more like these", file_.name, left_out_));
    return ObjMaterials{std::move(materials), std::move(warnings_)};
  }

 private:
  void warn(std::string_view expected, std::string_view found) {
    if (warnings_.size() < kMaxWarnings) {
      warnings_.push_back(fmt::format("{}: expected {}, found {}", file_.name, expected, found));
    } else {
      ++left_out_;
    }
  }

  /// The bytes of the file of that clean name, if there is one.
  Result<std::optional<std::string>> read_if_there(std::string_view name) {
    const auto entry = root_.find(name);
    if (entry && entry->directory) return std::optional<std::string>();
    auto bytes = root_.read_file(name, bytes_left_);
    if (!bytes && bytes.error().code == ErrorCode::NotFound) return std::optional<std::string>();
    if (!bytes) return bytes.error();
    bytes_left_ -= bytes->size();
    return std::optional(std::move(*bytes));
  }

  Status read_libraries(std::string_view statement) {
    TWEEND_ASSIGN(const bool whole, read_library(statement));
    if (whole) return {};
    const std::vector<std::string_view> names = split(statement);
    const bool one = names.size() == 1 && names.front() == statement;
    if (one || names.empty()) {
      warn_of_library(statement);
      return {};
    }
    for (const std::string_view name : names) {
      TWEEND_ASSIGN(const bool there, read_library(name));
      if (!there) warn_of_library(name);
    }
    return {};
  }

  void warn_of_library(std::string_view name) {
    library_missing_ = true;
    warn(fmt::format("the material library {}", quoted_token(name)), "none: faces of its materials show the default one");
  }

  /// @return whether it is there
  Result<bool> read_library(std::string_view reference) {
    if (++libraries_ > kMaxLibraries) {
      return fail(ErrorCode::Limit,
                  fmt::format("{}: expected at most {} names of material libraries, found more", file_.name, kMaxLibraries));
    }
    const std::optional<std::string> name = resolve_name(folder_of(file_.name), reference);
    if (!name) return false;
    if (read_.contains(*name)) return true;
    TWEEND_ASSIGN(const std::optional<std::string> text, read_if_there(*name));
    if (!text) return false;
    read_.insert(*name);
    TWEEND_ASSIGN(std::vector<MtlMaterial> materials, read_mtl(*text, *name));
    for (MtlMaterial& material : materials) {
      std::string key = material.name;
      known_.insert_or_assign(std::move(key), std::move(material));
    }
    return true;
  }

  Result<std::optional<model::Material>> make_material(const std::string& name) {
    const auto known = known_.find(name);
    if (known == known_.end()) {
      // Of a missing library was told already; who exported it knows the rest.
      if (!library_missing_) {
        warn(fmt::format("the material {} in a library", quoted_token(name)), "none: its faces show the default one");
      }
      return std::optional<model::Material>();
    }
    const MtlMaterial& mtl = known->second;
    model::Material material;
    material.name = name;
    TWEEND_ASSIGN(material.base_color_texture, find_texture(mtl));
    if (mtl.diffuse) {
      material.base_color = glm::clamp(*mtl.diffuse, 0.0F, 1.0F);
    } else if (material.base_color_texture) {
      material.base_color = kWhite;
    }
    return std::optional(std::move(material));
  }

  /// @return null where there is none to show
  Result<model::ImagePtr> find_texture(const MtlMaterial& material) {
    if (material.diffuse_map.empty()) return model::ImagePtr();
    const std::string what =
        fmt::format("the texture {} of material {}", quoted_token(material.diffuse_map), quoted_token(material.name));
    if (!has_texcoords_) {
      warn(fmt::format("texture coordinates for {}", what), "none: it is not shown");
      return model::ImagePtr();
    }
    model::ImagePtr image;
    if (const auto name = resolve_name(folder_of(file_.name), material.diffuse_map)) {
      TWEEND_ASSIGN(image, load_texture(*name));
    }
    if (!image) warn(what, "none: it is not shown");
    return image;
  }

  /// @return null where there is no such file
  Result<model::ImagePtr> load_texture(const std::string& name) {
    if (const auto known = images_.find(name); known != images_.end()) return known->second;
    TWEEND_ASSIGN(const std::optional<std::string> bytes, read_if_there(name));
    model::ImagePtr image;
    if (bytes) {
      TWEEND_ASSIGN(image, read_texture(*bytes, name, limits_));
      TWEEND_TRY(count_pixels(*image));
    }
    images_.emplace(name, image);
    return image;
  }

  Status count_pixels(const model::Image& image) {
    pixels_ += std::uint64_t{image.width()} * image.height();
    // Divided, since a limit may be as large as any number.
    if ((pixels_ + kMaxFullTextures - 1) / kMaxFullTextures <= limits_.texture_pixels) return {};
    return fail(ErrorCode::Limit, fmt::format("{}: expected textures of at most {} x {} pixels together, found more",
                                              file_.name, kMaxFullTextures, limits_.texture_pixels));
  }

  const AssetRoot& root_;
  const ObjFile& file_;
  const Limits& limits_;
  std::size_t bytes_left_;
  bool has_texcoords_;
  bool library_missing_ = false;
  std::size_t libraries_ = 0;                                ///< names looked for
  std::uint64_t pixels_ = 0;                                 ///< of all `images_`
  std::unordered_set<std::string> read_;                     ///< libraries, by clean name
  std::unordered_map<std::string, MtlMaterial> known_;       ///< by name
  std::unordered_map<std::string, model::ImagePtr> images_;  ///< by clean name; null: there is no such file
  std::vector<std::string> warnings_;
  std::size_t left_out_ = 0;  ///< warnings
};

}  // namespace

Result<ObjMaterials> load_obj_materials(const AssetRoot& root, const ObjFile& file, std::size_t max_bytes,
                                        const Limits& limits) {
  return Loader(root, file, max_bytes, limits).load();
}

}  // namespace tweend::assets
