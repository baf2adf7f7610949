// Rows of many matrices between memory, where each is x y z w side by side, and vectors, where a matrix is a lane. Included by
// kernels, once per kind of vector unit: no #pragma once.
#if defined(TWEEND_AFFINE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef TWEEND_AFFINE_LANES
#undef TWEEND_AFFINE_LANES
#else
#define TWEEND_AFFINE_LANES
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "server/animation/quaternion_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tweend::animation::HWY_NAMESPACE {

constexpr std::size_t kLanesHere = hn::MaxLanes(PoseTag());

/// Where the row of a lane's matrix stands in memory. A transposition within blocks of four lanes is half the work of a whole
/// one; in memory, the order costs nothing.
constexpr std::size_t place(std::size_t lane) {
  if constexpr (kLanesHere < 4) return lane;
  const std::size_t in_vector = lane % kLanesHere;
  return lane - in_vector + in_vector % 4 * (kLanesHere / 4) + in_vector / 4;
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE void store_rows(PoseV x, PoseV y, PoseV z, PoseV w, float* to) { hn::StoreInterleaved4(x, y, z, w, PoseTag(), to); }

HWY_INLINE void load_rows(const float* from, PoseV& x, PoseV& y, PoseV& z, PoseV& w) {
  hn::LoadInterleaved4(PoseTag(), from, x, y, z, w);
}

#else

/// Within blocks of four lanes, makes columns of rows and rows of columns.
HWY_INLINE void transpose_blocks(PoseV& x, PoseV& y, PoseV& z, PoseV& w) {
  const PoseTag d;
  const PoseV xz_low = hn::InterleaveLower(d, x, z), xz_high = hn::InterleaveUpper(d, x, z);
  const PoseV yw_low = hn::InterleaveLower(d, y, w), yw_high = hn::InterleaveUpper(d, y, w);
  x = hn::InterleaveLower(d, xz_low, yw_low);
  y = hn::InterleaveUpper(d, xz_low, yw_low);
  z = hn::InterleaveLower(d, xz_high, yw_high);
  w = hn::InterleaveUpper(d, xz_high, yw_high);
}

/// Stores a vector of rows, x y z w of each lane side by side, in the order of place().
HWY_INLINE void store_rows(PoseV x, PoseV y, PoseV z, PoseV w, float* to) {
  transpose_blocks(x, y, z, w);
  hn::StoreU(x, PoseTag(), to);
  hn::StoreU(y, PoseTag(), to + kLanesHere);
  hn::StoreU(z, PoseTag(), to + 2 * kLanesHere);
  hn::StoreU(w, PoseTag(), to + 3 * kLanesHere);
}

/// Loads what store_rows would have stored.
HWY_INLINE void load_rows(const float* from, PoseV& x, PoseV& y, PoseV& z, PoseV& w) {
  x = hn::LoadU(PoseTag(), from);
  y = hn::LoadU(PoseTag(), from + kLanesHere);
  z = hn::LoadU(PoseTag(), from + 2 * kLanesHere);
  w = hn::LoadU(PoseTag(), from + 3 * kLanesHere);
  transpose_blocks(x, y, z, w);
}

#endif

}  // namespace tweend::animation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
