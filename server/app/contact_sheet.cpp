#include "server/app/contact_sheet.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace tweend::app {
namespace {

constexpr std::uint32_t kGap = 2;  // pixels

std::uint64_t length(std::size_t pictures, std::uint32_t each) noexcept {
  return pictures * (std::uint64_t{each} + kGap) - kGap;
}

/// Three fit a row; more make a block about as many wide as high.
std::size_t columns_of(std::size_t count) noexcept {
  return count <= 3 ? count : static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
}

std::size_t rows_of(std::size_t count) noexcept { return (count + columns_of(count) - 1) / columns_of(count); }

}  // namespace

Status ContactSheet::check(render::Size each, std::size_t count) {
  constexpr std::uint64_t kSide = 16'384, kPixels = std::uint64_t{1} << 28U;
  const std::uint64_t width = length(columns_of(count), each.width), height = length(rows_of(count), each.height);
  if (width <= kSide && height <= kSide && width * height <= kPixels) return {};
  return fail(ErrorCode::Limit,
              fmt::format("expected a sheet of at most {} pixels a side, found {} pictures to make {} x {}; ask for "
                          "fewer or smaller ones",
                          kSide, count, width, height));
}

ContactSheet::ContactSheet(render::Size each, std::size_t count)
    : each_(each),
      columns_(columns_of(count)),
      size_{static_cast<std::uint32_t>(length(columns_, each.width)),
            static_cast<std::uint32_t>(length(rows_of(count), each.height))},
      pixels_(std::size_t{4} * size_.width * size_.height, std::byte{255}) {}

void ContactSheet::put(std::size_t index, const render::ImageView& picture) {
  const std::size_t left = index % columns_ * (each_.width + kGap);
  const std::size_t top = index / columns_ * (each_.height + kGap);
  for (std::size_t y = 0; y < each_.height; ++y) {
    const std::size_t row = size_.height - 1 - (top + y);
    std::memcpy(pixels_.data() + 4 * (row * size_.width + left), picture.row(y).data(), picture.row_bytes());
  }
}

}  // namespace tweend::app
