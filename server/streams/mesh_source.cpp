#include "server/streams/mesh_source.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace tweend::streams {
namespace {

/// A mesh that two models deform in different ways is two to the renderer; one that nothing deforms has its own name.
render::ResourceId id_of(const model::Model& model) {
  if (!model.skin && !model.morphs) return resource_id(model.mesh->hash());
  const model::ContentHash& mesh = model.mesh->hash();
  const model::ContentHash skin = model.skin ? model.skin->hash() : model::ContentHash{};
  const model::ContentHash morphs = model.morphs ? model.morphs->hash() : model::ContentHash{};
  const std::array<std::uint64_t, 6> words{mesh.high, mesh.low, skin.high, skin.low, morphs.high, morphs.low};
  return resource_id(model::hash_bytes(std::as_bytes(std::span(words))));
}

render::TextureWrap wrap_of(model::TextureWrap wrap) noexcept {
  switch (wrap) {
    case model::TextureWrap::Repeat:
      return render::TextureWrap::Repeat;
    case model::TextureWrap::MirroredRepeat:
      return render::TextureWrap::MirroredRepeat;
    case model::TextureWrap::ClampToEdge:
      return render::TextureWrap::ClampToEdge;
  }
  return render::TextureWrap::Repeat;
}

render::MaterialSource material_source(const model::Material& material, bool has_texcoords) {
  render::MaterialSource to;
  to.base_color = material.base_color;
  to.wrap_u = wrap_of(material.wrap_u);
  to.wrap_v = wrap_of(material.wrap_v);
  to.alpha = material.alpha;
  to.alpha_cutoff = material.alpha_cutoff;
  to.unlit = material.unlit;
  if (const model::ImagePtr& image = material.base_color_texture; image && has_texcoords) {
    to.base_color_texture = {resource_id(image->hash()), {image->width(), image->height()}, image->rgba()};
  }
  return to;
}

void add_surface(const model::Mesh& mesh, render::MeshSource& to) {
  for (const model::Material& material : mesh.surface().materials) {
    to.materials.push_back(material_source(material, !mesh.texcoords().empty()));
  }
  for (const model::MeshPart& part : mesh.surface().parts) {
    to.parts.push_back({part.first_index, part.index_count, part.material});
  }
  if (!to.parts.empty()) return;
  to.materials.push_back(material_source({}, false));
  to.parts.push_back(
      {0, static_cast<std::uint32_t>(mesh.indices().size()), static_cast<std::uint32_t>(to.materials.size() - 1)});
}

}  // namespace

render::MeshSourcePtr mesh_source(const model::ModelPtr& model) {
  const model::Mesh& mesh = *model->mesh;
  auto source = std::make_shared<render::MeshSource>();
  source->id = id_of(*model);
  source->vertex_count = mesh.vertex_count();
  source->indices = mesh.indices();
  source->texcoords = mesh.texcoords();
  source->colors = mesh.colors();
  if (model->skin) {
    const animation::SkinInfluences skin = model->skin->influences();
    source->skin = {skin.per_vertex, skin.entries, skin.weights};
  }
  if (model->morphs) {
    for (const animation::MorphTargetView& target : model->morphs->views()) {
      source->morphs.push_back({target.first_vertex, target.displacements.positions, target.displacements.normals});
    }
  }
  add_surface(mesh, *source);
  source->owner = model;
  return source;
}

}  // namespace tweend::streams
