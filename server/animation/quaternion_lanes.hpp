// Rotations as four vectors x, y, z, w, a joint a lane. Included by kernels, once per kind of vector unit: no #pragma once.
#if defined(TWEEND_QUATERNION_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef TWEEND_QUATERNION_LANES
#undef TWEEND_QUATERNION_LANES
#else
#define TWEEND_QUATERNION_LANES
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "server/animation/pose.hpp"

HWY_BEFORE_NAMESPACE();
namespace tweend::animation::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using PoseTag = hn::CappedTag<float, kPoseLanes>;
using PoseV = hn::Vec<PoseTag>;

HWY_INLINE PoseV constant(float value) { return hn::Set(PoseTag(), value); }

HWY_INLINE PoseV dot(PoseV ax, PoseV ay, PoseV az, PoseV aw, PoseV bx, PoseV by, PoseV bz, PoseV bw) {
  return hn::MulAdd(aw, bw, hn::MulAdd(az, bz, hn::MulAdd(ay, by, hn::Mul(ax, bx))));
}

/// The sign bit where `cosine` is below 0: what turns a quaternion into the hemisphere of its neighbour.
HWY_INLINE PoseV flip_where_negative(PoseV cosine) {
  return hn::IfThenElseZero(hn::Lt(cosine, hn::Zero(PoseTag())), constant(-0.0F));
}

/// acos(1 − x)² for 0 <= x <= 1: unlike the angle itself it is smooth at 0. This and the next two are Chebyshev
/// interpolations, exact at 0; together they leave the weights below within 3e-7.
HWY_INLINE PoseV angle_square(PoseV x) {
  PoseV p = constant(0.00898615454F);
  p = hn::MulAdd(p, x, constant(-0.00991156646F));
  p = hn::MulAdd(p, x, constant(0.0209522031F));
  p = hn::MulAdd(p, x, constant(0.0244833323F));
  p = hn::MulAdd(p, x, constant(0.0896019434F));
  p = hn::MulAdd(p, x, constant(0.333287736F));
  p = hn::MulAdd(p, x, constant(2.0F));
  return hn::Mul(p, x);
}

/// a / sin a of the angle a with cosine 1 − x, 0 <= x <= 1.
HWY_INLINE PoseV angle_over_sine(PoseV x) {
  PoseV p = constant(0.0127232925F);
  p = hn::MulAdd(p, x, constant(-0.0242560185F));
  p = hn::MulAdd(p, x, constant(0.0321926243F));
  p = hn::MulAdd(p, x, constant(-0.00237361047F));
  p = hn::MulAdd(p, x, constant(0.0291656957F));
  p = hn::MulAdd(p, x, constant(0.0566537583F));
  p = hn::MulAdd(p, x, constant(0.133357078F));
  p = hn::MulAdd(p, x, constant(0.333333147F));
  return hn::MulAdd(p, x, constant(1.0F));
}

/// sin a / a of an angle with this square, up to a right angle.
HWY_INLINE PoseV sine_over_angle(PoseV square) {
  PoseV p = constant(2.63475639e-06F);
  p = hn::MulAdd(p, square, constant(-0.000198227395F));
  p = hn::MulAdd(p, square, constant(0.00833324214F));
  p = hn::MulAdd(p, square, constant(-0.16666666F));
  return hn::MulAdd(p, square, constant(1.0F));
}

/// sin(part · a) / sin a of angles with cosine 1 − x, whatever the part: where an easing overshoots.
inline HWY_NOINLINE PoseV far_sine_part(PoseV part, PoseV x) {
  HWY_ALIGN float parts[kPoseLanes];
  HWY_ALIGN float xs[kPoseLanes];
  hn::Store(part, PoseTag(), parts);
  hn::Store(x, PoseTag(), xs);
  for (std::size_t lane = 0; lane < hn::Lanes(PoseTag()); ++lane) {
    // Below this angle the quotient is `part`, but for less than a float tells apart.
    const double angle = std::max(std::acos(std::clamp(1.0 - static_cast<double>(xs[lane]), -1.0, 1.0)), 1e-5);
    parts[lane] = static_cast<float>(std::sin(static_cast<double>(parts[lane]) * angle) / std::sin(angle));
  }
  return hn::Load(PoseTag(), parts);
}

/// The weights of slerp (K. Shoemake, Animating rotation with quaternion curves, 1985) the short way, in place of 1 − u and
/// u. No division, no square root, and nothing special about small angles: sin(u·a) / sin a = u · S(u²a²) · (a / sin a) with
/// S(z) = sin(√z) / √z, all of them polynomials.
/// @param cosine  of the two rotations, −1 to 1; where it is below 0 the second rotation's weight changes its sign
HWY_INLINE void slerp_weights(PoseV cosine, PoseV& from, PoseV& to) {
  const PoseV x = hn::Sub(constant(1.0F), hn::Abs(cosine));
  const PoseV lowest = hn::Min(from, to);  // they sum to 1: where neither is below 0, neither is above 1
  if (HWY_UNLIKELY(!hn::AllTrue(PoseTag(), hn::Ge(lowest, hn::Zero(PoseTag()))))) {
    from = far_sine_part(from, x);
    to = far_sine_part(to, x);
  } else {
    const PoseV square = angle_square(x);
    const PoseV ratio = angle_over_sine(x);
    from = hn::Mul(hn::Mul(from, ratio), sine_over_angle(hn::Mul(hn::Mul(from, from), square)));
    to = hn::Mul(hn::Mul(to, ratio), sine_over_angle(hn::Mul(hn::Mul(to, to), square)));
  }
  to = hn::Xor(to, flip_where_negative(cosine));
}

}  // namespace tweend::animation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
