#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "server/animation/interpolation.hpp"
#include "server/animation/track.hpp"

// What a track shows, in double and by the definitions written out; made for reading, not for speed.

namespace tweend::animation::reference {

struct Track {
  Channel channel;
  std::vector<double> times_s;
  std::vector<glm::vec4> values;
  std::vector<glm::vec4> in_tangents;
  std::vector<glm::vec4> out_tangents;
  std::vector<KeyMode> modes;

  [[nodiscard]] TrackSource source() const { return {channel, times_s, values, in_tangents, out_tangents, modes}; }
  [[nodiscard]] bool is_rotation() const { return channel.property == Property::Rotation; }
};

struct Quaternion {
  double w;
  glm::dvec3 v;
  explicit Quaternion(const glm::dvec4& xyzw) : w(xyzw.w), v(xyzw) {}
  Quaternion(double real, const glm::dvec3& imaginary) : w(real), v(imaginary) {}
  [[nodiscard]] glm::dvec4 xyzw() const { return {v, w}; }
};

inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - glm::dot(a.v, b.v), a.w * b.v + b.w * a.v + glm::cross(a.v, b.v)};
}

/// a · (a⁻¹ b)^u, the rotation between raised by its axis and angle; the short way.
inline glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double u) {
  const Quaternion start(a);
  Quaternion turn = Quaternion(start.w, -start.v) * Quaternion(b);
  if (turn.w < 0.0) turn = {-turn.w, -turn.v};
  const double sine = glm::length(turn.v);
  if (sine == 0.0) return a;
  const double part = u * std::atan2(sine, turn.w);
  return (start * Quaternion(std::cos(part), turn.v / sine * std::sin(part))).xyzw();
}

/// A key on the time axis without end: closed clips are repeated, open ones go on beyond both ends.
struct Point {
  double t = 0.0;
  std::size_t key = 0;
};

inline std::vector<Point> written_out(const Track& track, double duration_s, bool closed) {
  const auto& t = track.times_s;
  const std::size_t n = t.size();
  std::vector<Point> points;
  const auto add_all = [&](double from_s) {
    for (std::size_t i = 0; i < n; ++i) points.push_back({from_s + t[i], i});
  };
  if (closed) {
    for (const int lap : {-2, -1, 0, 1, 2}) add_all(lap * duration_s);
  } else {
    points.push_back({t[0] - (t[1] - t[0]), 0});
    add_all(0.0);
    points.push_back({t[n - 1] + (t[n - 1] - t[n - 2]), n - 1});
  }
  return points;
}

/// Before scaling: the value of the segment that starts at points[i], `u` of the way through it.
inline glm::dvec4 segment_value(const Track& track, const std::vector<Point>& points, std::size_t i, double u,
                                Interpolation mode) {
  const auto value = [&](std::size_t point) { return glm::dvec4(track.values[points[point].key]); };
  const double h = points[i + 1].t - points[i].t;
  if (mode == Interpolation::Linear) {
    return track.is_rotation() ? slerp(value(i), value(i + 1), u) : value(i) + u * (value(i + 1) - value(i));
  }
  glm::dvec4 x[4];
  glm::dvec4 m0(0.0);
  glm::dvec4 m1(0.0);
  for (std::size_t k = 0; k < 4; ++k) {
    x[k] = value(i + k - 1);
    const bool is_spline = mode == Interpolation::CatmullRom;
    if (is_spline && track.is_rotation() && k > 0 && glm::dot(x[k - 1], x[k]) < 0.0) x[k] = -x[k];
  }
  if (mode == Interpolation::CatmullRom) {
    m0 = h * (x[2] - x[0]) / (points[i + 1].t - points[i - 1].t);
    m1 = h * (x[3] - x[1]) / (points[i + 2].t - points[i].t);
  } else {
    if (!track.out_tangents.empty()) m0 = h * glm::dvec4(track.out_tangents[points[i].key]);
    if (!track.in_tangents.empty()) m1 = h * glm::dvec4(track.in_tangents[points[i + 1].key]);
  }
  const glm::dvec4 sum = x[1] + u * (m0 + u * (3.0 * (x[2] - x[1]) - 2.0 * m0 - m1 + u * (2.0 * (x[1] - x[2]) + m0 + m1)));
  return sum;
}

struct Sample {
  glm::dvec4 value;
  double length = 1.0;  ///< of a rotation before it was scaled to unit length: short ones are known only as well as that
};

/// What docs/PROTOCOL.md, section 4, and glTF 2.0, appendix C, say of one track.
inline Sample sample(const Track& track, double duration_s, bool closed, double time_s, Interpolation fallback) {
  const double t = std::isnan(time_s) ? 0.0 : std::fmin(std::fmax(time_s, 0.0), duration_s);
  for (std::size_t i = 0; i < track.times_s.size(); ++i) {
    if (t == track.times_s[i]) return {glm::dvec4(track.values[i])};
  }
  if (track.times_s.size() == 1) return {glm::dvec4(track.values[0])};
  if (!closed && t < track.times_s.front()) return {glm::dvec4(track.values.front())};
  if (!closed && t > track.times_s.back()) return {glm::dvec4(track.values.back())};
  const std::vector<Point> points = written_out(track, duration_s, closed);
  std::size_t i = 1;
  while (points[i + 1].t <= t) ++i;
  const KeyMode& key_mode = track.modes[track.modes.size() == 1 ? 0 : points[i].key];
  const Interpolation mode = key_mode.interpolation.value_or(fallback);
  if (mode == Interpolation::Step) return {glm::dvec4(track.values[points[i].key])};
  double u = (t - points[i].t) / (points[i + 1].t - points[i].t);
  if (key_mode.easing && mode != Interpolation::Cubic) u = ease(*key_mode.easing, u);
  const glm::dvec4 sum = segment_value(track, points, i, u, mode);
  const double length = glm::length(sum);
  return track.is_rotation() ? Sample{sum / length, length} : Sample{sum};
}

}  // namespace tweend::animation::reference
