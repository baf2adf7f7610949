#include "server/model/actor.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <span>

#include "server/animation/blend_vertices.hpp"

namespace tweend::model {

glm::mat4 world_from_model(const Transform& transform, double spin_angle_rad) noexcept {
  const glm::mat4 moved = glm::translate(glm::mat4(1.0F), transform.translation) * glm::mat4_cast(transform.rotation);
  const glm::mat4 turned = glm::rotate(moved, static_cast<float>(spin_angle_rad), glm::vec3(0.0F, 1.0F, 0.0F));
  return glm::scale(turned, transform.scale);
}

ClipPtr Actor::find_clip(std::string_view clip) const noexcept {
  const auto at = std::find_if(clips.begin(), clips.end(), [clip](const ClipPtr& c) { return c->name == clip; });
  return at == clips.end() ? nullptr : *at;
}

animation::Interpolation effective_interpolation(const Actor& actor, const Clip& clip, std::size_t key) noexcept {
  const Keyframe& keyframe = clip.keyframes[key];
  if (keyframe.interpolation) return *keyframe.interpolation;
  if (keyframe.pose && !keyframe.pose->values().empty()) {
    if (const auto mode = clip.mode_of(keyframe.pose->values().front().channel)) return *mode;
  }
  if (actor.settings.interpolation) return *actor.settings.interpolation;
  return clip.settings.interpolation.value_or(animation::Interpolation::Linear);
}

animation::KeyBlend blend_at(const Actor& actor, const Clip& clip, double time_s) noexcept {
  const animation::KeyTimeline timeline = clip.timeline();
  const animation::KeySegment segment = animation::locate(timeline, time_s);
  const auto& easing = clip.keyframes[segment.from].easing;
  return animation::blend_keys(timeline, segment, effective_interpolation(actor, clip, segment.from),
                               easing ? &*easing : nullptr);
}

Status sample_keyframes(const Actor& actor, const Clip& clip, double time_s, const animation::VertexTarget& out) noexcept {
  const animation::KeyBlend blend = blend_at(actor, clip, time_s);
  std::array<animation::VertexAttributes, 4> sources;
  for (std::size_t i = 0; i < blend.count; ++i) sources[i] = clip.keyframes[blend.key[i]].vertices->attributes();
  return animation::blend_vertices(std::span(sources).first(blend.count), std::span(blend.weight).first(blend.count),
                                   blend.nearest, out);
}

}  // namespace tweend::model
