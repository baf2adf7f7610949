#include "server/assets/gltf_reader.hpp"

#include <memory>
#include <utility>

#include "server/assets/gltf_accessors.hpp"
#include "server/assets/gltf_animations.hpp"
#include "server/assets/gltf_buffers.hpp"
#include "server/assets/gltf_file.hpp"
#include "server/assets/gltf_materials.hpp"
#include "server/assets/gltf_mesh.hpp"
#include "server/assets/gltf_primitive.hpp"
#include "server/assets/gltf_scene.hpp"
#include "server/assets/gltf_warnings.hpp"

namespace tweend::assets {
namespace {

/// Meshes as often as nodes show them, animations, and the whole.
std::size_t count_parts(const GltfFile& file, const GltfScene& scene) {
  std::size_t parts = 1 + file.count("animations");
  for (const JsonNode& node : scene.nodes) parts += node.find("mesh") ? 1U : 0U;
  return parts;
}

std::vector<std::string> texts_of(const JsonNode& root, std::string_view list) {
  std::vector<std::string> texts;
  const auto array = root.find(list);
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    if (const auto text = array->at(i).text()) texts.emplace_back(*text);
  }
  return texts;
}

}  // namespace

Result<model::ImportedModel> read_gltf(std::string_view bytes, const std::string& name, ReadSideFile read_side_file,
                                       std::size_t max_side_bytes, const Limits& limits, ImportProgress tell) {
  TWEEND_ASSIGN(const GltfFile file, GltfFile::open(bytes, name, limits));
  GltfUris uris(name, std::move(read_side_file), max_side_bytes);
  GltfWarnings warnings;
  GltfBuffers buffers(file, uris, limits);
  GltfAccessors accessors(file, buffers);
  GltfMaterials materials(file, uris, buffers, limits, warnings);
  GltfPrimitives primitives(file, accessors, materials, warnings);

  TWEEND_ASSIGN(GltfScene scene, read_gltf_scene(file, limits, warnings));
  GltfProgress progress(std::move(tell), count_parts(file, scene));
  TWEEND_ASSIGN(GltfMesh mesh, read_gltf_mesh(file, scene, accessors, primitives, materials, limits, progress));
  TWEEND_ASSIGN(std::vector<model::Clip> clips, read_gltf_animations(file, scene, mesh, accessors, limits, warnings, progress));
  if (clips.empty()) clips = model::empty_clips();
  auto skeleton = model::Skeleton::make(std::move(scene.joints));
  if (!skeleton) return file.root().error(skeleton.error().message);
  auto model = std::make_shared<const model::Model>(model::Model{
      std::move(mesh.mesh), std::move(mesh.rest), std::move(*skeleton), std::move(mesh.skin), std::move(mesh.morphs)});
  return model::ImportedModel{name, std::move(model), std::move(clips), warnings.take()};
}

Result<GltfFacts> read_gltf_facts(std::string_view bytes, const std::string& name, const Limits& limits) {
  TWEEND_ASSIGN(const GltfFile file, GltfFile::open(bytes, name, limits));
  GltfFacts facts;
  TWEEND_ASSIGN(const JsonNode asset, file.root().get("asset"));
  TWEEND_ASSIGN(facts.version, asset.text_or_empty("version"));
  TWEEND_ASSIGN(facts.generator, asset.text_or_empty("generator"));
  facts.extensions_used = texts_of(file.root(), "extensionsUsed");
  facts.extensions_required = texts_of(file.root(), "extensionsRequired");
  facts.scenes = file.count("scenes");
  facts.nodes = file.count("nodes");
  facts.meshes = file.count("meshes");
  facts.skins = file.count("skins");
  facts.animations = file.count("animations");
  facts.materials = file.count("materials");
  facts.textures = file.count("textures");
  facts.images = file.count("images");
  facts.cameras = file.count("cameras");
  return facts;
}

}  // namespace tweend::assets
