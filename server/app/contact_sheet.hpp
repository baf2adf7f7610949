#pragma once

#include <cstddef>
#include <vector>

#include "render/image_view.hpp"
#include "server/base/result.hpp"

namespace tweend::app {

/// Pictures of one size in one, left to right and top to bottom, a little apart. Bottom row first, as ImageView has it.
class ContactSheet {
 public:
  /// @return Limit where the whole would be larger than 16384 pixels a side, or 256 million of them
  [[nodiscard]] static Status check(render::Size each, std::size_t count);

  /// @param count  how many pictures there will be, at least 1; as check() says
  ContactSheet(render::Size each, std::size_t count);

  /// What the whole takes.
  [[nodiscard]] render::Size size() const noexcept { return size_; }
  void put(std::size_t index, const render::ImageView& picture);
  [[nodiscard]] render::ImageView view() const noexcept { return {size_, pixels_}; }

 private:
  render::Size each_;
  std::size_t columns_;
  render::Size size_;
  std::vector<std::byte> pixels_;
};

}  // namespace tweend::app
