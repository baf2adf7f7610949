#include "server/app/contact_sheet.hpp"

#include <cmath>
#include <cstring>

namespace tweend::app {
namespace {

constexpr std::uint32_t kGap = 2;  // pixels

std::uint32_t length(std::size_t pictures, std::uint32_t each) noexcept {
  return static_cast<std::uint32_t>(pictures) * (each + kGap) - kGap;
}

}  // namespace

ContactSheet::ContactSheet(render::Size each, std::size_t count)
    : each_(each),
      // Three fit a row; more make a block about as many wide as high.
      columns_(count <= 3 ? count : static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))))),
      size_{length(columns_, each.width), length((count + columns_ - 1) / columns_, each.height)},
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
