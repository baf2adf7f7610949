#include "server/model/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace tweend::model {
namespace {

Bounds joined(const Bounds& a, const Bounds& b) noexcept { return {glm::min(a.min, b.min), glm::max(a.max, b.max)}; }

/// Whether all keys are as far apart, over a closed clip's seam as well.
bool evenly_spaced(const Clip& clip) noexcept {
  const std::vector<double>& t = clip.times_s;
  if (t.size() < 2) return true;
  const double gap = t[1] - t[0];
  const auto differs = [gap](double other) { return std::abs(other - gap) > 1e-3 * gap; };
  for (std::size_t i = 2; i < t.size(); ++i) {
    if (differs(t[i] - t[i - 1])) return false;
  }
  return !clip.settings.closed || !differs(clip.duration_s() - t.back() + t.front());
}

/// How far, in sizes of its keys' box, a blend may leave it: the sum of its negative weights, at most. Evenly spaced
/// Catmull-Rom is doubled for uneven keys; an easing lies within the hull of its control points.
float overshoot(animation::Interpolation mode, const std::optional<animation::CubicBezier>& easing, bool even) noexcept {
  if (mode == animation::Interpolation::Step) return 0.0F;
  const double lo = easing ? std::min({0.0, easing->y1, easing->y2}) : 0.0;
  const double hi = easing ? std::max({1.0, easing->y1, easing->y2}) : 1.0;
  if (mode == animation::Interpolation::Linear) return static_cast<float>(std::max(-lo, hi - 1.0));
  double most = 0.0;
  for (int i = 0; i <= 64; ++i) {
    const double u = lo + (hi - lo) * i / 64.0, u2 = u * u, u3 = u2 * u;
    const double weights[] = {(-u + 2 * u2 - u3) / 2, (2 - 5 * u2 + 3 * u3) / 2, (u + 4 * u2 - 3 * u3) / 2, (u3 - u2) / 2};
    double negative = 0.0;
    for (const double w : weights) negative += std::max(0.0, -w);
    most = std::max(most, negative);
  }
  return static_cast<float>((even ? 1.01 : 2.0) * most);
}

Bounds clip_bounds(const Actor& actor, const Clip& clip) noexcept {
  if (clip.keyframes.empty()) return actor.rest->bounds();
  Bounds own = clip.keyframes.front().vertices->bounds();
  float beyond = 0.0F;
  const bool even = evenly_spaced(clip);
  for (std::size_t i = 0; i < clip.keyframes.size(); ++i) {
    own = joined(own, clip.keyframes[i].vertices->bounds());
    beyond = std::max(beyond, overshoot(effective_interpolation(actor, clip, i), clip.keyframes[i].easing, even));
  }
  const glm::vec3 margin = beyond * (own.max - own.min);
  return {own.min - margin, own.max + margin};
}

Bounds model_bounds(const Actor& actor) noexcept {
  Bounds all = clip_bounds(actor, *actor.clips.front());
  for (const ClipPtr& clip : actor.clips) all = joined(all, clip_bounds(actor, *clip));
  return all;
}

Bounds world_bounds(const Actor& actor) noexcept {
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

std::optional<Bounds> visible_bounds(const Scene& scene) noexcept {
  std::optional<Bounds> all;
  for (const ActorPtr& actor : scene.actors) {
    if (!actor->settings.visible) continue;
    const Bounds own = world_bounds(*actor);
    all = all ? joined(*all, own) : own;
  }
  return all;
}

}  // namespace tweend::model
