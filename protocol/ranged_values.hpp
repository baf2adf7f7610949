#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tweend::protocol {

/// How one property of the elements (joints, or morph targets) travels: value = base + integer · 2^exponent. Keys bring an
/// element's base, exact, and its exponent; the packets between bring integers.
struct RangedKind {
  std::size_t components;     ///< of an element
  float rest;                 ///< the base of elements that a key does not name
  std::int8_t rest_exponent;  ///< likewise

  [[nodiscard]] std::size_t key_bytes() const noexcept { return 4 * components + 1; }
  [[nodiscard]] std::size_t delta_bytes() const noexcept { return 2 * components; }
};

/// Integers reach a quarter of a metre at first, or 2 where scales and weights usually stay.
inline constexpr RangedKind kTranslations{3, 0.0F, -17};
inline constexpr RangedKind kScales{3, 1.0F, -14};
inline constexpr RangedKind kWeights{1, 0.0F, -14};

inline constexpr int kLeastExponent = -24;
inline constexpr int kMostExponent = 80;  ///< from where integers could reach beyond float32's largest, if it were more
inline constexpr int kMostSteps = 32767;

/// @param exponent  that of an element, or its negative
[[nodiscard]] inline double power_of_two(int exponent) noexcept {
  constexpr int kBias = 1023;
  return std::bit_cast<double>(static_cast<std::uint64_t>(kBias + exponent) << 52U);
}

/// What writer and reader both know of one property.
struct RangedState {
  explicit RangedState(const RangedKind& of) : kind(of) {}

  /// Everything at rest; allocates only where there are more elements than ever.
  void reset(std::size_t elements) {
    base.assign(elements * kind.components, kind.rest);
    integer.assign(elements * kind.components, 0);
    exponent.assign(elements, kind.rest_exponent);
  }
  [[nodiscard]] std::size_t elements() const noexcept { return exponent.size(); }
  [[nodiscard]] double step(std::size_t element) const noexcept { return power_of_two(exponent[element]); }

  RangedKind kind;
  std::vector<float> base;            ///< shape [elements × components]
  std::vector<std::int16_t> integer;  ///< likewise
  std::vector<std::int8_t> exponent;  ///< shape [elements]
};

/// The writer's side: chooses exponents by how far values move. What is not finite is taken for the largest float of its sign,
/// NaN for what is at rest.
class RangedWriter {
 public:
  explicit RangedWriter(const RangedKind& kind) : state_(kind) {}

  void reset(std::size_t elements);

  /// Bytes that a key may take at most: its bitmap and all elements.
  [[nodiscard]] static std::size_t most_bytes(const RangedKind& kind, std::size_t elements) noexcept;

  /// Notes the values to be written.
  /// @param values  element e's components are at values[e · stride]
  /// @return whether integers reach them all
  [[nodiscard]] bool observe(const float* values, std::size_t stride) noexcept;

  /// Writes bitmap and elements that are not at rest, with new bases, and exponents by what was observed since the last key.
  /// @param left  whether this key is there because values were out of reach; exponents only grow then
  /// @return the bytes written; 0 where all are at rest
  [[nodiscard]] std::size_t write_key(const float* values, std::size_t stride, bool left, std::byte* out) noexcept;

  /// Writes bitmap and integers of the elements whose integers changed; observe() has said that they reach.
  /// @return the bytes written; 0 where none has
  [[nodiscard]] std::size_t write_delta(const float* values, std::size_t stride, std::byte* out) noexcept;

 private:
  RangedState state_;
  std::vector<double> farthest_;  ///< shape [elements]: of a component from its base since the last key
};

}  // namespace tweend::protocol
