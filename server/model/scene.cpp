#include "server/model/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace tweend::model {
namespace {

Bounds joined(const Bounds& a, const Bounds& b) noexcept { return {glm::min(a.min, b.min), glm::max(a.max, b.max)}; }

bool may_overshoot(const Actor& actor, const Clip& clip) noexcept {
  for (std::size_t i = 0; i < clip.keyframes.size(); ++i) {
    if (clip.keyframes[i].easing) return true;
    if (effective_interpolation(actor, clip, i) == animation::Interpolation::CatmullRom) return true;
  }
  return false;
}

// Evenly spaced Catmull-Rom leaves the hull of its keys by at most an eighth of its size (the outer weights sum to
// -1/8 at u = 1/2); uneven keys and easing can go further, hence twice that.
Bounds widened(const Bounds& b) noexcept {
  const glm::vec3 margin = 0.25F * (b.max - b.min);
  return {b.min - margin, b.max + margin};
}

Bounds model_bounds(const Actor& actor) noexcept {
  std::optional<Bounds> all;
  for (const ClipPtr& clip : actor.clips) {
    if (clip->keyframes.empty()) continue;
    Bounds own = clip->keyframes.front().vertices->bounds();
    for (const Keyframe& k : clip->keyframes) own = joined(own, k.vertices->bounds());
    if (may_overshoot(actor, *clip)) own = widened(own);
    all = all ? joined(*all, own) : own;
  }
  return all.value_or(actor.rest->bounds());
}

Bounds world_bounds(const Actor& actor) noexcept {
  Bounds model = model_bounds(actor);
  if (actor.settings.spin_rad_s != 0.0) {  // what a full turn about the model's own Y axis sweeps
    const glm::vec3 corner = glm::max(glm::abs(model.min), glm::abs(model.max));
    const float reach = std::hypot(corner.x, corner.z);
    model = {{-reach, model.min.y, -reach}, {reach, model.max.y, reach}};
  }
  const glm::mat4 matrix = world_from_model(actor.settings.transform, 0.0);
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

std::optional<Sphere> bounding_sphere(const Scene& scene) noexcept {
  std::optional<Bounds> all;
  for (const ActorPtr& actor : scene.actors) {
    if (!actor->settings.visible) continue;
    const Bounds own = world_bounds(*actor);
    all = all ? joined(*all, own) : own;
  }
  if (!all) return std::nullopt;
  return Sphere{(all->min + all->max) * 0.5F, glm::length(all->max - all->min) * 0.5F};
}

}  // namespace tweend::model
