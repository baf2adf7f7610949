#include "server/animation/key_blend.hpp"

#include <cstddef>

#include "server/animation/spline_weights.hpp"

namespace tweend::animation {
namespace {

/// Gathers weights in double and merges those of the same key: short clips meet a key twice.
class BlendBuilder {
 public:
  void add(std::uint32_t key, double weight) {
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (key_[i] == key) {
        weight_[i] += weight;
        return;
      }
    }
    key_[count_] = key;
    weight_[count_++] = weight;
  }

  [[nodiscard]] KeyBlend build(std::uint32_t nearest_key) const {
    KeyBlend blend{.count = count_, .key = key_};
    for (std::uint32_t i = 0; i < count_; ++i) {
      blend.weight[i] = static_cast<float>(weight_[i]);
      if (key_[i] == nearest_key) blend.nearest = i;
    }
    return blend;
  }

 private:
  std::uint32_t count_ = 0;
  std::array<std::uint32_t, 4> key_{};
  std::array<double, 4> weight_{};
};

}  // namespace

KeyBlend blend_keys(const KeyTimeline& timeline, const KeySegment& segment, Interpolation mode,
                    const CubicBezier* easing) noexcept {
  if (segment.from == segment.to || mode == Interpolation::Step) return {.key = {segment.from}};
  const double u = easing != nullptr ? ease(*easing, segment.u) : segment.u;
  BlendBuilder builder;
  if (mode == Interpolation::CatmullRom) {
    const CatmullRomWeights spline = catmull_rom_weights(timeline, segment, u);
    for (std::size_t i = 0; i < 4; ++i) builder.add(spline.key[i], spline.weight[i]);
  } else if (mode == Interpolation::Cubic) {
    const HermiteWeights cubic = hermite_weights(segment.u, 0.0);  // without tangents their unit does not matter
    builder.add(segment.from, cubic.from);
    builder.add(segment.to, cubic.to);
  } else {
    builder.add(segment.from, 1.0 - u);
    builder.add(segment.to, u);
  }
  // Nearer by the clock, not by the eased u.
  return builder.build(segment.u <= 0.5 ? segment.from : segment.to);
}

}  // namespace tweend::animation
