#include "server/streams/frame_composer.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tweend::streams {
namespace {

render::ResourceId id_of(const model::ContentHash& hash) noexcept { return {hash.high, hash.low}; }

render::KeySource key_source(const model::VertexKey& key) noexcept { return {id_of(key.hash()), key.block()}; }

render::MeshSourcePtr mesh_source(const model::MeshPtr& mesh) {
  auto source = std::make_shared<render::MeshSource>();
  source->id = id_of(mesh->hash());
  source->vertex_count = mesh->vertex_count();
  source->indices = mesh->indices();
  source->texcoords = mesh->texcoords();
  source->owner = mesh;
  for (const model::Material& material : mesh->surface().materials) {
    render::MaterialSource& to = source->materials.emplace_back();
    to.base_color = material.base_color;
    if (const model::ImagePtr& image = material.base_color_texture; image && !mesh->texcoords().empty()) {
      to.base_color_texture = {id_of(image->hash()), {image->width(), image->height()}, image->rgba()};
    }
  }
  for (const model::MeshPart& part : mesh->surface().parts) {
    source->parts.push_back({part.first_index, part.index_count, part.material});
  }
  if (source->parts.empty()) {
    source->materials.push_back({model::Material{}.base_color, {}});
    source->parts.push_back({0, static_cast<std::uint32_t>(mesh->indices().size()), 0});
  }
  return source;
}

render::View view_of(const model::Camera& camera, render::Size size) noexcept {
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  return {model::view_from_world(camera), model::clip_from_view(camera, aspect), camera.eye,
          glm::distance(camera.eye, camera.target)};
}

}  // namespace

model::Camera FrameComposer::camera_of(const model::ScenePtr& scene, const std::optional<model::CameraRequest>& own,
                                       render::Size size) {
  const model::Camera& of_scene = scene->settings.camera;
  if (!own) return of_scene;
  if (own->fit && fitted_ != scene) {
    fitted_ = scene;
    visible_ = model::visible_bounds(*scene);
  }
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  const auto placed = model::place(of_scene, *own, visible_, aspect);
  return placed ? *placed : of_scene;
}

void FrameComposer::compose(const stage::Show& show, const std::optional<model::CameraRequest>& camera, render::Size size,
                            render::Picture& out) {
  const model::SceneSettings& settings = show.scene->settings;
  const model::Light& light = settings.light;
  out.size = size;
  out.view = view_of(camera_of(show.scene, camera, size), size);
  out.light = {light.position, light.ambient, light.diffuse, light.specular, light.shininess};
  out.background = settings.background;
  out.grid = settings.grid;
  out.items.clear();
  meshes_.resize(show.actors.size());
  for (std::size_t i = 0; i < show.actors.size(); ++i) {
    if (show.actors[i].actor->settings.visible) add_actor(show.actors[i], i, out);
  }
}

void FrameComposer::add_actor(const stage::ActorShow& show, std::size_t index, render::Picture& out) {
  const model::Actor& actor = *show.actor;
  KnownMesh& known = meshes_[index];
  if (!actor.model->mesh) return;
  if (known.mesh != actor.model->mesh) known = {actor.model->mesh, mesh_source(actor.model->mesh)};
  render::DrawItem& item = out.items.emplace_back();
  item.mesh = known.source;
  item.world_from_model = model::world_from_model(actor.settings.transform, show.spin_angle_rad);
  if (show.clip->keyframes.empty()) {
    item.key[0] = key_source(*actor.model->rest);
    return;
  }
  const animation::KeyBlend blend = model::blend_at(actor, *show.clip, show.time_s);
  item.key_count = blend.count;
  item.nearest = blend.nearest;
  item.weight = blend.weight;
  item.keys_expected = show.clip->keyframes.size();
  for (std::uint32_t i = 0; i < blend.count; ++i) item.key[i] = key_source(*show.clip->keyframes[blend.key[i]].vertices);
}

}  // namespace tweend::streams
