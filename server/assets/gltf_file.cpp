#include "server/assets/gltf_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "server/assets/gltf_container.hpp"

namespace tweend::assets {
namespace {

/// Extensions that change what a file's numbers mean: whoever does not know one can't read a file that requires it.
constexpr std::array<std::string_view, 4> kKnownExtensions{"EXT_meshopt_compression", "KHR_materials_unlit",
                                                           "KHR_mesh_quantization", "KHR_texture_transform"};

constexpr std::array<std::string_view, 12> kArrays{"accessors", "animations", "bufferViews", "buffers", "images", "materials",
                                                   "meshes",    "nodes",      "samplers",    "scenes",  "skins",  "textures"};

bool names(const JsonNode& root, std::string_view list, std::string_view extension) {
  const auto array = root.find(list);
  if (!array) return false;
  for (std::size_t i = 0; i < array->size(); ++i) {
    if (const auto name = array->at(i).text(); name && *name == extension) return true;
  }
  return false;
}

}  // namespace

Result<GltfFile> GltfFile::open(std::string_view bytes, std::string name, const Limits& limits) {
  TWEEND_ASSIGN(const GltfContainer container, open_gltf_container(bytes, name));
  TWEEND_ASSIGN(JsonDocument json, JsonDocument::parse(container.json, std::move(name), limits));
  GltfFile file(std::move(json));
  file.bin_ = container.bin;
  TWEEND_TRY(file.root().expect_object());
  TWEEND_TRY(file.check_version());
  TWEEND_TRY(file.check_extensions());
  TWEEND_TRY(file.check_arrays());
  return file;
}

/// "2.0" or another 2.x; `minVersion` says what of 2.x a reader has to know.
Status GltfFile::check_version() const {
  TWEEND_ASSIGN(const JsonNode asset, root().get("asset"));
  TWEEND_ASSIGN(const JsonNode version, asset.get("version"));
  TWEEND_ASSIGN(const std::string_view text, version.text());
  if (!text.starts_with("2.")) return version.expected("glTF version \"2.0\"");
  const auto least = asset.find("minVersion");
  if (!least) return {};
  TWEEND_ASSIGN(const std::string_view least_text, least->text());
  if (least_text != "2.0") return least->expected("a file that \"2.0\" is enough for");
  return {};
}

Status GltfFile::check_extensions() const {
  if (const auto used = root().find("extensionsUsed")) TWEEND_TRY(used->expect_array());
  const auto required = root().find("extensionsRequired");
  if (!required) return {};
  TWEEND_TRY(required->expect_array());
  for (std::size_t i = 0; i < required->size(); ++i) {
    TWEEND_ASSIGN(const std::string_view extension, required->at(i).text());
    if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), extension) == kKnownExtensions.end()) {
      return required->at(i).expected(fmt::format("no other required extension than {}", fmt::join(kKnownExtensions, ", ")));
    }
  }
  return {};
}

Status GltfFile::check_arrays() const {
  for (const std::string_view name : kArrays) {
    const auto array = root().find(name);
    if (!array) continue;
    TWEEND_TRY(array->expect_array());
    for (std::size_t i = 0; i < array->size(); ++i) TWEEND_TRY(array->at(i).expect_object());
  }
  return {};
}

std::size_t GltfFile::count(std::string_view array) const noexcept {
  const auto found = root().find(array);
  return found ? found->size() : 0;
}

Result<JsonNode> GltfFile::refer(const JsonNode& reference, std::string_view array) const {
  TWEEND_ASSIGN(const std::size_t index, reference.index(count(array), array));
  return root().find(array)->at(index);
}

bool GltfFile::uses(std::string_view extension) const {
  return names(root(), "extensionsUsed", extension) || names(root(), "extensionsRequired", extension);
}

std::optional<JsonNode> find_extension(const JsonNode& node, std::string_view extension) {
  const auto extensions = node.find("extensions");
  return extensions ? extensions->find(extension) : std::nullopt;
}

}  // namespace tweend::assets
