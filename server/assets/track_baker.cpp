#include "server/assets/track_baker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tweend::assets {
namespace {

using Value = std::vector<double>;

constexpr int kMostHalvings = 14;
constexpr std::array kProbes{1.0 / 6.0, 0.5, 5.0 / 6.0};

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// A key of a CUBICSPLINE.
struct Key {
  double time_s = 0.0;
  Value value;
  Value in;
  Value out;
};

/// A cubic curve over a stretch of time, by its ends and their tangents.
struct Piece {
  double length_s = 0.0;
  const Value& begin;
  const Value& end;
  Value out;  ///< of the begin
  Value in;   ///< of the end

  /// glTF 2.0, appendix C.5.
  [[nodiscard]] double at(double u, std::size_t i) const {
    const double v = 1.0 - u;
    return v * v * (1.0 + 2.0 * u) * begin[i] + u * v * v * length_s * out[i] + u * u * (1.0 + 2.0 * v) * end[i] -
           u * u * v * length_s * in[i];
  }
};

class Baker {
 public:
  Baker(const BakeSource& source, const BakeLimits& limits) : source_(source), limits_(limits) {}

  Result<GlbSamples> bake() {
    const std::vector<double>& times = source_.times_s;
    add_key(times.front(), at(times.front(), {}));
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      segment(times[i], times[i + 1]);
      if (is_full()) {
        return fail(ErrorCode::Limit, fmt::format("expected an animation of at most {} numbers, found more where its curves "
                                                  "are made of pieces",
                                                  limits_.most_values));
      }
    }
    return samples();
  }

 private:
  [[nodiscard]] bool is_full() const { return keys_.size() > limits_.most_values / (3 * source_.width); }

  /// @param beside  empty, or a rotation in whose hemisphere it is wanted
  [[nodiscard]] Value at(double time_s, const Value& beside) const {
    Value value(source_.width);
    source_.at(time_s, value);
    if (source_.is_rotation && !beside.empty() && dot(value, beside) < 0.0) {
      for (double& v : value) v = -v;
    }
    return value;
  }

  void add_key(double time_s, Value value) {
    const std::size_t width = value.size();
    keys_.push_back({time_s, std::move(value), Value(width, 0.0), Value(width, 0.0)});
  }

  [[nodiscard]] bool near(const Value& a, const Value& b) const {
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (!(std::abs(a[i] - b[i]) <= limits_.tolerance * std::max(1.0, std::abs(a[i])))) return false;
    }
    return true;
  }

  void segment(double begin_s, double end_s) {
    const double before_s = end_s - kJumpSeconds;
    if (before_s - begin_s >= kJumpSeconds) {
      const Value before = at(before_s, {});
      if (!near(before, at(end_s, before))) {
        stretch(begin_s, before_s, kMostHalvings);
        begin_s = before_s;
      }
    }
    stretch(begin_s, end_s, kMostHalvings);
  }

  /// Goes on from the last key, which is at `begin_s`, to a key at `end_s`.
  void stretch(double begin_s, double end_s, int halvings_left) {
    if (is_full()) return;
    const Value begin = keys_.back().value;
    const double length_s = end_s - begin_s;
    const Value first = at(begin_s + length_s / 3.0, begin);
    const Value second = at(end_s - length_s / 3.0, first);
    const Value end = at(end_s, second);
    // The tangents of the one cubic curve through all four.
    Piece piece{length_s, begin, end, Value(source_.width), Value(source_.width)};
    for (std::size_t i = 0; i < source_.width; ++i) {
      piece.out[i] = (-11.0 * begin[i] + 18.0 * first[i] - 9.0 * second[i] + 2.0 * end[i]) / (2.0 * length_s);
      piece.in[i] = (-2.0 * begin[i] + 9.0 * first[i] - 18.0 * second[i] + 11.0 * end[i]) / (2.0 * length_s);
    }
    if (halvings_left > 0 && length_s > 4.0 * kJumpSeconds && !follows(piece, begin_s)) {
      const double middle_s = begin_s + 0.5 * length_s;
      stretch(begin_s, middle_s, halvings_left - 1);
      stretch(middle_s, end_s, halvings_left - 1);
      return;
    }
    keys_.back().out = piece.out;
    add_key(end_s, end);
    keys_.back().in = piece.in;
  }

  [[nodiscard]] bool follows(const Piece& piece, double begin_s) const {
    Value found(source_.width);
    return std::ranges::all_of(kProbes, [&](double u) {
      for (std::size_t i = 0; i < found.size(); ++i) found[i] = piece.at(u, i);
      if (source_.is_rotation) {
        const double length = std::sqrt(dot(found, found));
        for (double& v : found) v /= length;
      }
      return near(at(begin_s + u * piece.length_s, found), found);
    });
  }

  [[nodiscard]] GlbSamples samples() const {
    std::vector<double> times;
    for (const Key& key : keys_) times.push_back(key.time_s);
    // A spline needs two keys.
    GlbSamples samples{keys_.size() > 1 ? GlbBlend::CubicSpline : GlbBlend::Linear, float_times(times), {}};
    const auto append = [&](const Value& value) {
      for (const double v : value) samples.values.push_back(static_cast<float>(v));
    };
    for (const Key& key : keys_) {
      if (keys_.size() > 1) append(key.in);
      append(key.value);
      if (keys_.size() > 1) append(key.out);
    }
    return samples;
  }

  const BakeSource& source_;
  const BakeLimits& limits_;
  std::vector<Key> keys_;
};

}  // namespace

Result<GlbSamples> bake(const BakeSource& source, const BakeLimits& limits) { return Baker(source, limits).bake(); }

std::vector<float> float_times(std::span<const double> times_s) {
  std::vector<float> times;
  times.reserve(times_s.size());
  for (const double t : times_s) {
    auto time = static_cast<float>(t);
    if (!times.empty() && !(time > times.back())) {
      time = std::nextafter(times.back(), std::numeric_limits<float>::infinity());
    }
    times.push_back(time);
  }
  return times;
}

void slerp(std::span<const double> from, std::span<const double> to, double u, std::span<double> out) {
  constexpr double kNearlyOne = 1.0 - 1e-12;
  const double cosine = dot(from, to);
  const double sign = cosine < 0.0 ? -1.0 : 1.0;
  double a = 1.0 - u;
  double b = u;
  if (std::abs(cosine) < kNearlyOne) {
    const double angle = std::acos(std::abs(cosine));
    a = std::sin((1.0 - u) * angle) / std::sin(angle);
    b = std::sin(u * angle) / std::sin(angle);
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = a * from[i] + sign * b * to[i];
  const double length = std::sqrt(dot(out, out));
  for (double& v : out) v /= length;
}

}  // namespace tweend::assets
