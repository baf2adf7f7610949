#include "server/animation/skin_kernels.hpp"

#include <algorithm>
#include <limits>

#include "server/animation/blend_kernels.hpp"

// Compiled once per kind of vector unit: foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/animation/skin_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/animation/affine_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tweend::animation::HWY_NAMESPACE {
namespace {

/// A vector of vertices: where theirs begin.
struct VertexVector {
  const std::uint16_t* entries;
  const float* weights;
  const float *positions, *normals, *tangents;  ///< null: not wanted
  float *out_positions, *out_normals, *out_tangents;
};

/// The vertices' blended matrices, row by row, in the order of place().
struct BlendedRows {
  HWY_ALIGN float row[3][kLanesHere][4];
};

using PairTag = hn::CappedTag<float, 8>;  // two rows of a matrix, where a vector has room for them
constexpr std::size_t kPairLanes = hn::MaxLanes(PairTag());
using RestTag = hn::CappedTag<float, 4>;
constexpr std::size_t kRestLanes = hn::MaxLanes(RestTag());

/// A vector of floats from the i-th on of Σ weight · matrix.
template <std::size_t kInfluences, class Tag>
HWY_INLINE hn::Vec<Tag> weighted_floats(Tag d, const std::uint16_t* entries, const float* weights, const Affine* palette,
                                        std::size_t i) {
  hn::Vec<Tag> sum = hn::LoadU(d, &palette[entries[0]].rows[0].x + i);
  if constexpr (kInfluences == 1) return sum;
  sum = hn::Mul(hn::Set(d, weights[0]), sum);
  for (std::size_t k = 1; k < kInfluences; ++k) {
    sum = hn::MulAdd(hn::Set(d, weights[k]), hn::LoadU(d, &palette[entries[k]].rows[0].x + i), sum);
  }
  return sum;
}

/// Stores rows 0 and 1 of a matrix. Not for vectors that have no room for both.
[[maybe_unused]] HWY_INLINE void store_pair(hn::Vec<PairTag> rows, float* row0, float* row1) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (kPairLanes == 8) {
    const hn::Half<PairTag> half;
    hn::StoreU(hn::LowerHalf(half, rows), half, row0);
    hn::StoreU(hn::UpperHalf(half, rows), half, row1);
  }
#endif
  static_cast<void>(rows), static_cast<void>(row0), static_cast<void>(row1);
}

template <std::size_t kInfluences>
HWY_INLINE void blend_matrices(const VertexVector& v, const Affine* palette, BlendedRows& out) {
  for (std::size_t lane = 0; lane < kLanesHere; ++lane) {
    const std::uint16_t* entries = v.entries + lane * kInfluences;
    const float* weights = v.weights + lane * kInfluences;
    const std::size_t at = place(lane);
    std::size_t i = 0;
    if constexpr (kPairLanes == 8) {
      store_pair(weighted_floats<kInfluences>(PairTag(), entries, weights, palette, 0), out.row[0][at], out.row[1][at]);
      i = 8;
    }
    for (; i < 12; i += kRestLanes) {
      const auto floats = weighted_floats<kInfluences>(RestTag(), entries, weights, palette, i);
      hn::StoreU(floats, RestTag(), &out.row[i / 4][at][i % 4]);
    }
  }
}

HWY_INLINE PoseV dot3(PoseV ax, PoseV ay, PoseV az, PoseV bx, PoseV by, PoseV bz) {
  return hn::MulAdd(az, bz, hn::MulAdd(ay, by, hn::Mul(ax, bx)));
}

/// a · d − b · c.
HWY_INLINE PoseV minor(PoseV a, PoseV b, PoseV c, PoseV d) { return hn::NegMulAdd(b, c, hn::Mul(a, d)); }

/// Scales to unit length, where there is one; otherwise stores what there was before.
HWY_INLINE void store_directions(PoseV x, PoseV y, PoseV z, PoseV old_x, PoseV old_y, PoseV old_z, float* to) {
  const PoseV square = dot3(x, y, z, x, y, z);
  const PoseV scale = hn::Div(constant(1.0F), hn::Sqrt(square));
  const auto usable = hn::And(hn::Ge(square, constant(kShortestDirection * kShortestDirection)),
                              hn::Le(square, constant(std::numeric_limits<float>::max())));  // false for NaN too
  hn::StoreInterleaved3(hn::IfThenElse(usable, hn::Mul(x, scale), old_x), hn::IfThenElse(usable, hn::Mul(y, scale), old_y),
                        hn::IfThenElse(usable, hn::Mul(z, scale), old_z), PoseTag(), to);
}

/// Normals by the inverse transpose but for its length: the cofactors, with the sign of the determinant.
HWY_INLINE void turn_normals(PoseV m00, PoseV m01, PoseV m02, PoseV m10, PoseV m11, PoseV m12, PoseV m20, PoseV m21, PoseV m22,
                             const float* from, float* to) {
  const PoseTag d;
  PoseV x, y, z;
  hn::LoadInterleaved3(d, from, x, y, z);
  const PoseV c00 = minor(m11, m12, m21, m22), c01 = minor(m12, m10, m22, m20), c02 = minor(m10, m11, m20, m21);
  const PoseV c10 = minor(m21, m22, m01, m02), c11 = minor(m22, m20, m02, m00), c12 = minor(m20, m21, m00, m01);
  const PoseV c20 = minor(m01, m02, m11, m12), c21 = minor(m02, m00, m12, m10), c22 = minor(m00, m01, m10, m11);
  const PoseV flip = flip_where_negative(dot3(m00, m01, m02, c00, c01, c02));
  store_directions(hn::Xor(dot3(c00, c01, c02, x, y, z), flip), hn::Xor(dot3(c10, c11, c12, x, y, z), flip),
                   hn::Xor(dot3(c20, c21, c22, x, y, z), flip), x, y, z, to);
}

