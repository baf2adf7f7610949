#include "server/animation/triple_lanes.hpp"

#include <gtest/gtest.h>

namespace tweend::animation {
namespace {

template <class T>
class TripleLanesOf : public testing::Test {};
using LaneCounts = testing::Types<std::integral_constant<std::size_t, 1>, std::integral_constant<std::size_t, 2>,
                                  std::integral_constant<std::size_t, 4>, std::integral_constant<std::size_t, 8>,
                                  std::integral_constant<std::size_t, 16>>;
TYPED_TEST_SUITE(TripleLanesOf, LaneCounts);

/// Walks through the kernel's steps with vertex numbers in place of coordinates.
TYPED_TEST(TripleLanesOf, GathersEachComponentAndFindsTheWayBack) {
  constexpr std::size_t kLanes = TypeParam::value;
  constexpr TripleLanes<kLanes> kTriple;
  std::array<std::array<std::size_t, kLanes>, 3> gathered{};  // [component][lane] = vertex
  for (std::size_t component = 0; component < 3; ++component) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      int sources = 0;
      for (std::size_t vector = 0; vector < 3; ++vector) {
        if (kTriple.is_residue[TripleLanes<kLanes>::residue(component, vector)][lane] == 0) continue;
        ++sources;
        const std::size_t stream = vector * kLanes + lane;
        EXPECT_EQ(stream % 3, component);
        gathered[component][lane] = stream / 3;
      }
      EXPECT_EQ(sources, 1) << "component " << component << ", lane " << lane;
    }
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::size_t vertex = gathered[0][lane];
    EXPECT_EQ(static_cast<std::size_t>(kTriple.vertex[lane]), vertex);
    EXPECT_EQ(gathered[1][static_cast<std::size_t>(kTriple.y_beside_x[lane])], vertex);
    EXPECT_EQ(gathered[2][static_cast<std::size_t>(kTriple.z_beside_x[lane])], vertex);
  }
  for (std::size_t stream = 0; stream < 3 * kLanes; ++stream) {
    const auto lane = static_cast<std::size_t>(kTriple.x_of[stream / kLanes][stream % kLanes]);
    EXPECT_EQ(gathered[0][lane], stream / 3);
  }
}

}  // namespace
}  // namespace tweend::animation
