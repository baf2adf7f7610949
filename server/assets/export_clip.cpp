#include "server/assets/export_clip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "server/assets/track_baker.hpp"

namespace tweend::assets {
namespace {

using animation::Channel;
using animation::Interpolation;
using animation::Property;
using Tracks = std::map<Channel, ExportTrack>;

/// Of an eased vertex clip: displacements are followed to a ten-thousandth of their length by up to four weights.
constexpr double kWeightTolerance = 2e-5;

std::size_t width_of(Property property) {
  if (property == Property::Weight) return 1;
  return property == Property::Rotation ? 4 : 3;
}

Interpolation fallback_of(const model::Actor& actor, const model::Clip& clip) {
  return actor.settings.interpolation.value_or(clip.settings.interpolation.value_or(Interpolation::Linear));
}

void append(const glm::vec4& v, std::size_t width, std::vector<float>& out) {
  for (std::size_t c = 0; c < width; ++c) out.push_back(v[static_cast<int>(c)]);
}

/// The keys of each channel.
Tracks gather(const model::Actor& actor, const model::Clip& clip) {
  Tracks tracks;
  const Interpolation fallback = fallback_of(actor, clip);
  for (std::size_t k = 0; k < clip.keyframes.size(); ++k) {
    const model::Keyframe& keyframe = clip.keyframes[k];
    const auto values = keyframe.pose->values();
    const auto tangents = keyframe.pose->tangents();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Channel& channel = values[i].channel;
      ExportTrack& track = tracks[channel];
      track.width = width_of(channel.property);
      track.is_rotation = channel.property == Property::Rotation;
      track.times_s.push_back(clip.times_s[k]);
      append(values[i].value, track.width, track.values);
      const model::KeyedTangents tangent = tangents.empty() ? model::KeyedTangents() : tangents[i];
      append(tangent.in, track.width, track.in_tangents);
      append(tangent.out, track.width, track.out_tangents);
      const Interpolation mode = keyframe.interpolation.value_or(clip.mode_of(channel).value_or(fallback));
      track.modes.push_back({mode, keyframe.easing});
    }
  }
  return tracks;
}

/// Weights that are keyed together, as one track: what no track keys stays as `others` says.
ExportTrack side_by_side(const Tracks& weights, const std::vector<float>& others) {
  const ExportTrack& first = weights.begin()->second;
  const std::size_t keys = first.times_s.size();
  ExportTrack track{.width = others.size(), .times_s = first.times_s, .modes = first.modes};
  for (std::size_t k = 0; k < keys; ++k) track.values.insert(track.values.end(), others.begin(), others.end());
  track.in_tangents.assign(keys * track.width, 0.0F);
  track.out_tangents = track.in_tangents;
  for (const auto& [channel, own] : weights) {
    for (std::size_t k = 0; k < keys; ++k) {
      track.values[k * track.width + channel.target] = own.values[k];
      track.in_tangents[k * track.width + channel.target] = own.in_tangents[k];
      track.out_tangents[k * track.width + channel.target] = own.out_tangents[k];
    }
  }
  return track;
}

/// Weights that are keyed apart: they have to share their times, so they are baked.
Result<GlbSamples> merged(const Tracks& weights, const std::vector<float>& others, const ClipSpan& span,
                          const BakeLimits& limits) {
  BakeSource source{others.size(), false, {}, {}};
  source.at = [&](double time_s, std::span<double> out) {
    std::ranges::copy(others, out.begin());
    for (const auto& [channel, track] : weights) {
      sample_export_track(track, span, time_s, out.subspan(channel.target, 1));
    }
  };
  std::vector<double>& times = source.times_s;
  if (span.closed) times = {0.0, span.duration_s};
  for (const auto& [channel, track] : weights) times.insert(times.end(), track.times_s.begin(), track.times_s.end());
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return bake(source, limits);
}

Result<GlbSamples> weight_samples(const Tracks& weights, const std::vector<float>& others, const ClipSpan& span,
                                  const BakeLimits& limits) {
  const ExportTrack& first = weights.begin()->second;
  const bool alike = std::ranges::all_of(
      weights, [&](const auto& named) { return named.second.times_s == first.times_s && named.second.modes == first.modes; });
  return alike ? glb_samples(side_by_side(weights, others), span, limits) : merged(weights, others, span, limits);
}

/// Each keyframe's own target, and nothing else.
ExportTrack vertex_track(const model::Actor& actor, const model::Clip& clip, const ExportTargets& targets) {
  ExportTrack track{.width = targets.size(), .times_s = clip.times_s};
  track.values.assign(clip.keyframes.size() * track.width, 0.0F);
  for (std::size_t k = 0; k < clip.keyframes.size(); ++k) {
    const model::Keyframe& keyframe = clip.keyframes[k];
    if (const auto target = targets.of_key(*keyframe.vertices)) track.values[k * track.width + *target] = 1.0F;
    track.modes.push_back({model::effective_interpolation(actor, clip, k), keyframe.easing});
  }
  return track;
}

/// Keys the last value again at the clip's end, so that the animation is as long as the clip.
void hold_until(double end_s, std::size_t width, GlbSamples& samples) {
  const auto end = static_cast<float>(end_s);
  if (!(end > samples.times_s.back())) return;
  samples.times_s.push_back(end);
  std::vector<float>& values = samples.values;
  const auto last = values.end() - static_cast<std::ptrdiff_t>(width);
  if (samples.blend != GlbBlend::CubicSpline) {
    const std::vector<float> held(last, values.end());
    values.insert(values.end(), held.begin(), held.end());
    return;
  }
  // Flat on both sides: the tangent with which the curve arrives at its last key stands before its value.
  const std::vector<float> held(last - static_cast<std::ptrdiff_t>(width), last);
  std::fill(last, values.end(), 0.0F);
  values.insert(values.end(), width, 0.0F);
  values.insert(values.end(), held.begin(), held.end());
  values.insert(values.end(), width, 0.0F);
}

/// The first animated value of all keeps the clip's length, where no other reaches its end.
void keep_duration(double duration_s, std::size_t weights, ClipSamples& samples) {
  const auto end = static_cast<float>(duration_s);
  const auto reaches = [end](const GlbSamples& s) { return !(s.times_s.back() < end); };
  if (samples.weights && reaches(*samples.weights)) return;
  if (std::ranges::any_of(samples.joints, [&](const JointSamples& j) { return reaches(j.samples); })) return;
  if (!samples.joints.empty()) {
    hold_until(duration_s, width_of(samples.joints.front().property), samples.joints.front().samples);
  } else if (samples.weights) {
    hold_until(duration_s, weights, *samples.weights);
  }
}

std::size_t count_values(const ClipSamples& samples) {
  std::size_t count = samples.weights ? samples.weights->values.size() : 0;
  for (const JointSamples& j : samples.joints) count += j.samples.values.size();
  return count;
}

Error too_much(const model::Clip& clip, std::size_t most_values) {
  return fail(ErrorCode::Limit, fmt::format("expected at most {} numbers of animation, found more in the clip \"{}\" (each "
                                            "keyframe of vertices takes one for every target)",
                                            most_values, clip.name));
}

Status add_vertex_samples(const model::Actor& actor, const model::Clip& clip, const ExportTargets& targets,
                          const ClipSpan& span, BakeLimits limits, ClipSamples& samples) {
  if (targets.size() == 0) return {};  // nothing ever leaves its place
  if (clip.keyframes.size() > limits.most_values / targets.size()) return too_much(clip, limits.most_values);
  limits.tolerance = kWeightTolerance;
  TWEEND_ASSIGN(samples.weights, glb_samples(vertex_track(actor, clip, targets), span, limits));
  return {};
}

Status add_pose_samples(const model::Actor& actor, const model::Clip& clip, const ExportTargets* targets, const ClipSpan& span,
                        BakeLimits limits, ClipSamples& samples) {
  const std::size_t most_values = limits.most_values;
  Tracks weights;
  for (auto& [channel, track] : gather(actor, clip)) {
    limits.most_values = most_values - count_values(samples);
    if (channel.property == Property::Weight) {
      weights.emplace(channel, track);
      continue;
    }
    TWEEND_ASSIGN(GlbSamples found, glb_samples(track, span, limits));
    samples.joints.push_back({channel.target, channel.property, std::move(found)});
    if (count_values(samples) > most_values) return too_much(clip, most_values);
  }
  if (weights.empty() || targets == nullptr) return {};
  const std::size_t keys = weights.begin()->second.times_s.size();
  if (keys > limits.most_values / targets->size()) return too_much(clip, most_values);
  TWEEND_ASSIGN(samples.weights, weight_samples(weights, targets->default_weights(), span, limits));
  return {};
}

}  // namespace

Result<ClipSamples> clip_samples(const model::Actor& actor, const model::Clip& clip, const ExportTargets* targets,
                                 std::size_t most_values) {
  ClipSamples samples;
  if (clip.keyframes.empty()) return samples;
  const ClipSpan span{clip.duration_s(), clip.settings.closed};
  const BakeLimits limits{.most_values = most_values};
  if (clip.type() == model::ClipType::Vertex) {
    TWEEND_TRY(add_vertex_samples(actor, clip, *targets, span, limits, samples));
  } else {
    TWEEND_TRY(add_pose_samples(actor, clip, targets, span, limits, samples));
  }
  keep_duration(span.duration_s, targets == nullptr ? 0 : targets->size(), samples);
  if (count_values(samples) > most_values) return too_much(clip, most_values);
  return samples;
}

}  // namespace tweend::assets