template <std::size_t kInfluences>
HWY_INLINE void skin_vector(const VertexVector& v, const Affine* palette) {
  const PoseTag d;
  BlendedRows rows;
  blend_matrices<kInfluences>(v, palette, rows);
  PoseV m00, m01, m02, m03, m10, m11, m12, m13, m20, m21, m22, m23, x, y, z;
  load_rows(rows.row[0][0], m00, m01, m02, m03);
  load_rows(rows.row[1][0], m10, m11, m12, m13);
  load_rows(rows.row[2][0], m20, m21, m22, m23);
  if (v.out_positions != nullptr) {
    hn::LoadInterleaved3(d, v.positions, x, y, z);
    const PoseV to_x = hn::MulAdd(m00, x, hn::MulAdd(m01, y, hn::MulAdd(m02, z, m03)));
    const PoseV to_y = hn::MulAdd(m10, x, hn::MulAdd(m11, y, hn::MulAdd(m12, z, m13)));
    const PoseV to_z = hn::MulAdd(m20, x, hn::MulAdd(m21, y, hn::MulAdd(m22, z, m23)));
    hn::StoreInterleaved3(to_x, to_y, to_z, d, v.out_positions);
  }
  if (v.out_normals != nullptr) turn_normals(m00, m01, m02, m10, m11, m12, m20, m21, m22, v.normals, v.out_normals);
  if (v.out_tangents != nullptr) {
    hn::LoadInterleaved3(d, v.tangents, x, y, z);
    store_directions(dot3(m00, m01, m02, x, y, z), dot3(m10, m11, m12, x, y, z), dot3(m20, m21, m22, x, y, z), x, y, z,
                     v.out_tangents);
  }
}

/// What is left at the end, in padded copies: by the same operations as all others.
template <std::size_t kInfluences>
HWY_NOINLINE void skin_padded(const VertexVector& v, std::size_t count, const Affine* palette) {
  constexpr std::size_t kFloats = 3 * kLanesHere;
  std::uint16_t entries[kInfluences * kLanesHere] = {};
  float weights[kInfluences * kLanesHere] = {};
  float in[3][kFloats] = {};
  float out[3][kFloats];
  std::copy_n(v.entries, kInfluences * count, entries);
  std::copy_n(v.weights, kInfluences * count, weights);
  VertexVector padded{entries, weights, in[0], in[1], in[2], nullptr, nullptr, nullptr};
  const float* sources[] = {v.positions, v.normals, v.tangents};
  float* targets[] = {v.out_positions, v.out_normals, v.out_tangents};
  float** padded_targets[] = {&padded.out_positions, &padded.out_normals, &padded.out_tangents};
  for (std::size_t s = 0; s < 3; ++s) {
    if (targets[s] == nullptr) continue;
    std::copy_n(sources[s], 3 * count, in[s]);
    *padded_targets[s] = out[s];
  }
  skin_vector<kInfluences>(padded, palette);
  for (std::size_t s = 0; s < 3; ++s) {
    if (targets[s] != nullptr) std::copy_n(out[s], 3 * count, targets[s]);
  }
}

template <class T>
HWY_INLINE T* from(T* stream, std::size_t first) {
  return stream == nullptr ? nullptr : stream + first;
}

template <std::size_t kInfluences>
void skin_all(const VertexVector& all, std::size_t vertices, const Affine* palette) {
  for (std::size_t first = 0; first < vertices; first += kLanesHere) {
    const VertexVector v{all.entries + kInfluences * first, all.weights + kInfluences * first,
                         from(all.positions, 3 * first),    from(all.normals, 3 * first),
                         from(all.tangents, 3 * first),     from(all.out_positions, 3 * first),
                         from(all.out_normals, 3 * first),  from(all.out_tangents, 3 * first)};
    if (vertices - first >= kLanesHere) {
      skin_vector<kInfluences>(v, palette);
    } else {
      skin_padded<kInfluences>(v, vertices - first, palette);
    }
  }
}

void skin_here(const VertexVector& all, std::size_t vertices, std::size_t per_vertex, const Affine* palette) {
  switch (per_vertex) {
    case 1:
      return skin_all<1>(all, vertices, palette);
    case 4:
      return skin_all<4>(all, vertices, palette);
    default:
      return skin_all<8>(all, vertices, palette);
  }
}

}  // namespace

void skin_vertices_here(const SkinInfluences& influences, std::span<const Affine> palette, const VertexAttributes& in,
                        const VertexTarget& out) {
  const auto wanted = [](std::span<float> stream) { return stream.empty() ? nullptr : stream.data(); };
  skin_here({influences.entries.data(), influences.weights.data(), in.positions.data(), in.normals.data(), in.tangents.data(),
             wanted(out.positions), wanted(out.normals), wanted(out.tangents)},
            influences.entries.size() / influences.per_vertex, influences.per_vertex, palette.data());
}

}  // namespace tweend::animation::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tweend::animation {

HWY_EXPORT(skin_vertices_here);

void skin_checked_vertices(const SkinInfluences& influences, std::span<const Affine> palette, const VertexAttributes& in,
                           const VertexTarget& out) noexcept {
  HWY_DYNAMIC_DISPATCH(skin_vertices_here)(influences, palette, in, out);
}

}  // namespace tweend::animation
#endif
