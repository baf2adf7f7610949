#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "tests/animation/reference_track.hpp"

// Random clips, the same in every run.

namespace tweend::animation {

class RandomTracks {
 public:
  explicit RandomTracks(std::uint32_t seed) : random_(seed) {}

  [[nodiscard]] double uniform(double low, double high) {
    // std::uniform_real_distribution differs between libraries.
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  [[nodiscard]] std::size_t below(std::size_t end) { return random_() % end; }
  [[nodiscard]] float number(double low, double high) { return static_cast<float>(uniform(low, high)); }

  /// Strictly ascending times of keys in [0, duration_s); evenly spaced or not.
  [[nodiscard]] std::vector<double> times_s(std::size_t keys, double duration_s, bool even) {
    std::vector<double> times;
    const double start_s = below(2) == 0 ? 0.0 : 0.1 * duration_s;
    const double step_s = (0.95 * duration_s - start_s) / static_cast<double>(keys);
    for (std::size_t i = 0; i < keys; ++i) {
      times.push_back(start_s + (static_cast<double>(i) + (even ? 0.0 : uniform(0.0, 0.9))) * step_s);
    }
    return times;
  }

  [[nodiscard]] glm::vec4 direction() {
    glm::vec4 v;
    do {
      v = {number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1)};
    } while (glm::length(v) < 0.3F);
    return glm::normalize(v);
  }

  /// Each up to `widest` of the unit sphere from the one before, and now and then on its other side (q and −q).
  [[nodiscard]] std::vector<glm::vec4> rotations(std::size_t keys, float widest) {
    std::vector<glm::vec4> values{direction()};
    while (values.size() < keys) {
      const float sign = below(4) == 0 ? -1.0F : 1.0F;
      values.push_back(sign * glm::normalize(values.back() + number(0, static_cast<double>(widest)) * direction()));
    }
    return values;
  }

  [[nodiscard]] std::vector<glm::vec4> vectors(std::size_t keys, double limit) {
    std::vector<glm::vec4> values;
    for (std::size_t i = 0; i < keys; ++i) {
      values.emplace_back(number(-limit, limit), number(-limit, limit), number(-limit, limit), number(-limit, limit));
    }
    return values;
  }

  [[nodiscard]] KeyMode mode() {
    constexpr Interpolation kAll[] = {Interpolation::Step, Interpolation::Linear, Interpolation::CatmullRom,
                                      Interpolation::Cubic};
    KeyMode mode;
    if (below(5) != 0) mode.interpolation = kAll[below(4)];
    if (below(3) == 0) mode.easing = CubicBezier{0.3, 0.1 * static_cast<double>(below(9)), 0.6, 1.0};
    return mode;
  }
  [[nodiscard]] std::vector<KeyMode> modes(std::size_t keys) {
    std::vector<KeyMode> modes(below(2) == 0 ? 1 : keys);
    std::ranges::generate(modes, [&] { return mode(); });
    return modes;
  }

  /// A track over `times`; half of them with tangents.
  [[nodiscard]] reference::Track track(Channel channel, std::vector<double> times, std::vector<KeyMode> modes) {
    const std::size_t keys = times.size();
    reference::Track track{channel, std::move(times), {}, {}, {}, std::move(modes)};
    track.values = track.is_rotation() ? rotations(keys, 1.0F) : vectors(keys, 1.0);
    if (below(2) == 0) track.in_tangents = vectors(keys, 0.4);
    if (below(2) == 0) track.out_tangents = vectors(keys, 0.4);
    return track;
  }

 private:
  std::mt19937 random_;
};

}  // namespace tweend::animation
