#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tweend::protocol {

/// A rotation in 48 bits: of xyzw the one of largest magnitude is left out, made positive by turning all signs where it is
/// not (q and −q turn alike); the others lie within ±√½. Low 15 bits of each word: such a component in their order, in
/// steps of kStep around kZero; high bits of the first two words: which is left out, low bit first.
using SmallestThree = std::array<std::uint16_t, 3>;

namespace smallest_three {

inline constexpr int kZero = 16384;
inline constexpr int kMost = 16383;
inline constexpr double kPerUnit = kMost * 1.4142135623730951;
inline constexpr SmallestThree kIdentity{kZero | 0x8000, kZero | 0x8000, kZero};

/// @param q  xyzw; what is not of unit length, nor finite, is taken for the identity
[[nodiscard]] inline SmallestThree pack(const float* q) noexcept {
  constexpr double kTolerance = 1e-2;  // of the square; up to a third, what is left out has room
  double square = 0.0;
  for (unsigned i = 0; i < 4; ++i) square += double{q[i]} * q[i];
  if (!(std::abs(square - 1.0) <= kTolerance)) return kIdentity;
  unsigned largest = 0;
  for (unsigned i = 1; i < 4; ++i) {
    if (std::abs(q[i]) > std::abs(q[largest])) largest = i;
  }
  const double per_unit = q[largest] < 0.0F ? -kPerUnit : kPerUnit;
  SmallestThree words{};
  unsigned word = 0;
  for (unsigned i = 0; i < 4; ++i) {
    if (i == largest) continue;
    const double steps = std::clamp(q[i] * per_unit, double{-kMost}, double{kMost});
    words[word++] = static_cast<std::uint16_t>(steps + (kZero + 0.5));  // positive: cutting rounds
  }
  words[0] = static_cast<std::uint16_t>(words[0] | (largest & 1U) << 15U);
  words[1] = static_cast<std::uint16_t>(words[1] | (largest >> 1U) << 15U);
  return words;
}

[[nodiscard]] inline std::array<int, 3> steps(const SmallestThree& words) noexcept {
  return {(words[0] & 0x7FFF) - kZero, (words[1] & 0x7FFF) - kZero, (words[2] & 0x7FFF) - kZero};
}

/// Whether there is such a rotation: components that leave something for the largest, and a spare bit of 0.
[[nodiscard]] inline bool is_rotation(const SmallestThree& words) noexcept {
  const auto [a, b, c] = steps(words);
  return words[2] < 0x8000 && a * a + b * b + c * c <= 2 * kMost * kMost;
}

/// @param q  is given xyzw, unit
inline void unpack(const SmallestThree& words, float* q) noexcept {
  const auto largest = static_cast<unsigned>(words[0] >> 15 | (words[1] >> 15) << 1);
  const std::array<int, 3> small = steps(words);
  double rest = 1.0;
  unsigned word = 0;
  for (unsigned i = 0; i < 4; ++i) {
    if (i == largest) continue;
    const double value = small[word++] / kPerUnit;
    q[i] = static_cast<float>(value);
    rest -= value * value;
  }
  q[largest] = static_cast<float>(std::sqrt(std::max(rest, 0.0)));
}

}  // namespace smallest_three
}  // namespace tweend::protocol
