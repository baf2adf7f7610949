#include "server/model/material.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

namespace tweend::model {

Result<ImagePtr> Image::make(std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> rgba) {
  const std::size_t expected = std::size_t{4} * width * height;
  if (expected == 0 || rgba.size() != expected) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected {} bytes of RGBA for {} x {} pixels (at least 1 x 1), found {}",
                                                      expected, width, height, rgba.size()));
  }
  const std::shared_ptr<Image> image(new Image);
  image->width_ = width;
  image->height_ = height;
  image->rgba_ = std::move(rgba);
  const ContentHash pixels = hash_bytes(std::as_bytes(std::span(image->rgba_)));
  const std::uint64_t parts[] = {width, height, pixels.high, pixels.low};
  image->hash_ = hash_bytes(std::as_bytes(std::span(parts)));
  return ImagePtr(image);
}

}  // namespace tweend::model
