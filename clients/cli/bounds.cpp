#include "clients/cli/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "clients/cli/format.hpp"

namespace tweend::cli {

std::string bounds_text(std::span<const float> xyz) {
  if (xyz.size() < 3) return "-";
  std::array<float, 3> low{xyz[0], xyz[1], xyz[2]};
  std::array<float, 3> high = low;
  for (std::size_t i = 3; i + 3 <= xyz.size(); i += 3) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], xyz[i + axis]);
      high[axis] = std::max(high[axis], xyz[i + axis]);
    }
  }
  return fmt::format("{} to {}", point_text(low), point_text(high));
}

std::string point_text(const std::array<float, 3>& point) {
  return fmt::format("({}, {}, {})", number_text(static_cast<double>(point[0])), number_text(static_cast<double>(point[1])),
                     number_text(static_cast<double>(point[2])));
}

}  // namespace tweend::cli
