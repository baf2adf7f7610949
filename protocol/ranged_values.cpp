#include "protocol/ranged_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/bitmap.hpp"
#include "protocol/little_endian.hpp"

namespace tweend::protocol {
namespace {

/// Integers reach this many times as far as values have moved between two keys.
constexpr double kHeadroom = 4.0;
/// How much finer steps become at a key at most: a joint that rests for a moment will move again.
constexpr int kFinerByAtMost = 2;

int next_exponent(int exponent, double farthest, bool left) noexcept {
  if (farthest == 0.0) return exponent;
  int wanted = 0;
  std::frexp(kHeadroom * farthest / kMostSteps, &wanted);  // the quotient is below 2^wanted
  return std::clamp(std::max(wanted, exponent - (left ? 0 : kFinerByAtMost)), kLeastExponent, kMostExponent);
}

float tame(float value, float rest) noexcept {
  constexpr float kMost = std::numeric_limits<float>::max();
  return std::isnan(value) ? rest : std::clamp(value, -kMost, kMost);
}

/// @param steps  at most kMostSteps and a half from zero
std::int16_t rounded(double steps) noexcept {
  constexpr int kOffset = 32768;
  return static_cast<std::int16_t>(static_cast<int>(steps + (kOffset + 0.5)) - kOffset);
}

}  // namespace

void RangedWriter::reset(std::size_t elements) {
  state_.reset(elements);
  farthest_.assign(elements, 0.0);
}

std::size_t RangedWriter::most_bytes(const RangedKind& kind, std::size_t elements) noexcept {
  return bitmap_bytes(elements) + elements * kind.key_bytes();
}

bool RangedWriter::observe(const float* values, std::size_t stride) noexcept {
  const RangedKind& kind = state_.kind;
  bool reaches = true;
  for (std::size_t e = 0; e < state_.elements(); ++e) {
    double far = 0.0;
    for (std::size_t k = 0; k < kind.components; ++k) {
      far = std::max(far,
                     std::abs(double{tame(values[e * stride + k], kind.rest)} - double{state_.base[e * kind.components + k]}));
    }
    farthest_[e] = std::max(farthest_[e], far);
    if (far > 0.0) reaches = reaches && far <= kMostSteps * state_.step(e);
  }
  return reaches;
}

std::size_t RangedWriter::write_key(const float* values, std::size_t stride, bool left, std::byte* out) noexcept {
  const RangedKind& kind = state_.kind;
  BitmapWriter changed(out, state_.elements());
  std::byte* at = out + bitmap_bytes(state_.elements());
  for (std::size_t e = 0; e < state_.elements(); ++e) {
    state_.exponent[e] = static_cast<std::int8_t>(next_exponent(state_.exponent[e], farthest_[e], left));
    farthest_[e] = 0.0;
    bool rests = state_.exponent[e] == kind.rest_exponent;
    for (std::size_t k = 0; k < kind.components; ++k) {
      const float value = tame(values[e * stride + k], kind.rest);
      state_.base[e * kind.components + k] = value;
      state_.integer[e * kind.components + k] = 0;
      rests = rests && value == kind.rest;
    }
    if (rests) continue;
    changed.set(e);
    for (std::size_t k = 0; k < kind.components; ++k, at += 4) put_float(at, state_.base[e * kind.components + k]);
    *at++ = static_cast<std::byte>(state_.exponent[e]);
  }
  return changed.any() ? static_cast<std::size_t>(at - out) : 0;
}

std::size_t RangedWriter::write_delta(const float* values, std::size_t stride, std::byte* out) noexcept {
  const RangedKind& kind = state_.kind;
  BitmapWriter changed(out, state_.elements());
  std::byte* at = out + bitmap_bytes(state_.elements());
  for (std::size_t e = 0; e < state_.elements(); ++e) {
    const double per_step = power_of_two(-state_.exponent[e]);
    std::int16_t* const known = &state_.integer[e * kind.components];
    bool differs = false;
    for (std::size_t k = 0; k < kind.components; ++k) {
      const double offset = double{tame(values[e * stride + k], kind.rest)} - double{state_.base[e * kind.components + k]};
      const std::int16_t integer = rounded(offset * per_step);
      put(at + 2 * k, static_cast<std::uint16_t>(integer));
      differs = differs || integer != known[k];
      known[k] = integer;
    }
    if (!differs) continue;  // what was put there is put over
    changed.set(e);
    at += 2 * kind.components;
  }
  return changed.any() ? static_cast<std::size_t>(at - out) : 0;
}

}  // namespace tweend::protocol
