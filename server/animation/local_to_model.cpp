#include "server/animation/local_to_model.hpp"

#include <algorithm>
#include <cstddef>

// Compiled once per kind of vector unit: foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/animation/local_to_model.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/animation/affine_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tweend::animation::HWY_NAMESPACE {
namespace {

/// The local matrices of kPoseLanes joints, row by row, in the order of place().
struct LocalRows {
  HWY_ALIGN float row[3][kPoseLanes][4];
};

HWY_INLINE PoseV at(const Pose& pose, PoseRow row, std::size_t joint) {
  return hn::LoadU(PoseTag(), pose.row(row).data() + joint);
}

/// T · R · S of a vector of joints.
HWY_INLINE void local_matrices(const Pose& pose, std::size_t joint, std::size_t lane, LocalRows& out) {
  const PoseV x = at(pose, PoseRow::Rx, joint), y = at(pose, PoseRow::Ry, joint);
  const PoseV z = at(pose, PoseRow::Rz, joint), w = at(pose, PoseRow::Rw, joint);
  const PoseV sx = at(pose, PoseRow::Sx, joint), sy = at(pose, PoseRow::Sy, joint), sz = at(pose, PoseRow::Sz, joint);
  const PoseV one = constant(1.0F);
  const PoseV x2 = hn::Add(x, x), y2 = hn::Add(y, y), z2 = hn::Add(z, z);
  const PoseV xx = hn::Mul(x, x2), yy = hn::Mul(y, y2), zz = hn::Mul(z, z2);
  const PoseV wx = hn::Mul(w, x2), wy = hn::Mul(w, y2), wz = hn::Mul(w, z2);
  store_rows(hn::Mul(hn::Sub(hn::Sub(one, yy), zz), sx), hn::Mul(hn::MulSub(x, y2, wz), sy), hn::Mul(hn::MulAdd(x, z2, wy), sz),
             at(pose, PoseRow::Tx, joint), out.row[0][lane]);
  store_rows(hn::Mul(hn::MulAdd(x, y2, wz), sx), hn::Mul(hn::Sub(hn::Sub(one, xx), zz), sy), hn::Mul(hn::MulSub(y, z2, wx), sz),
             at(pose, PoseRow::Ty, joint), out.row[1][lane]);
  store_rows(hn::Mul(hn::MulSub(x, z2, wy), sx), hn::Mul(hn::MulAdd(y, z2, wx), sy), hn::Mul(hn::Sub(hn::Sub(one, xx), yy), sz),
             at(pose, PoseRow::Tz, joint), out.row[2][lane]);
}

#if HWY_TARGET == HWY_SCALAR

/// Puts a joint under its parent.
HWY_INLINE void put_under(const Affine& parent, const LocalRows& local, std::size_t at, Affine& out) {
  Affine matrix;
  for (std::size_t i = 0; i < 3; ++i) std::copy_n(local.row[i][at], 4, &matrix.rows[i].x);
  out = multiply(parent, matrix);
}

#else

using PairTag = hn::CappedTag<float, 8>;  // two rows of a matrix, where a vector has room for them
using RowTag = hn::FixedTag<float, 4>;
HWY_ALIGN constexpr std::uint32_t kLastLane[4] = {0, 0, 0, ~0U};

/// One row of a product, or two: of `parent` times the local rows, plus the parent's own translation.
template <class Tag>
HWY_INLINE hn::Vec<Tag> product_rows(Tag d, const float* parent, const float* local0, const float* local1,
                                     const float* local2) {
  const hn::Vec<Tag> rows = hn::LoadU(d, parent);
  hn::Vec<Tag> sum = hn::And(rows, hn::BitCast(d, hn::LoadDup128(hn::RebindToUnsigned<Tag>(), kLastLane)));
  sum = hn::MulAdd(hn::Broadcast<2>(rows), hn::LoadDup128(d, local2), sum);
  sum = hn::MulAdd(hn::Broadcast<1>(rows), hn::LoadDup128(d, local1), sum);
  return hn::MulAdd(hn::Broadcast<0>(rows), hn::LoadDup128(d, local0), sum);
}

/// Puts a joint under its parent.
HWY_INLINE void put_under(const Affine& parent, const LocalRows& local, std::size_t at, Affine& out) {
  const PairTag pair;
  const RowTag row;
  const float *local0 = local.row[0][at], *local1 = local.row[1][at], *local2 = local.row[2][at];
  const float* from = &parent.rows[0].x;
  float* to = &out.rows[0].x;
  for (std::size_t i = 0; i < 8; i += hn::MaxLanes(pair)) {
    hn::StoreU(product_rows(pair, from + i, local0, local1, local2), pair, to + i);
  }
  hn::StoreU(product_rows(row, from + 8, local0, local1, local2), row, to + 8);
}

#endif

/// Puts joints [first, first + count) under their parents, one after the other.
HWY_INLINE void put_all_under(const std::int32_t* parents, const LocalRows& local, std::size_t first, std::size_t count,
                              Affine* out) {
  for (std::size_t lane = 0; lane < count; ++lane) {
    Affine& to = out[first + lane];
    const std::int32_t parent = parents[first + lane];
    const std::size_t at = place(lane);
    if (parent >= 0) {
      put_under(out[parent], local, at, to);
    } else {
      for (std::size_t i = 0; i < 3; ++i) std::copy_n(local.row[i][at], 4, &to.rows[i].x);
    }
  }
}

void local_to_model_here(const std::int32_t* parents, const Pose& pose, Affine* out) {
  LocalRows local;
  const std::size_t joints = pose.joint_count();
  for (std::size_t first = 0; first < joints; first += kPoseLanes) {
    for (std::size_t lane = 0; lane < kPoseLanes; lane += hn::Lanes(PoseTag())) {
      local_matrices(pose, first + lane, lane, local);
    }
    put_all_under(parents, local, first, std::min(kPoseLanes, joints - first), out);
  }
}

}  // namespace
}  // namespace tweend::animation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tweend::animation {

HWY_EXPORT(local_to_model_here);

void local_to_model(std::span<const std::int32_t> parents, const Pose& pose, std::span<Affine> model_from_joint) noexcept {
  HWY_DYNAMIC_DISPATCH(local_to_model_here)(parents.data(), pose, model_from_joint.data());
}

}  // namespace tweend::animation
#endif
