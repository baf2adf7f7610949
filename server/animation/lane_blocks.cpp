#include "server/animation/lane_blocks.hpp"

// Compiled once per kind of vector unit: foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/animation/lane_blocks.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/animation/quaternion_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tweend::animation::HWY_NAMESPACE {
namespace {

using Kind = SegmentBlend::Kind;

/// A SheetBlend in variables of its own, which stores to a pose can't alias.
struct SheetSources {
  explicit SheetSources(const SheetBlend& blend, const LaneBlock& block)
      : source0(first(blend.source[0], block)),
        source1(first(blend.source[1], block)),
        source2(first(blend.source[2], block)),
        source3(first(blend.source[3], block)),
        weight0(blend.weight[0]),
        weight1(blend.weight[1]),
        weight2(blend.weight[2]),
        weight3(blend.weight[3]) {}
  static const float* first(const Lanes* key, const LaneBlock& block) {
    return key == nullptr ? nullptr : key[block.offset].lane.data();
  }
  const float *source0, *source1, *source2, *source3;
  float weight0, weight1, weight2, weight3;
};

HWY_INLINE PoseV load(const float* from) { return hn::LoadU(PoseTag(), from); }

HWY_INLINE hn::Mask<PoseTag> load_mask(const std::int32_t* from) {
  return hn::MaskFromVec(hn::BitCast(PoseTag(), hn::LoadU(hn::RebindToSigned<PoseTag>(), from)));
}

template <bool kFull>
HWY_INLINE void put(PoseV value, const std::int32_t* covered, float* to) {
  if constexpr (!kFull) value = hn::IfThenElse(load_mask(covered), value, load(to));
  hn::StoreU(value, PoseTag(), to);
}

/// 1 / length, and 0 where there is no length to speak of.
HWY_INLINE PoseV inverse_length(PoseV x, PoseV y, PoseV z, PoseV w) {
  const PoseV square = dot(x, y, z, w, x, y, z, w);
  const PoseV inverse = hn::Div(constant(1.0F), hn::Sqrt(square));
  return hn::IfThenElseZero(hn::Gt(square, constant(1e-24F)), inverse);
}

/// Where a blend has left no rotation, the first source stands.
HWY_INLINE PoseV scaled_or(PoseV value, PoseV scale, PoseV otherwise) {
  return hn::IfThenElse(hn::Eq(scale, hn::Zero(PoseTag())), otherwise, hn::Mul(value, scale));
}

/// kPoseLanes floats of one component: Σ weight · source.
template <Kind kKind, bool kFull>
HWY_INLINE void blend_component(const SheetSources& s, const std::int32_t* covered, std::size_t at, float* out) {
  for (std::size_t lane = 0; lane < kPoseLanes; lane += hn::Lanes(PoseTag())) {
    const std::size_t i = at + lane;
    PoseV sum = load(s.source0 + i);
    if constexpr (kKind != Kind::Hold) {
      sum = hn::MulAdd(constant(s.weight1), load(s.source1 + i), hn::Mul(constant(s.weight0), sum));
    }
    if constexpr (kKind == Kind::CatmullRom || kKind == Kind::Cubic) {
      sum = hn::MulAdd(constant(s.weight2), load(s.source2 + i), sum);
      sum = hn::MulAdd(constant(s.weight3), load(s.source3 + i), sum);
    }
    put<kFull>(sum, covered + lane, out + lane);
  }
}

/// Slerps one vector of rotations.
template <bool kFull>
HWY_INLINE void slerp(const SheetSources& s, const std::int32_t* covered, std::size_t i, float* out, std::size_t stride) {
  const PoseV ax = load(s.source0 + i), ay = load(s.source0 + i + kPoseLanes);
  const PoseV az = load(s.source0 + i + 2 * kPoseLanes), aw = load(s.source0 + i + 3 * kPoseLanes);
  const PoseV bx = load(s.source1 + i), by = load(s.source1 + i + kPoseLanes);
  const PoseV bz = load(s.source1 + i + 2 * kPoseLanes), bw = load(s.source1 + i + 3 * kPoseLanes);
  PoseV from = constant(s.weight0);
  PoseV to = constant(s.weight1);
  slerp_weights(dot(ax, ay, az, aw, bx, by, bz, bw), from, to);
  put<kFull>(hn::MulAdd(to, bx, hn::Mul(from, ax)), covered, out);
  put<kFull>(hn::MulAdd(to, by, hn::Mul(from, ay)), covered, out + stride);
  put<kFull>(hn::MulAdd(to, bz, hn::Mul(from, az)), covered, out + 2 * stride);
  put<kFull>(hn::MulAdd(to, bw, hn::Mul(from, aw)), covered, out + 3 * stride);
}

HWY_INLINE PoseV key_cosine(const float* a, const float* b) {
  return dot(load(a), load(a + kPoseLanes), load(a + 2 * kPoseLanes), load(a + 3 * kPoseLanes),  //
             load(b), load(b + kPoseLanes), load(b + 2 * kPoseLanes), load(b + 3 * kPoseLanes));
}

HWY_INLINE PoseV weighted(const SheetSources& s, std::size_t i, PoseV w0, PoseV w1, PoseV w2, PoseV w3) {
  const PoseV sum = hn::MulAdd(w1, load(s.source1 + i), hn::Mul(w0, load(s.source0 + i)));
  return hn::MulAdd(w3, load(s.source3 + i), hn::MulAdd(w2, load(s.source2 + i), sum));
}

/// One vector of rotations as weighted sums of unit length.
template <Kind kKind, bool kFull>
HWY_INLINE void normalised(const SheetSources& s, const std::int32_t* covered, std::size_t i, float* out, std::size_t stride) {
  const PoseV w0 = constant(s.weight0);
  PoseV w1 = constant(s.weight1), w2 = constant(s.weight2), w3 = constant(s.weight3);
  if constexpr (kKind == Kind::CatmullRom) {  // keys before `from`, `from`, `to` and after it, in one hemisphere
    const PoseV flip1 = flip_where_negative(key_cosine(s.source0 + i, s.source1 + i));
    const PoseV flip2 = flip_where_negative(key_cosine(s.source0 + i, s.source2 + i));
    const PoseV flip3 = flip_where_negative(key_cosine(s.source1 + i, s.source3 + i));
    w1 = hn::Xor(w1, flip1);
    w2 = hn::Xor(w2, flip2);
    w3 = hn::Xor(w3, hn::Xor(flip1, flip3));
  }
  const PoseV x = weighted(s, i, w0, w1, w2, w3);
  const PoseV y = weighted(s, i + kPoseLanes, w0, w1, w2, w3);
  const PoseV z = weighted(s, i + 2 * kPoseLanes, w0, w1, w2, w3);
  const PoseV w = weighted(s, i + 3 * kPoseLanes, w0, w1, w2, w3);
  const PoseV scale = inverse_length(x, y, z, w);
  put<kFull>(scaled_or(x, scale, load(s.source0 + i)), covered, out);
  put<kFull>(scaled_or(y, scale, load(s.source0 + i + kPoseLanes)), covered, out + stride);
  put<kFull>(scaled_or(z, scale, load(s.source0 + i + 2 * kPoseLanes)), covered, out + 2 * stride);
  put<kFull>(scaled_or(w, scale, load(s.source0 + i + 3 * kPoseLanes)), covered, out + 3 * stride);
}

template <Kind kKind, bool kFull>
HWY_INLINE void blend_block(const SheetBlend& blend, const LaneBlock& block, const PoseFloats& pose) {
  const SheetSources sources(blend, block);
  const std::int32_t* covered = block.covered.data();
  float* out = pose.first(block);
  const std::size_t stride = pose.stride;
  if (kKind == Kind::Hold || block.property != Property::Rotation) {
    const std::size_t components = components_of(block.property);
    for (std::size_t c = 0; c < components; ++c) {
      blend_component<kKind, kFull>(sources, covered, c * kPoseLanes, out + c * stride);
    }
    return;
  }
  for (std::size_t lane = 0; lane < kPoseLanes; lane += hn::Lanes(PoseTag())) {
    if constexpr (kKind == Kind::Linear) {
      slerp<kFull>(sources, covered + lane, lane, out + lane, stride);
    } else {
      normalised<kKind, kFull>(sources, covered + lane, lane, out + lane, stride);
    }
  }
}

/// Blocks between asking for memory and using it. A crowd's keys and poses fill no near cache: asked for early, they cost a
/// third less; where they are near, asking costs next to nothing.
constexpr std::size_t kAhead = 3;

HWY_INLINE void prefetch(const SheetBlend& blend, const LaneBlock& block, const PoseFloats& pose) {
  const float* out = pose.first(block);
  for (std::size_t c = 0; c < components_of(block.property); ++c) {
    hwy::Prefetch(out + c * pose.stride);
    hwy::Prefetch(blend.source[0] + block.offset + c);
    hwy::Prefetch(blend.source[1] + block.offset + c);
  }
}

template <Kind kKind>
void blend_blocks(const SheetBlend& blend, std::span<const LaneBlock> blocks, const PoseFloats& pose) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i + kAhead < blocks.size()) prefetch(blend, blocks[i + kAhead], pose);
    const LaneBlock& block = blocks[i];
    block.is_full ? blend_block<kKind, true>(blend, block, pose) : blend_block<kKind, false>(blend, block, pose);
  }
}

