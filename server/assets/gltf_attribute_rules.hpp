#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "server/assets/gltf_accessors.hpp"

// What the accessors of a primitive may be: glTF 2.0, section 3.7.2.1, and what KHR_mesh_quantization adds.

namespace tweend::assets {

namespace gltf_numbers {
inline constexpr GltfNumber kF32{GltfComponent::F32, false};
inline constexpr GltfNumber kI8{GltfComponent::I8, false};
inline constexpr GltfNumber kI8n{GltfComponent::I8, true};
inline constexpr GltfNumber kU8{GltfComponent::U8, false};
inline constexpr GltfNumber kU8n{GltfComponent::U8, true};
inline constexpr GltfNumber kI16{GltfComponent::I16, false};
inline constexpr GltfNumber kI16n{GltfComponent::I16, true};
inline constexpr GltfNumber kU16{GltfComponent::U16, false};
inline constexpr GltfNumber kU16n{GltfComponent::U16, true};
inline constexpr GltfNumber kU32{GltfComponent::U32, false};

inline constexpr std::array kFloat{kF32};
inline constexpr std::array kFractions{kF32, kU8n, kU16n};
inline constexpr std::array kSignedFractions{kF32, kI8n, kU8n, kI16n, kU16n};
inline constexpr std::array kIndices{kU8, kU16, kU32};
inline constexpr std::array kJoints{kU8, kU16};
inline constexpr std::array kQuantizedPosition{kF32, kI8, kI8n, kU8, kU8n, kI16, kI16n, kU16, kU16n};
inline constexpr std::array kQuantizedNormal{kF32, kI8n, kI16n};
inline constexpr std::array kQuantizedDisplacement{kF32, kI8, kI8n, kI16, kI16n};
}  // namespace gltf_numbers

inline constexpr GltfAccessorRule kIndexRule{"SCALAR", gltf_numbers::kIndices};
inline constexpr GltfAccessorRule kJointsRule{"VEC4", gltf_numbers::kJoints};
inline constexpr GltfAccessorRule kWeightsRule{"VEC4", gltf_numbers::kFractions};

/// `quantized`, or floats alone.
[[nodiscard]] inline GltfAccessorRule rule_of(std::string_view type, bool quantized, std::span<const GltfNumber> numbers) {
  if (quantized) return {type, numbers};
  return {type, gltf_numbers::kFloat};
}
[[nodiscard]] inline GltfAccessorRule position_rule(bool quantized) {
  return rule_of("VEC3", quantized, gltf_numbers::kQuantizedPosition);
}
[[nodiscard]] inline GltfAccessorRule normal_rule(bool quantized) {
  return rule_of("VEC3", quantized, gltf_numbers::kQuantizedNormal);
}
[[nodiscard]] inline GltfAccessorRule displacement_rule(bool quantized) {
  return rule_of("VEC3", quantized, gltf_numbers::kQuantizedDisplacement);
}
[[nodiscard]] inline GltfAccessorRule texcoord_rule(bool quantized) {
  if (quantized) return {"VEC2", gltf_numbers::kQuantizedPosition};
  return {"VEC2", gltf_numbers::kFractions};
}
/// @param opaque  of VEC3: red, green and blue
[[nodiscard]] inline GltfAccessorRule color_rule(bool opaque) { return {opaque ? "VEC3" : "VEC4", gltf_numbers::kFractions}; }

/// @param reference  what names the accessor
[[nodiscard]] inline Status expect_count(const GltfAccessor& accessor, std::size_t count, const JsonNode& reference) {
  if (accessor.count == count) return {};
  return accessor.node.error(fmt::format("expected {} elements for {}, found {}", count, reference.pointer(), accessor.count));
}

[[nodiscard]] inline Status expect_finite(std::span<const float> values, const JsonNode& of) {
  if (std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) return {};
  return of.error("expected numbers that stay finite when they are transformed, found others");
}

}  // namespace tweend::assets
