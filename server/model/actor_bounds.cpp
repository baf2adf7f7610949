#include "server/model/actor_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "server/model/evaluate.hpp"

namespace tweend::model {
namespace {

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

Bounds vertex_clip_bounds(const Actor& actor, const Clip& clip) noexcept {
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

/// Grows around points, and knows whether there were any.
struct Hull {
  std::optional<Bounds> box;
  void add(const glm::vec3& at) { box = box ? joined(*box, {at, at}) : Bounds{at, at}; }
};

glm::vec3 transformed(const animation::Affine& m, const glm::vec3& p) noexcept {
  const glm::vec4 at(p, 1.0F);
  return {glm::dot(m.rows[0], at), glm::dot(m.rows[1], at), glm::dot(m.rows[2], at)};
}

void add_box(const animation::Affine& matrix, const Bounds& box, float margin, Hull& hull) {
  if (box.min.x > box.max.x) return;  // of a joint that moves nothing
  for (int i = 0; i < 8; ++i) {
    hull.add(transformed(
        matrix, {(i & 1) != 0 ? box.max.x + margin : box.min.x - margin, (i & 2) != 0 ? box.max.y + margin : box.min.y - margin,
                 (i & 4) != 0 ? box.max.z + margin : box.min.z - margin}));
  }
}

/// Joints and bones as they are drawn: how thick follows the length.
void add_bones(const Skeleton& skeleton, std::span<const animation::Affine> model_from_joint, Hull& hull) {
  constexpr float kHalfWidth = 0.1F;  // of a bone's length; a joint's ball is smaller
  const std::span<const std::int32_t> parents = skeleton.parent_places();
  for (std::size_t place = 0; place < model_from_joint.size(); ++place) {
    const glm::vec3 joint = transformed(model_from_joint[place], {});
    const glm::vec3 parent =
        parents[place] < 0 ? joint : transformed(model_from_joint[static_cast<std::size_t>(parents[place])], {});
    const float half_width = kHalfWidth * glm::distance(joint, parent);
    for (const glm::vec3& end : {joint, parent}) {
      hull.add(end - half_width);
      hull.add(end + half_width);
    }
  }
}

/// What is seen at one moment.
void add_moment(const Actor& actor, const Shown& shown, Evaluator& evaluator, Hull& hull) {
  const Model& model = *actor.model;
  const std::span<const animation::Affine> skin = evaluator.skin_matrices(actor, shown);
  const float margin = model.morphs ? model.morphs->reach() : 0.0F;
  for (std::size_t i = 0; i < skin.size(); ++i) add_box(skin[i], model.skin->entry_bounds()[i], margin, hull);
  if (model.rest && !model.skin) add_box({}, model.rest->bounds(), margin, hull);
  if (model.mesh && !actor.settings.show_skeleton) return;
  if (model.skeleton) add_bones(*model.skeleton, evaluator.model_from_joint(actor, shown), hull);
}

Bounds pose_clip_bounds(const Actor& actor, const ClipPtr& clip) {
  constexpr double kLooksASecond = 30.0;
  constexpr double kMostLooks = 300.0;
  const double duration_s = clip->duration_s();
  const int looks = static_cast<int>(std::clamp(std::ceil(duration_s * kLooksASecond), 1.0, kMostLooks));
  Evaluator evaluator;
  Shown shown = shown_clip(clip, 0.0);
  Hull hull;
  for (int i = 0; i <= looks; ++i) {
    shown.clips.front().time_s = duration_s * i / looks;
    add_moment(actor, shown, evaluator, hull);
  }
  return hull.box.value_or(Bounds{});
}

}  // namespace

Bounds clip_bounds(const Actor& actor, const ClipPtr& clip) {
  if (clip->type() == ClipType::Vertex && !clip->keyframes.empty()) return vertex_clip_bounds(actor, *clip);
  return pose_clip_bounds(actor, clip);
}

Bounds model_bounds(const Actor& actor) {
  Bounds all = clip_bounds(actor, actor.clips.front());
  for (const ClipPtr& clip : actor.clips) all = joined(all, clip_bounds(actor, clip));
  return all;
}

}  // namespace tweend::model