void blend_sheet_here(const SheetBlend& blend, std::span<const LaneBlock> blocks, const PoseFloats& pose) {
  switch (blend.kind) {
    case Kind::Hold:
      return blend_blocks<Kind::Hold>(blend, blocks, pose);
    case Kind::Linear:
      return blend_blocks<Kind::Linear>(blend, blocks, pose);
    case Kind::CatmullRom:
      return blend_blocks<Kind::CatmullRom>(blend, blocks, pose);
    case Kind::Cubic:
      return blend_blocks<Kind::Cubic>(blend, blocks, pose);
  }
}

/// Component c of one vector of lanes.
HWY_INLINE PoseV loose_sum(const LooseBlend& b, std::size_t c, std::size_t lane, PoseV w0, PoseV w1) {
  PoseV sum = hn::Mul(w0, load(b.source[0][c].lane.data() + lane));
  sum = hn::MulAdd(w1, load(b.source[1][c].lane.data() + lane), sum);
  sum = hn::MulAdd(load(b.weight[2].lane.data() + lane), load(b.source[2][c].lane.data() + lane), sum);
  return hn::MulAdd(load(b.weight[3].lane.data() + lane), load(b.source[3][c].lane.data() + lane), sum);
}

HWY_INLINE void blend_loose_rotations(const LooseBlend& b, const LaneBlock& block, std::size_t lane, float* out,
                                      std::size_t stride) {
  const auto& from = b.source[0];
  const auto& to = b.source[1];
  const PoseV cosine = dot(load(from[0].lane.data() + lane), load(from[1].lane.data() + lane),  //
                           load(from[2].lane.data() + lane), load(from[3].lane.data() + lane),  //
                           load(to[0].lane.data() + lane), load(to[1].lane.data() + lane),      //
                           load(to[2].lane.data() + lane), load(to[3].lane.data() + lane));
  const hn::Mask<PoseTag> is_slerp = load_mask(b.is_slerp.data() + lane);
  const hn::Mask<PoseTag> is_unit = load_mask(b.is_unit.data() + lane);
  const PoseV w0 = load(b.weight[0].lane.data() + lane);
  const PoseV w1 = load(b.weight[1].lane.data() + lane);
  PoseV slerp0 = hn::IfThenElseZero(is_slerp, w0);
  PoseV slerp1 = hn::IfThenElseZero(is_slerp, w1);
  slerp_weights(cosine, slerp0, slerp1);
  slerp0 = hn::IfThenElse(is_slerp, slerp0, w0);
  slerp1 = hn::IfThenElse(is_slerp, slerp1, w1);
  const PoseV x = loose_sum(b, 0, lane, slerp0, slerp1);
  const PoseV y = loose_sum(b, 1, lane, slerp0, slerp1);
  const PoseV z = loose_sum(b, 2, lane, slerp0, slerp1);
  const PoseV w = loose_sum(b, 3, lane, slerp0, slerp1);
  const PoseV scale = hn::IfThenElse(is_unit, inverse_length(x, y, z, w), constant(1.0F));
  const std::int32_t* covered = block.covered.data() + lane;
  put<false>(scaled_or(x, scale, load(from[0].lane.data() + lane)), covered, out);
  put<false>(scaled_or(y, scale, load(from[1].lane.data() + lane)), covered, out + stride);
  put<false>(scaled_or(z, scale, load(from[2].lane.data() + lane)), covered, out + 2 * stride);
  put<false>(scaled_or(w, scale, load(from[3].lane.data() + lane)), covered, out + 3 * stride);
}

