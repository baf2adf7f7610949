#include <algorithm>

#include "server/assets/glb_document.hpp"

namespace tweend::assets {
namespace {

constexpr std::size_t kAlignment = 4;

/// An accessor of whole numbers, as Narrow where `narrow`, else as Wide.
template <class Narrow, class Wide, class Number>
std::size_t add_whole(GlbDocument& document, std::span<const Number> numbers, bool narrow, GlbAccessor accessor,
                      GlbComponent if_narrow, GlbComponent if_wide, GlbUse use) {
  accessor.component = narrow ? if_narrow : if_wide;
  if (narrow) {
    std::vector<Narrow> small;
    small.reserve(numbers.size());
    for (const Number n : numbers) small.push_back(static_cast<Narrow>(n));
    accessor.view = add_view(document, std::as_bytes(std::span(small)), use);
  } else {
    const std::vector<Wide> wide(numbers.begin(), numbers.end());
    accessor.view = add_view(document, std::as_bytes(std::span(wide)), use);
  }
  document.accessors.push_back(std::move(accessor));
  return document.accessors.size() - 1;
}

void tell_bounds(std::span<const float> values, std::size_t width, GlbAccessor& accessor) {
  accessor.min.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width));
  accessor.max = accessor.min;
  for (std::size_t i = width; i < values.size(); ++i) {
    accessor.min[i % width] = std::min(accessor.min[i % width], values[i]);
    accessor.max[i % width] = std::max(accessor.max[i % width], values[i]);
  }
}

}  // namespace

std::size_t numbers_of(GlbShape shape) noexcept {
  switch (shape) {
    case GlbShape::Scalar:
      return 1;
    case GlbShape::Vec2:
      return 2;
    case GlbShape::Vec3:
      return 3;
    case GlbShape::Vec4:
      return 4;
    case GlbShape::Mat4:
      return 16;
  }
  return 1;
}

std::size_t add_view(GlbDocument& document, std::span<const std::byte> bytes, GlbUse use) {
  std::string& buffer = document.buffer;
  buffer.resize((buffer.size() + kAlignment - 1) / kAlignment * kAlignment, '\0');
  document.views.push_back({buffer.size(), bytes.size(), use});
  buffer.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return document.views.size() - 1;
}

std::size_t add_floats(GlbDocument& document, std::span<const float> values, GlbShape shape, GlbUse use, bool bounds) {
  const std::size_t width = numbers_of(shape);
  GlbAccessor accessor{.view = add_view(document, std::as_bytes(values), use),
                       .shape = shape,
                       .component = GlbComponent::F32,
                       .count = values.size() / width};
  if (bounds) tell_bounds(values, width, accessor);
  document.accessors.push_back(std::move(accessor));
  return document.accessors.size() - 1;
}

std::size_t add_zeros(GlbDocument& document, std::size_t count) {
  GlbAccessor accessor{.view = {}, .shape = GlbShape::Vec3, .count = count};
  accessor.min.assign(3, 0.0F);
  accessor.max.assign(3, 0.0F);
  document.accessors.push_back(std::move(accessor));
  return document.accessors.size() - 1;
}

std::size_t add_indices(GlbDocument& document, std::span<const std::uint32_t> indices) {
  constexpr std::uint32_t kRestart16 = 0xFFFF;  // would begin a new primitive
  const bool narrow = *std::ranges::max_element(indices) < kRestart16;
  return add_whole<std::uint16_t, std::uint32_t>(document, indices, narrow,
                                                 {.shape = GlbShape::Scalar, .count = indices.size()}, GlbComponent::U16,
                                                 GlbComponent::U32, GlbUse::Indices);
}

std::size_t add_joints(GlbDocument& document, std::span<const std::uint16_t> joints) {
  const bool narrow = *std::ranges::max_element(joints) <= 0xFF;
  return add_whole<std::uint8_t, std::uint16_t>(document, joints, narrow, {.shape = GlbShape::Vec4, .count = joints.size() / 4},
                                                GlbComponent::U8, GlbComponent::U16, GlbUse::Vertices);
}

}  // namespace tweend::assets
