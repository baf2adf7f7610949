#include "server/animation/blend_kernels.hpp"

#include <algorithm>
#include <limits>

#include "server/animation/triple_lanes.hpp"

// Compiled once per kind of vector unit: foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/animation/blend_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tweend::animation::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_HAVE_SCALABLE
using Floats = hn::FixedTag<float, 4>;  // TripleLanes needs a lane count known when compiling
#else
using Floats = hn::ScalableTag<float>;
#endif
using V = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;
constexpr std::size_t kLanes = hn::MaxLanes(Floats());
constexpr std::size_t kStep = 3 * kLanes;  ///< floats blended at a time: kLanes vertices
using Triple = TripleLanes<kLanes>;
constexpr Triple kTriple;

struct Values {};
struct Directions {};

/// A StreamBlend taken apart, in variables of its own: vector stores may alias anything that has an address, and the
/// compiler would load the pointers and weights anew after each.
struct Streams {
  explicit Streams(const StreamBlend& blend)
      : weight0(blend.weight[0]),
        weight1(blend.weight[1]),
        weight2(blend.weight[2]),
        weight3(blend.weight[3]),
        source0(blend.source[0]),
        source1(blend.source[1]),
        source2(blend.source[2]),
        source3(blend.source[3]),
        nearest(blend.source[blend.nearest]),
        out(blend.out) {}
  float weight0, weight1, weight2, weight3;
  const float *source0, *source1, *source2, *source3;
  const float* nearest;
  float* out;
};

/// kLanes floats of the blend from index i.
template <std::size_t kSources>
HWY_INLINE V weighted_sum(const Streams& s, std::size_t i) {
  const Floats d;
  V sum = hn::Mul(hn::Set(d, s.weight0), hn::LoadU(d, s.source0 + i));
  if constexpr (kSources > 1) sum = hn::MulAdd(hn::Set(d, s.weight1), hn::LoadU(d, s.source1 + i), sum);
  if constexpr (kSources > 2) sum = hn::MulAdd(hn::Set(d, s.weight2), hn::LoadU(d, s.source2 + i), sum);
  if constexpr (kSources > 3) sum = hn::MulAdd(hn::Set(d, s.weight3), hn::LoadU(d, s.source3 + i), sum);
  return sum;
}

/// Plain values, kStep floats from index i.
template <std::size_t kSources>
HWY_INLINE void blend_step(Values, const Streams& s, std::size_t i) {
  const V a = weighted_sum<kSources>(s, i);
  const V b = weighted_sum<kSources>(s, i + kLanes);
  const V c = weighted_sum<kSources>(s, i + 2 * kLanes);
  hn::StoreU(a, Floats(), s.out + i);
  hn::StoreU(b, Floats(), s.out + i + kLanes);
  hn::StoreU(c, Floats(), s.out + i + 2 * kLanes);
}

HWY_INLINE Mask residue_mask(std::size_t residue) {
  const Floats d;
  const hn::RebindToSigned<Floats> ints;
  return hn::MaskFromVec(hn::BitCast(d, hn::LoadU(ints, kTriple.is_residue[residue].data())));
}

/// All lanes of one component (0 to 2) out of the interleaved vectors a, b, c, in an order of its own.
template <std::size_t kComponent>
HWY_INLINE V gather(V a, V b, V c) {
  const Mask in_b = residue_mask(Triple::residue(kComponent, 1));
  const Mask in_c = residue_mask(Triple::residue(kComponent, 2));
  return hn::IfThenElse(in_c, c, hn::IfThenElse(in_b, b, a));
}

HWY_INLINE V permute(V v, const Triple::Lanes& lanes) {
  return hn::TableLookupLanes(v, hn::SetTableIndices(Floats(), lanes.data()));
}

HWY_INLINE V length_square(V aa, V bb, V cc) {
  const V xx = gather<0>(aa, bb, cc);
  const V yy = permute(gather<1>(aa, bb, cc), kTriple.y_beside_x);
  const V zz = permute(gather<2>(aa, bb, cc), kTriple.z_beside_x);
  return hn::Add(hn::Add(xx, yy), zz);
}

