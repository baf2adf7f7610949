#include "server/assets/export_track.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "server/animation/segment_blend.hpp"
#include "server/assets/track_baker.hpp"

namespace tweend::assets {
namespace {

using animation::Interpolation;
using animation::SegmentBlend;

animation::KeyTimeline timeline_of(const ExportTrack& track, const ClipSpan& clip) {
  return {track.times_s, clip.duration_s, clip.closed};
}

float dot(std::span<const float> a, std::span<const float> b) {
  float sum = 0.0F;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void add(std::span<const float> values, std::size_t key, double weight, std::span<double> out) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += weight * values[key * out.size() + i];
}

void normalise(std::span<double> value) {
  double sum = 0.0;
  for (const double v : value) sum += v * v;
  for (double& v : value) v /= std::sqrt(sum);
}

/// Weights of the four keys of a Catmull-Rom segment, turned so that the rotations lie in the hemisphere of key[0].
std::array<float, 4> united(const ExportTrack& track, const SegmentBlend& blend) {
  std::array<float, 4> weight = blend.weight;
  const auto opposite = [&](std::size_t a, std::size_t b) {
    return dot(track.value(blend.key[a]), track.value(blend.key[b])) < 0.0F;
  };
  const bool flips_to = opposite(0, 1);
  if (flips_to) weight[1] = -weight[1];
  if (opposite(0, 2)) weight[2] = -weight[2];
  if (opposite(1, 3) != flips_to) weight[3] = -weight[3];
  return weight;
}

bool eased(const animation::KeyMode& mode) {
  return mode.easing && (mode.interpolation == Interpolation::Linear || mode.interpolation == Interpolation::CatmullRom);
}

/// The one mode of all keys; nothing where there is none, or a curve is eased. What the last key of an open clip says is not
/// looked at: nothing follows it.
std::optional<Interpolation> only_mode(const ExportTrack& track, bool closed) {
  const std::size_t asked = std::max<std::size_t>(1, closed ? track.modes.size() : track.modes.size() - 1);
  const auto first = track.modes.begin();
  const bool one = std::all_of(first, first + static_cast<std::ptrdiff_t>(asked), [&](const animation::KeyMode& mode) {
    return mode.interpolation == first->interpolation && !eased(mode);
  });
  return one ? first->interpolation : std::nullopt;
}

/// A key of a curve, its value turned into the hemisphere of the one before.
struct CurveKey {
  double time_s = 0.0;
  std::vector<double> value;
};

/// The keys, in a closed clip those around the ends as well: the last before the first, the first and second after the last.
std::vector<CurveKey> curve_keys(const ExportTrack& track, const ClipSpan& clip) {
  const auto count = static_cast<std::ptrdiff_t>(track.times_s.size());
  std::vector<CurveKey> keys;
  for (std::ptrdiff_t i = clip.closed ? -1 : 0; i < (clip.closed ? count + 2 : count); ++i) {
    const std::ptrdiff_t laps = i < 0 ? -1 : i / count;
    const auto at = static_cast<std::size_t>(i - laps * count);
    CurveKey key{track.times_s[at] + static_cast<double>(laps) * clip.duration_s, {}};
    for (const float v : track.value(at)) key.value.push_back(v);
    if (track.is_rotation && !keys.empty()) {
      double cosine = 0.0;
      for (std::size_t c = 0; c < track.width; ++c) cosine += key.value[c] * keys.back().value[c];
      if (cosine < 0.0) {
        for (double& v : key.value) v = -v;
      }
    }
    keys.push_back(std::move(key));
  }
  return keys;
}

/// Σ a few floats behind each other.
void append(std::vector<float>& out, std::span<const double> values) {
  for (const double v : values) out.push_back(static_cast<float>(v));
}

/// The tangents of a Catmull-Rom spline are those of the chord from the key before to the key after; see
/// animation::catmull_rom_weights for the ends of an open clip.
GlbSamples catmull_rom(const ExportTrack& track, const ClipSpan& clip) {
  const std::vector<CurveKey> keys = curve_keys(track, clip);
  const std::size_t first = clip.closed ? 1 : 0;
  const std::size_t count = track.times_s.size() + first;  // a closed clip's first key comes again
  GlbSamples samples{GlbBlend::CubicSpline, {}, {}};
  std::vector<double> times;
  for (std::size_t k = first; k < first + count; ++k) {
    const bool begins = k == 0;
    const bool ends = k + 1 == keys.size();
    const CurveKey& before = keys[begins ? k : k - 1];
    const CurveKey& after = keys[ends ? k : k + 1];
    const double way_s = (after.time_s - before.time_s) * (begins || ends ? 2.0 : 1.0);
    std::vector<double> tangent(track.width);
    for (std::size_t c = 0; c < track.width; ++c) tangent[c] = (after.value[c] - before.value[c]) / way_s;
    times.push_back(keys[k].time_s);
    append(samples.values, tangent);
    append(samples.values, keys[k].value);
    append(samples.values, tangent);
  }
  samples.times_s = float_times(times);
  return samples;
}

GlbSamples cubic(const ExportTrack& track, const ClipSpan& clip) {
  const std::vector<float> zero(track.width, 0.0F);
  GlbSamples samples{GlbBlend::CubicSpline, {}, {}};
  const auto add_key = [&](std::size_t key) {
    const auto tangent = [&](const std::vector<float>& all) {
      return all.empty() ? std::span<const float>(zero) : std::span(all).subspan(key * track.width, track.width);
    };
    for (const auto& part : {tangent(track.in_tangents), track.value(key), tangent(track.out_tangents)}) {
      samples.values.insert(samples.values.end(), part.begin(), part.end());
    }
  };
  std::vector<double> times = track.times_s;
  for (std::size_t k = 0; k < times.size(); ++k) add_key(k);
  if (clip.closed) {
    times.push_back(clip.duration_s);
    add_key(0);
  }
  samples.times_s = float_times(times);
  return samples;
}

/// Keys that are held, or blended along straight lines: a closed clip's ends are given what it shows there.
GlbSamples plain(const ExportTrack& track, const ClipSpan& clip, GlbBlend blend) {
  GlbSamples samples{blend, {}, track.values};
  std::vector<double> times = track.times_s;
  if (clip.closed) {
    std::vector<double> end(track.width);
    sample_export_track(track, clip, clip.duration_s, end);
    if (times.front() > 0.0) {
      times.insert(times.begin(), 0.0);
      samples.values.insert(samples.values.begin(), end.begin(), end.end());
    }
    times.push_back(clip.duration_s);
    append(samples.values, end);
  }
  samples.times_s = float_times(times);
  return samples;
}

}  // namespace

void sample_export_track(const ExportTrack& track, const ClipSpan& clip, double time_s, std::span<double> out) {
  const SegmentBlend blend = animation::blend_segment(timeline_of(track, clip), track.modes, time_s, Interpolation::Linear);
  using Kind = SegmentBlend::Kind;
  if (track.is_rotation && blend.kind == Kind::Linear) {
    std::array<double, 4> from{}, to{};
    std::ranges::copy(track.value(blend.key[0]), from.begin());
    std::ranges::copy(track.value(blend.key[1]), to.begin());
    return slerp(from, to, blend.weight[1], out);
  }
  std::ranges::fill(out, 0.0);
  const bool turns = track.is_rotation && blend.kind == Kind::CatmullRom;
  const std::array<float, 4> weight = turns ? united(track, blend) : blend.weight;
  const bool is_cubic = blend.kind == Kind::Cubic;
  add(track.values, blend.key[0], weight[0], out);
  if (blend.kind != Kind::Hold) add(track.values, blend.key[1], weight[1], out);
  if (blend.kind == Kind::CatmullRom || is_cubic) {
    add(is_cubic ? track.out_tangents : track.values, blend.key[2], weight[2], out);
    add(is_cubic ? track.in_tangents : track.values, blend.key[3], weight[3], out);
  }
  if (track.is_rotation) normalise(out);
}

Result<GlbSamples> glb_samples(const ExportTrack& track, const ClipSpan& clip, const BakeLimits& limits) {
  const std::optional<Interpolation> mode = only_mode(track, clip.closed);
  if (track.times_s.size() == 1) {
    // A spline needs two keys, and nothing blends with itself.
    return GlbSamples{mode == Interpolation::Step ? GlbBlend::Step : GlbBlend::Linear, float_times(track.times_s),
                      track.values};
  }
  const bool curve_crosses_end = clip.closed && track.times_s.front() > 0.0;
  if (mode == Interpolation::Step) return plain(track, clip, GlbBlend::Step);
  if (mode == Interpolation::Linear) return plain(track, clip, GlbBlend::Linear);
  if (mode == Interpolation::CatmullRom && !curve_crosses_end) return catmull_rom(track, clip);
  if (mode == Interpolation::Cubic && !curve_crosses_end) return cubic(track, clip);

  BakeSource source{track.width, track.is_rotation, {}, track.times_s};
  source.at = [&](double time_s, std::span<double> out) { sample_export_track(track, clip, time_s, out); };
  if (curve_crosses_end) source.times_s.insert(source.times_s.begin(), 0.0);
  if (clip.closed) source.times_s.push_back(clip.duration_s);
  return bake(source, limits);
}

}  // namespace tweend::assets
