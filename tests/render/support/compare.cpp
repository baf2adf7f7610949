#include "tests/render/support/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace tweend::render::test {
namespace {

constexpr std::ptrdiff_t kReach = 2;  // pixels to each side that a neighbourhood has

/// The signed difference of a channel, averaged over the neighbourhood of a pixel as far as the picture goes.
double around(const Image& a, const Image& b, std::ptrdiff_t x, std::ptrdiff_t y, std::size_t channel) {
  const auto width = static_cast<std::ptrdiff_t>(a.size.width), height = static_cast<std::ptrdiff_t>(a.size.height);
  double sum = 0.0, count = 0.0;
  for (std::ptrdiff_t v = std::max<std::ptrdiff_t>(0, y - kReach); v <= std::min(height - 1, y + kReach); ++v) {
    for (std::ptrdiff_t u = std::max<std::ptrdiff_t>(0, x - kReach); u <= std::min(width - 1, x + kReach); ++u) {
      const std::size_t at = 3 * static_cast<std::size_t>(v * width + u) + channel;
      sum += double{static_cast<double>(a.rgb[at])} - b.rgb[at];
      ++count;
    }
  }
  return sum / count;
}

}  // namespace

Difference difference(const Image& a, const Image& b) {
  if (a.size != b.size || a.rgb.empty()) return {255.0, 255.0};
  Difference result;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) result.mean += std::abs(int{a.rgb[i]} - int{b.rgb[i]});
  result.mean /= static_cast<double>(a.rgb.size());
  for (std::uint32_t y = 0; y < a.size.height; ++y) {
    for (std::uint32_t x = 0; x < a.size.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) result.most = std::max(result.most, std::abs(around(a, b, x, y, c)));
    }
  }
  return result;
}

Image side_by_side(const Image& expected, const Image& found) {
  const Size size{std::max(expected.size.width, found.size.width), std::max(expected.size.height, found.size.height)};
  Image all(Size{3 * size.width, size.height});
  for (std::uint32_t y = 0; y < size.height; ++y) {
    for (std::uint32_t x = 0; x < size.width; ++x) {
      const auto color = [&](const Image& i) { return x < i.size.width && y < i.size.height ? i.at(x, y) : Rgb{255, 0, 255}; };
      const Rgb a = color(expected), b = color(found);
      Rgb amplified{};
      for (std::size_t c = 0; c < 3; ++c) amplified[c] = std::clamp(128 + 8 * (b[c] - a[c]), 0, 255);
      all.set(x, y, a);
      all.set(size.width + x, y, b);
      all.set(2 * size.width + x, y, amplified);
    }
  }
  return all;
}

void expect_golden(const std::string& name, const Image& found) {
  const std::string path = std::string(TWEEND_GOLDEN_DIR) + "/" + name + ".png";
  const char* update = std::getenv("TWEEND_UPDATE_GOLDEN");
  if (update != nullptr && std::string(update) == "1") return write_png(path, found);
  const Image golden = decode_png(read_file(path));
  const Difference d = difference(golden, found);
  if (alike(d)) return;
  const std::string folder = TWEEND_FOUND_DIR;
  std::filesystem::create_directories(folder);
  write_png(folder + "/" + name + "_found.png", found);
  write_png(folder + "/" + name + "_difference.png", side_by_side(golden, found));
  ADD_FAILURE() << name << ": mean difference " << d.mean << ", most " << d.most << "; look at\n  " << folder << "/" << name
                << "_difference.png  (golden, found, difference times 8)\n  and if it is right: TWEEND_UPDATE_GOLDEN=1";
}

}  // namespace tweend::render::test