constexpr float kShortestSquare = kShortestDirection * kShortestDirection;
constexpr float kLongestSquare = std::numeric_limits<float>::max();

/// Replaces the directions whose length says nothing. `square` is in the order of the gathered x.
HWY_NOINLINE void take_nearest(const float* nearest, float* out, V square) {
  float squares[kLanes];
  hn::StoreU(square, Floats(), squares);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (squares[lane] >= kShortestSquare && squares[lane] <= kLongestSquare) continue;
    const std::size_t first = 3 * static_cast<std::size_t>(kTriple.vertex[lane]);
    std::copy_n(nearest + first, 3, out + first);
  }
}

/// Directions, scaled to unit length without leaving their interleaved order: only their squares are gathered.
/// Division and square root are as fast here as an estimate with a Newton step, because memory is the limit, and exact.
template <std::size_t kSources>
HWY_INLINE void blend_step(Directions, const Streams& s, std::size_t i) {
  const Floats d;
  const V a = weighted_sum<kSources>(s, i);
  const V b = weighted_sum<kSources>(s, i + kLanes);
  const V c = weighted_sum<kSources>(s, i + 2 * kLanes);
  const V square = length_square(hn::Mul(a, a), hn::Mul(b, b), hn::Mul(c, c));
  const V scale = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(square));
  hn::StoreU(hn::Mul(a, permute(scale, kTriple.x_of[0])), d, s.out + i);
  hn::StoreU(hn::Mul(b, permute(scale, kTriple.x_of[1])), d, s.out + i + kLanes);
  hn::StoreU(hn::Mul(c, permute(scale, kTriple.x_of[2])), d, s.out + i + 2 * kLanes);
  // False for NaN too.
  const Mask usable = hn::And(hn::Ge(square, hn::Set(d, kShortestSquare)), hn::Le(square, hn::Set(d, kLongestSquare)));
  if (HWY_UNLIKELY(!hn::AllTrue(d, usable))) take_nearest(s.nearest + i, s.out + i, square);
}

/// Fewer floats than a step takes are blended in padded copies: by the same operations as all others, so that a value
/// does not depend on the size of its array.
template <class Kind, std::size_t kSources>
HWY_NOINLINE void blend_padded(const StreamBlend& blend) {
  float in[kSources][kStep];
  float out[kStep];
  StreamBlend padded = blend;
  for (std::size_t s = 0; s < kSources; ++s) {
    std::fill_n(std::copy_n(blend.source[s], blend.size, in[s]), kStep - blend.size, 1.0F);
    padded.source[s] = in[s];
  }
  padded.out = out;
  blend_step<kSources>(Kind(), Streams(padded), 0);
  std::copy_n(out, blend.size, blend.out);
}

template <class Kind, std::size_t kSources>
void blend_all(const StreamBlend& blend) {
  if (blend.size < kStep) return blend_padded<Kind, kSources>(blend);
  const Streams streams(blend);
  const std::size_t last = blend.size - kStep;
  for (std::size_t i = 0; i < last; i += kStep) blend_step<kSources>(Kind(), streams, i);
  blend_step<kSources>(Kind(), streams, last);  // makes some of the step before anew, the same
}

template <class Kind>
void blend_as(const StreamBlend& blend) {
  switch (blend.source_count) {
    case 1:
      return blend_all<Kind, 1>(blend);
    case 2:
      return blend_all<Kind, 2>(blend);
    case 3:
      return blend_all<Kind, 3>(blend);
    default:
      return blend_all<Kind, 4>(blend);
  }
}

void blend_values_here(const StreamBlend& blend) { blend_as<Values>(blend); }
void blend_directions_here(const StreamBlend& blend) { blend_as<Directions>(blend); }

}  // namespace
}  // namespace tweend::animation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tweend::animation {

HWY_EXPORT(blend_values_here);
HWY_EXPORT(blend_directions_here);

void blend_values(const StreamBlend& blend) noexcept { HWY_DYNAMIC_DISPATCH(blend_values_here)(blend); }
void blend_directions(const StreamBlend& blend) noexcept { HWY_DYNAMIC_DISPATCH(blend_directions_here)(blend); }

}  // namespace tweend::animation
#endif
