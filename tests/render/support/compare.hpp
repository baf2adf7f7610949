#pragma once

#include <string>

#include "tests/render/support/image.hpp"

namespace tweend::render::test {

/// How far two pictures of one size are apart, 0 to 255.
struct Difference {
  double mean = 0.0;  ///< of all channels of all pixels
  double most = 0.0;  ///< of any channel, averaged over 5 × 5 pixels: an edge that moved by rounding is not much
};
[[nodiscard]] Difference difference(const Image& a, const Image& b);

/// What another Mesa's rounding may do, and no wrong term of the light does.
[[nodiscard]] inline bool alike(const Difference& d) { return d.mean < 0.4 && d.most < 6.0; }

/// Side by side: expected, found, and eight times their difference, on grey where they are the same.
[[nodiscard]] Image side_by_side(const Image& expected, const Image& found);

/// Compares with tests/render/golden/NAME.png. If they are not alike, writes what was found and the two side by side to
/// a folder under the build tree and fails with its path. TWEEND_UPDATE_GOLDEN=1 writes the golden file instead: look at it
/// before it is committed.
void expect_golden(const std::string& name, const Image& found);

}  // namespace tweend::render::test
