#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace tweend::protocol {

/// Numbers from −1 to 1, the same on every machine.
class Noise {
 public:
  explicit Noise(std::uint32_t seed) : random_(seed) {}
  [[nodiscard]] float next() { return static_cast<float>(static_cast<double>(random_()) / 2147483648.0 - 1.0); }

 private:
  std::mt19937 random_;
};

struct Pose {
  std::vector<float> joints;  ///< shape [joints × 10]
  std::vector<float> weights;

  [[nodiscard]] std::span<float, 3> translation(std::size_t j) { return std::span<float, 3>(&joints[10 * j], 3); }
  [[nodiscard]] std::span<float, 4> rotation(std::size_t j) { return std::span<float, 4>(&joints[10 * j + 3], 4); }
  [[nodiscard]] std::span<float, 3> scale(std::size_t j) { return std::span<float, 3>(&joints[10 * j + 7], 3); }
};

[[nodiscard]] inline Pose resting_pose(std::size_t joints, std::size_t weights) {
  Pose pose{std::vector<float>(10 * joints), std::vector<float>(weights)};
  for (std::size_t j = 0; j < joints; ++j) {
    pose.rotation(j)[3] = 1.0F;
    for (float& s : pose.scale(j)) s = 1.0F;
  }
  return pose;
}

/// To any rotation, evenly over all of them but for a bias to the corners that harms nobody.
inline void turn(Pose& pose, std::size_t j, Noise& noise) {
  const auto q = pose.rotation(j);
  double square = 0.0;
  while (square < 0.01) {
    square = 0.0;
    for (float& x : q) {
      x = noise.next();
      square += double{x} * x;
    }
  }
  for (float& x : q) x = static_cast<float>(x / std::sqrt(square));
}

struct Vertices {
  std::vector<float> positions, normals;  ///< shape [n × 3] each
};

/// A grid over a sphere of radius 1 + 0.2 sin(3θ + 2t) sin(2φ − t), and unit vectors beside it. Rows run from pole to pole.
[[nodiscard]] inline Vertices wavy_sphere(std::size_t rings, std::size_t sides, double t) {
  const auto radius = [t](double theta, double phi) { return 1.0 + 0.2 * std::sin(3 * theta + 2 * t) * std::sin(2 * phi - t); };
  const auto point = [&](double theta, double phi) {
    const double r = radius(theta, phi);
    return std::array{r * std::sin(theta) * std::cos(phi), r * std::cos(theta), r * std::sin(theta) * std::sin(phi)};
  };
  Vertices out;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    for (std::size_t side = 0; side < sides; ++side) {
      const double theta = std::numbers::pi * (static_cast<double>(ring) + 0.5) / static_cast<double>(rings);
      const double phi = 2.0 * std::numbers::pi * static_cast<double>(side) / static_cast<double>(sides);
      for (const double x : point(theta, phi)) out.positions.push_back(static_cast<float>(x));
      // The normal of the surface: across two differences along it.
      constexpr double kNear = 1e-4;
      std::array<double, 3> down{}, around{};
      for (std::size_t k = 0; k < 3; ++k) {
        down[k] = point(theta + kNear, phi)[k] - point(theta - kNear, phi)[k];
        around[k] = point(theta, phi + kNear)[k] - point(theta, phi - kNear)[k];
      }
      const std::array normal{around[1] * down[2] - around[2] * down[1], around[2] * down[0] - around[0] * down[2],
                              around[0] * down[1] - around[1] * down[0]};
      const double length = std::hypot(normal[0], normal[1], normal[2]);
      for (const double x : normal) out.normals.push_back(static_cast<float>(x / length));
    }
  }
  return out;
}

/// With every kind of number that a float can be.
[[nodiscard]] inline Vertices odd_vertices(std::size_t n, std::uint32_t seed) {
  using Limits = std::numeric_limits<float>;
  constexpr std::array kOdd{Limits::infinity(),
                            -Limits::infinity(),
                            Limits::quiet_NaN(),
                            Limits::max(),
                            -Limits::max(),
                            1e38F,  // of which three are no float
                            -0.0F,
                            Limits::denorm_min(),
                            1.0F};
  std::mt19937 random(seed);
  Vertices out;
  for (std::size_t i = 0; i < 3 * n; ++i) {
    out.positions.push_back(kOdd[random() % kOdd.size()]);
    out.normals.push_back(i % 3 == 0 && random() % 2 == 0 ? 0.5F : kOdd[random() % kOdd.size()]);
  }
  return out;
}

/// What docs/PROTOCOL.md says is sent of such numbers.
[[nodiscard]] inline Vertices tamed(Vertices v) {
  constexpr float kHalfOfMost = 1.7014117e38F;
  for (float& x : v.positions) x = std::isnan(x) ? 0.0F : std::clamp(x, -kHalfOfMost, kHalfOfMost);
  for (std::size_t i = 0; i < v.normals.size(); i += 3) {
    const float sum = std::abs(v.normals[i]) + std::abs(v.normals[i + 1]) + std::abs(v.normals[i + 2]);
    if (!std::isfinite(sum) || sum < 1e-18F) std::fill_n(&v.normals[i], 3, 0.0F);
  }
  return v;
}

}  // namespace tweend::protocol
