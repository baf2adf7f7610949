#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "render/picture.hpp"

// The light of render/shaders/mesh.frag written anew, in double, one surface point at a time: what the pixel tests expect.

namespace tweend::render::test {

using Vec3d = glm::dvec3;

/// IEC 61966-2-1, both ways, one channel from 0 to 1.
inline double decode_srgb(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
inline double encode_srgb(double c) {
  c = std::clamp(c, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}
inline Vec3d decode_srgb(const Vec3d& c) { return {decode_srgb(c.x), decode_srgb(c.y), decode_srgb(c.z)}; }

/// What a camera sees of a point of a surface, linear: ambient light, 0.7 of it from straight below to 1.3 from straight
/// above, Lambert's cosine, and Blinn's highlight, which has the colour of the light. Surfaces have two sides.
/// @param normal  unit, to whichever side the eye is not behind
/// @param base    linear
inline Vec3d lit(const PointLight& light, const Vec3d& point, const Vec3d& normal, const Vec3d& eye, const Vec3d& base) {
  const Vec3d to_light = glm::normalize(Vec3d(light.position) - point);
  const Vec3d to_eye = glm::normalize(eye - point);
  const double cosine = std::max(glm::dot(normal, to_light), 0.0);
  const double half_cosine = std::max(glm::dot(normal, glm::normalize(to_light + to_eye)), 0.0);
  const double sky = double{light.ambient} * (1.0 + 0.3 * normal.y);
  const double glint = cosine > 0.0 ? double{light.specular} * std::pow(half_cosine, double{light.shininess}) : 0.0;
  return base * (sky + double{light.diffuse} * cosine) + Vec3d(glint);
}

/// 0 to 255, not yet rounded.
inline std::array<double, 3> srgb_bytes(const Vec3d& linear) {
  return {255.0 * encode_srgb(linear.x), 255.0 * encode_srgb(linear.y), 255.0 * encode_srgb(linear.z)};
}

}  // namespace tweend::render::test
