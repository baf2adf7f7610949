#include "server/animation/blend_poses.hpp"

#include <algorithm>
#include <cstddef>

// Compiled once per kind of vector unit: foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/animation/blend_poses.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/animation/quaternion_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tweend::animation::HWY_NAMESPACE {
namespace {

constexpr std::size_t kTx = static_cast<std::size_t>(PoseRow::Tx);
constexpr std::size_t kRx = static_cast<std::size_t>(PoseRow::Rx);
constexpr std::size_t kSx = static_cast<std::size_t>(PoseRow::Sx);

/// The rows of a pose from one vector of joints on.
struct Rows {
  Rows(const Pose& pose, std::size_t joint) : first(pose.row(PoseRow::Tx).data() + joint), stride(pose.stride()) {}
  [[nodiscard]] HWY_INLINE PoseV load(std::size_t row) const { return hn::LoadU(PoseTag(), first + row * stride); }
  const float* first;
  std::size_t stride;
};

HWY_INLINE void store(Pose& pose, std::size_t row, std::size_t joint, PoseV value) {
  hn::StoreU(value, PoseTag(), pose.row(static_cast<PoseRow>(row)).data() + joint);
}

/// The weight of each of kPoseLanes joints; that of padding is 0.
void lane_weights(float weight, std::span<const float> mask, std::size_t first, std::size_t joints, float* out) {
  for (std::size_t lane = 0; lane < kPoseLanes; ++lane) {
    const std::size_t joint = first + lane;
    out[lane] = joint >= joints ? 0.0F : mask.empty() ? weight : weight * mask[joint];
  }
}

/// One vector of joints: `blended` where the weight lies between, what it leads to at 1, and nothing new at 0.
struct Mix {
  explicit Mix(const float* weights) : weight(weights) {}
  [[nodiscard]] HWY_INLINE PoseV load() const { return hn::LoadU(PoseTag(), weight); }
  [[nodiscard]] HWY_INLINE PoseV choose(PoseV from, PoseV to, PoseV blended) const {
    const PoseV w = load();
    const PoseV below_one = hn::IfThenElse(hn::Eq(w, constant(1.0F)), to, blended);
    return hn::IfThenElse(hn::Eq(w, hn::Zero(PoseTag())), from, below_one);
  }
  const float* weight;
};

HWY_INLINE void blend_row(const Mix& mix, const Rows& from, const Rows& to, std::size_t row, std::size_t joint, Pose& pose) {
  const PoseV a = from.load(row), b = to.load(row);
  const PoseV w = mix.load();
  store(pose, row, joint, mix.choose(a, b, hn::MulAdd(w, b, hn::Mul(hn::Sub(constant(1.0F), w), a))));
}

HWY_INLINE void blend_vector(const Mix& mix, const Pose& to_pose, std::size_t joint, Pose& pose) {
  const Rows from(pose, joint), to(to_pose, joint);
  for (const std::size_t first : {kTx, kSx}) {
    for (std::size_t row = first; row < first + 3; ++row) blend_row(mix, from, to, row, joint, pose);
  }
  const PoseV ax = from.load(kRx), ay = from.load(kRx + 1), az = from.load(kRx + 2), aw = from.load(kRx + 3);
  const PoseV bx = to.load(kRx), by = to.load(kRx + 1), bz = to.load(kRx + 2), bw = to.load(kRx + 3);
  PoseV u1 = mix.load();
  PoseV u0 = hn::Sub(constant(1.0F), u1);
  slerp_weights(dot(ax, ay, az, aw, bx, by, bz, bw), u0, u1);
  store(pose, kRx, joint, mix.choose(ax, bx, hn::MulAdd(u1, bx, hn::Mul(u0, ax))));
  store(pose, kRx + 1, joint, mix.choose(ay, by, hn::MulAdd(u1, by, hn::Mul(u0, ay))));
  store(pose, kRx + 2, joint, mix.choose(az, bz, hn::MulAdd(u1, bz, hn::Mul(u0, az))));
  store(pose, kRx + 3, joint, mix.choose(aw, bw, hn::MulAdd(u1, bw, hn::Mul(u0, aw))));
}

void blend_poses_here(const Pose& to, float weight, std::span<const float> mask, Pose& pose) {
  HWY_ALIGN float weights[kPoseLanes];
  for (std::size_t first = 0; first < pose.joint_count(); first += kPoseLanes) {
    lane_weights(weight, mask, first, pose.joint_count(), weights);
    for (std::size_t lane = 0; lane < kPoseLanes; lane += hn::Lanes(PoseTag())) {
      blend_vector(Mix(weights + lane), to, first + lane, pose);
    }
  }
}

/// a · b: first b, then a.
HWY_INLINE void multiply(PoseV ax, PoseV ay, PoseV az, PoseV aw, PoseV bx, PoseV by, PoseV bz, PoseV bw, PoseV& x, PoseV& y,
                         PoseV& z, PoseV& w) {
  x = hn::NegMulAdd(az, by, hn::MulAdd(ay, bz, hn::MulAdd(ax, bw, hn::Mul(aw, bx))));
  y = hn::NegMulAdd(ax, bz, hn::MulAdd(az, bx, hn::MulAdd(ay, bw, hn::Mul(aw, by))));
  z = hn::NegMulAdd(ay, bx, hn::MulAdd(ax, by, hn::MulAdd(az, bw, hn::Mul(aw, bz))));
  w = hn::NegMulAdd(az, bz, hn::NegMulAdd(ay, by, hn::NegMulAdd(ax, bx, hn::Mul(aw, bw))));
}

HWY_INLINE void add_rotations(const Mix& mix, const Rows& layer, const Rows& rest, std::size_t joint, Pose& pose) {
  const Rows from(pose, joint);
  PoseV tx, ty, tz, tw;  // rest⁻¹ · layer
  multiply(hn::Neg(rest.load(kRx)), hn::Neg(rest.load(kRx + 1)), hn::Neg(rest.load(kRx + 2)), rest.load(kRx + 3),
           layer.load(kRx), layer.load(kRx + 1), layer.load(kRx + 2), layer.load(kRx + 3), tx, ty, tz, tw);
  PoseV part = mix.load();
  PoseV none = hn::Sub(constant(1.0F), part);  // of the identity, whose cosine with the turn is its w
  slerp_weights(tw, none, part);
  const PoseV ax = from.load(kRx), ay = from.load(kRx + 1), az = from.load(kRx + 2), aw = from.load(kRx + 3);
  PoseV x, y, z, w;
  multiply(ax, ay, az, aw, hn::Mul(part, tx), hn::Mul(part, ty), hn::Mul(part, tz), hn::MulAdd(part, tw, none), x, y, z, w);
  store(pose, kRx, joint, mix.choose(ax, x, x));
  store(pose, kRx + 1, joint, mix.choose(ay, y, y));
  store(pose, kRx + 2, joint, mix.choose(az, z, z));
  store(pose, kRx + 3, joint, mix.choose(aw, w, w));
}

HWY_INLINE void add_vector(const Mix& mix, const Pose& layer_pose, const Pose& rest_pose, std::size_t joint, Pose& pose) {
  const Rows from(pose, joint), layer(layer_pose, joint), rest(rest_pose, joint);
  const PoseV one = constant(1.0F);
  const PoseV w = mix.load();
  for (std::size_t row = kTx; row < kTx + 3; ++row) {
    const PoseV moved = hn::MulAdd(w, hn::Sub(layer.load(row), rest.load(row)), from.load(row));
    store(pose, row, joint, mix.choose(from.load(row), moved, moved));
  }
  for (std::size_t row = kSx; row < kSx + 3; ++row) {
    const PoseV base = rest.load(row);
    const PoseV factor = hn::IfThenElse(hn::Eq(base, hn::Zero(PoseTag())), one, hn::Div(layer.load(row), base));
    const PoseV scaled = hn::Mul(from.load(row), hn::MulAdd(w, hn::Sub(factor, one), one));
    store(pose, row, joint, mix.choose(from.load(row), scaled, scaled));
  }
  add_rotations(mix, layer, rest, joint, pose);
}

void add_pose_here(const Pose& layer, const Pose& rest, float weight, std::span<const float> mask, Pose& pose) {
  HWY_ALIGN float weights[kPoseLanes];
  for (std::size_t first = 0; first < pose.joint_count(); first += kPoseLanes) {
    lane_weights(weight, mask, first, pose.joint_count(), weights);
    for (std::size_t lane = 0; lane < kPoseLanes; lane += hn::Lanes(PoseTag())) {
      add_vector(Mix(weights + lane), layer, rest, first + lane, pose);
    }
  }
}

}  // namespace
}  // namespace tweend::animation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tweend::animation {

HWY_EXPORT(blend_poses_here);
HWY_EXPORT(add_pose_here);

void blend_poses(const Pose& to, float weight, std::span<const float> mask, Pose& pose) noexcept {
  if (weight == 0.0F) return;
  HWY_DYNAMIC_DISPATCH(blend_poses_here)(to, weight, mask, pose);
  if (!mask.empty()) return;
  for (std::size_t i = 0; i < pose.weights().size(); ++i) {
    float& value = pose.weights()[i];
    value = weight == 1.0F ? to.weights()[i] : value + weight * (to.weights()[i] - value);
  }
}

void add_pose(const Pose& layer, const Pose& rest, float weight, std::span<const float> mask, Pose& pose) noexcept {
  if (weight == 0.0F) return;
  HWY_DYNAMIC_DISPATCH(add_pose_here)(layer, rest, weight, mask, pose);
  if (!mask.empty()) return;
  for (std::size_t i = 0; i < pose.weights().size(); ++i) {
    pose.weights()[i] += weight * (layer.weights()[i] - rest.weights()[i]);
  }
}

}  // namespace tweend::animation
#endif