void blend_loose_here(const LooseBlend& blend, const LaneBlock& block, const PoseFloats& pose) {
  float* out = pose.first(block);
  for (std::size_t lane = 0; lane < kPoseLanes; lane += hn::Lanes(PoseTag())) {
    if (block.property == Property::Rotation) {
      blend_loose_rotations(blend, block, lane, out + lane, pose.stride);
      continue;
    }
    for (std::size_t c = 0; c < components_of(block.property); ++c) {
      const PoseV w0 = load(blend.weight[0].lane.data() + lane);
      const PoseV w1 = load(blend.weight[1].lane.data() + lane);
      put<false>(loose_sum(blend, c, lane, w0, w1), block.covered.data() + lane, out + c * pose.stride + lane);
    }
  }
}

}  // namespace
}  // namespace tweend::animation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tweend::animation {

HWY_EXPORT(blend_sheet_here);
HWY_EXPORT(blend_loose_here);

void blend_sheet(const SheetBlend& blend, std::span<const LaneBlock> blocks, const PoseFloats& out) noexcept {
  HWY_DYNAMIC_DISPATCH(blend_sheet_here)(blend, blocks, out);
}

void blend_loose(const LooseBlend& blend, const LaneBlock& block, const PoseFloats& out) noexcept {
  HWY_DYNAMIC_DISPATCH(blend_loose_here)(blend, block, out);
}

}  // namespace tweend::animation
#endif
