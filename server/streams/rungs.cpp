#include "server/streams/rungs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tweend::streams {
namespace {

std::uint32_t scaled(std::uint32_t side, double scale) noexcept {
  return std::max(1U, static_cast<std::uint32_t>(std::lround(static_cast<double>(side) * scale)));
}

}  // namespace

render::Size size_on_rung(render::Size size, std::size_t rung) noexcept {
  const double scale = kRungs[rung].scale;
  return {scaled(size.width, scale), scaled(size.height, scale)};
}

int quality_on_rung(int quality, std::size_t rung) noexcept {
  return std::clamp(static_cast<int>(std::lround(quality * kRungs[rung].quality)), 1, 100);
}

}  // namespace tweend::streams
