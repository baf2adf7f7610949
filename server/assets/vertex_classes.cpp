#include "server/assets/vertex_classes.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tweend::assets {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// From 0: an absent index is a value like any other.
std::size_t value_of(const ObjCorner& corner, std::int32_t ObjCorner::*attribute) {
  return static_cast<std::size_t>(std::int64_t{corner.*attribute} + 1);
}

/// The corners' places in ascending order of their attribute, and of place where it's equal.
std::vector<std::uint32_t> sort_by(std::span<const ObjCorner> corners, std::int32_t ObjCorner::*attribute) {
  std::size_t largest = 0;
  for (const ObjCorner& corner : corners) largest = std::max(largest, value_of(corner, attribute));
  std::vector<std::uint32_t> next(largest + 2, 0);  // where the next corner of each value goes
  for (const ObjCorner& corner : corners) ++next[value_of(corner, attribute) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<std::uint32_t> order(corners.size());
  for (std::uint32_t i = 0; i < corners.size(); ++i) order[next[value_of(corners[i], attribute)]++] = i;
  return order;
}

}  // namespace

void VertexClasses::split_by(std::span<const ObjCorner> corners, std::int32_t ObjCorner::*attribute) {
  // A vertex's corners of one value follow each other in this order, so the first of them can be kept per vertex.
  std::vector<std::uint32_t> leader_of_class(count_, kNone);
  std::vector<std::uint32_t> leader_of_corner(classes_.size());
  for (const std::uint32_t corner : sort_by(corners, attribute)) {
    std::uint32_t& leader = leader_of_class[classes_[corner]];
    if (leader == kNone || corners[leader].*attribute != corners[corner].*attribute) leader = corner;
    leader_of_corner[corner] = leader;
  }
  // A leader stands before all it leads: numbering in order of corners is numbering in order of first use.
  count_ = 0;
  for (std::uint32_t corner = 0; corner < classes_.size(); ++corner) {
    const std::uint32_t leader = leader_of_corner[corner];
    classes_[corner] = leader == corner ? static_cast<std::uint32_t>(count_++) : classes_[leader];
  }
}

}  // namespace tweend::assets
