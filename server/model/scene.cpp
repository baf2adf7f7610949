#include "server/model/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "server/model/actor_bounds.hpp"

namespace tweend::model {
namespace {

Bounds world_bounds(const Actor& actor) {
  Bounds model = model_bounds(actor);
  const Transform& transform = actor.settings.transform;
  const glm::vec3 a = model.min * transform.scale, b = model.max * transform.scale;
  model = {glm::min(a, b), glm::max(a, b)};
  if (actor.settings.spin_rad_s != 0.0) {  // what a full turn about the Y axis sweeps, which comes after the scale
    const glm::vec3 corner = glm::max(glm::abs(model.min), glm::abs(model.max));
    const float reach = std::hypot(corner.x, corner.z);
    model = {{-reach, model.min.y, -reach}, {reach, model.max.y, reach}};
  }
  const glm::mat4 matrix = world_from_model({transform.translation, transform.rotation, glm::vec3(1.0F)}, 0.0);
  std::optional<Bounds> world;
  for (int i = 0; i < 8; ++i) {
    const glm::vec4 corner((i & 1) != 0 ? model.max.x : model.min.x, (i & 2) != 0 ? model.max.y : model.min.y,
                           (i & 4) != 0 ? model.max.z : model.min.z, 1.0F);
    const glm::vec3 at(matrix * corner);
    world = world ? joined(*world, {at, at}) : Bounds{at, at};
  }
  return *world;
}

}  // namespace

ActorPtr Scene::find_actor(std::string_view actor) const noexcept {
  const auto at = std::find_if(actors.begin(), actors.end(), [actor](const ActorPtr& a) { return a->name == actor; });
  return at == actors.end() ? nullptr : *at;
}

std::optional<Bounds> visible_bounds(const Scene& scene) {
  std::optional<Bounds> all;
  for (const ActorPtr& actor : scene.actors) {
    if (!actor->settings.visible) continue;
    const Bounds own = world_bounds(*actor);
    all = all ? joined(*all, own) : own;
  }
  return all;
}

}  // namespace tweend::model
