#include "protocol/vertex_quanta.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "protocol/octahedral.hpp"

// Compiled once per kind of vector unit: foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "protocol/vertex_quanta.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tweend::protocol::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_HAVE_SCALABLE
using Floats = hn::FixedTag<float, 4>;
#else
using Floats = hn::ScalableTag<float>;
#endif
using Ints = hn::RebindToSigned<Floats>;
using Shorts = hn::Rebind<std::int16_t, Floats>;
using Words = hn::Rebind<std::uint16_t, Floats>;
using V = hn::Vec<Floats>;
constexpr std::size_t kLanes = hn::MaxLanes(Floats());
constexpr float kShortest = 1e-18F;  ///< sum of a normal's coordinates below which it has no direction
constexpr float kLargest = std::numeric_limits<float>::max();

static_assert(std::endian::native == std::endian::little, "integers are stored in the machine's order, which is the wire's");

/// A coordinate that extents can reach, 0 in place of NaN.
HWY_INLINE V tame(V coordinate) {
  const Floats d;
  const V number = hn::IfThenElseZero(hn::Eq(coordinate, coordinate), coordinate);
  return hn::Clamp(number, hn::Set(d, -kFarthest), hn::Set(d, kFarthest));
}
float tame(float coordinate) { return coordinate == coordinate ? std::clamp(coordinate, -kFarthest, kFarthest) : 0.0F; }

/// Each of the three vectors of a step holds the axes in turn, and the same ones in every step.
Bounds bounds_here(const float* positions, std::size_t size) {
  const Floats d;
  constexpr std::size_t kStep = 3 * kLanes;
  float least[kStep];
  float most[kStep];
  for (std::size_t i = 0; i < kStep; ++i) least[i] = most[i] = tame(positions[i % 3]);
  V low0 = hn::LoadU(d, least), low1 = hn::LoadU(d, least + kLanes), low2 = hn::LoadU(d, least + 2 * kLanes);
  V high0 = low0, high1 = low1, high2 = low2;
  std::size_t i = 0;
  for (; i + kStep <= size; i += kStep) {
    const V a = tame(hn::LoadU(d, positions + i));
    const V b = tame(hn::LoadU(d, positions + i + kLanes));
    const V c = tame(hn::LoadU(d, positions + i + 2 * kLanes));
    low0 = hn::Min(low0, a), high0 = hn::Max(high0, a);
    low1 = hn::Min(low1, b), high1 = hn::Max(high1, b);
    low2 = hn::Min(low2, c), high2 = hn::Max(high2, c);
  }
  hn::StoreU(low0, d, least), hn::StoreU(low1, d, least + kLanes), hn::StoreU(low2, d, least + 2 * kLanes);
  hn::StoreU(high0, d, most), hn::StoreU(high1, d, most + kLanes), hn::StoreU(high2, d, most + 2 * kLanes);
  for (; i < size; ++i) {
    least[i % 3] = std::min(least[i % 3], tame(positions[i]));
    most[i % 3] = std::max(most[i % 3], tame(positions[i]));
  }
  Bounds bounds{{least[0], least[1], least[2]}, {most[0], most[1], most[2]}};
  for (std::size_t k = 3; k < kStep; ++k) {
    bounds.min[k % 3] = std::min(bounds.min[k % 3], least[k]);
    bounds.max[k % 3] = std::max(bounds.max[k % 3], most[k]);
  }
  return bounds;
}

struct Scale {
  explicit Scale(const PositionGrid& grid) : min(grid.min) {
    // What is flat has one integer; so has what is too thin for its reciprocal.
    constexpr float kFlat = 1e-30F;
    for (std::size_t k = 0; k < 3; ++k) per_unit[k] = grid.extent[k] > kFlat ? kPositionMost / grid.extent[k] : 0.0F;
  }
  std::array<float, 3> min;
  std::array<float, 3> per_unit{};
};

HWY_INLINE hn::Vec<Words> quantise_axis(V position, float min, float per_unit) {
  const Floats d;
  const V steps = hn::Mul(hn::Sub(tame(position), hn::Set(d, min)), hn::Set(d, per_unit));
  return hn::DemoteTo(Words(), hn::NearestInt(hn::Min(steps, hn::Set(d, float{kPositionMost}))));
}

struct OctahedralLanes {
  hn::Vec<Shorts> x, y;
};

template <int kBits>
HWY_INLINE OctahedralLanes quantise_direction(V x, V y, V z) {
  const Floats d;
  const V most = hn::Set(d, float{Octahedral<kBits>::kMost});
  const V sum = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
  const auto has_direction = hn::And(hn::Gt(sum, hn::Set(d, kShortest)), hn::Le(sum, hn::Set(d, kLargest)));
  const V scale = hn::Div(most, sum);
  const V u = hn::Mul(x, scale);
  const V v = hn::Mul(y, scale);
  const auto is_lower = hn::Lt(z, hn::Zero(d));
  const V folded_u = hn::IfThenElse(is_lower, hn::CopySign(hn::Sub(most, hn::Abs(v)), x), u);
  const V folded_v = hn::IfThenElse(is_lower, hn::CopySign(hn::Sub(most, hn::Abs(u)), y), v);
  const V chosen_u = hn::IfThenElse(has_direction, folded_u, hn::Set(d, float{Octahedral<kBits>::kNone}));
  const V chosen_v = hn::IfThenElseZero(has_direction, folded_v);
  return {hn::DemoteTo(Shorts(), hn::NearestInt(chosen_u)), hn::DemoteTo(Shorts(), hn::NearestInt(chosen_v))};
}

struct Planes {
  static constexpr int kNormalBits = kShortNormalBits;
  std::array<std::uint16_t*, VertexPlanes::kCount> plane;

  HWY_INLINE void store(std::size_t v, hn::Vec<Words> x, hn::Vec<Words> y, hn::Vec<Words> z, OctahedralLanes normal) const {
    hn::StoreU(x, Words(), plane[0] + v);
    hn::StoreU(y, Words(), plane[1] + v);
    hn::StoreU(z, Words(), plane[2] + v);
    hn::StoreU(hn::BitCast(Words(), normal.x), Words(), plane[3] + v);
    hn::StoreU(hn::BitCast(Words(), normal.y), Words(), plane[4] + v);
  }
};

struct Interleaved {
  static constexpr int kNormalBits = kFineNormalBits;
  std::uint16_t* positions;
  std::int16_t* normals;

  HWY_INLINE void store(std::size_t v, hn::Vec<Words> x, hn::Vec<Words> y, hn::Vec<Words> z, OctahedralLanes normal) const {
    hn::StoreInterleaved3(x, y, z, Words(), positions + 3 * v);
    hn::StoreInterleaved2(normal.x, normal.y, Shorts(), normals + 2 * v);
  }
};

/// kLanes vertices from index v.
template <class Out>
HWY_INLINE void quantise_step(const float* positions, const float* normals, std::size_t v, const Scale& scale, const Out& out) {
  const Floats d;
  V x, y, z, nx, ny, nz;
  hn::LoadInterleaved3(d, positions + 3 * v, x, y, z);
  hn::LoadInterleaved3(d, normals + 3 * v, nx, ny, nz);
  out.store(v, quantise_axis(x, scale.min[0], scale.per_unit[0]), quantise_axis(y, scale.min[1], scale.per_unit[1]),
            quantise_axis(z, scale.min[2], scale.per_unit[2]), quantise_direction<Out::kNormalBits>(nx, ny, nz));
}

template <class Out>
HWY_INLINE void quantise_all(const float* positions, const float* normals, std::size_t n, const PositionGrid& grid,
                             const Out& out) {
  const Scale scale(grid);
  const std::size_t last = n - kLanes;
  for (std::size_t v = 0; v < last; v += kLanes) quantise_step(positions, normals, v, scale, out);
  quantise_step(positions, normals, last, scale, out);  // makes some of the step before anew, the same
}

/// Fewer vertices than a step takes, in copies that are as long as one.
struct Padded {
  Padded(const float* some_positions, const float* some_normals, std::size_t n) {
    std::copy_n(some_positions, 3 * n, positions);
    std::copy_n(some_normals, 3 * n, normals);
  }
  float positions[3 * kLanes]{};
  float normals[3 * kLanes]{};
};

void planes_here(const float* positions, const float* normals, std::size_t n, const PositionGrid& grid,
                 const VertexPlanes& out) {
  if (n >= kLanes) return quantise_all(positions, normals, n, grid, Planes{out.plane});
  const Padded in(positions, normals, n);
  std::uint16_t found[VertexPlanes::kCount][kLanes];
  quantise_all(in.positions, in.normals, kLanes, grid, Planes{{found[0], found[1], found[2], found[3], found[4]}});
  for (std::size_t k = 0; k < VertexPlanes::kCount; ++k) std::copy_n(found[k], n, out.plane[k]);
}

void interleaved_here(const float* positions, const float* normals, std::size_t n, const PositionGrid& grid,
                      std::byte* out_positions, std::byte* out_normals) {
  const Interleaved out{reinterpret_cast<std::uint16_t*>(out_positions), reinterpret_cast<std::int16_t*>(out_normals)};
  if (n >= kLanes) return quantise_all(positions, normals, n, grid, out);
  const Padded in(positions, normals, n);
  std::uint16_t found_positions[3 * kLanes];
  std::int16_t found_normals[2 * kLanes];
  quantise_all(in.positions, in.normals, kLanes, grid, Interleaved{found_positions, found_normals});
  std::copy_n(reinterpret_cast<const std::byte*>(found_positions), 6 * n, out_positions);
  std::copy_n(reinterpret_cast<const std::byte*>(found_normals), 4 * n, out_normals);
}

}  // namespace
}  // namespace tweend::protocol::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tweend::protocol {

HWY_EXPORT(bounds_here);
HWY_EXPORT(planes_here);
HWY_EXPORT(interleaved_here);

Bounds bounds_of(std::span<const float> positions) noexcept {
  if (positions.empty()) return {};
  Bounds bounds = HWY_DYNAMIC_DISPATCH(bounds_here)(positions.data(), positions.size());
  // Of two zeros it is chance which one is the smaller; what is sent is +0.
  for (float& value : bounds.min) value += 0.0F;
  for (float& value : bounds.max) value += 0.0F;
  return bounds;
}

PositionGrid::PositionGrid(const Bounds& bounds) noexcept : min(bounds.min) {
  for (std::size_t k = 0; k < 3; ++k) extent[k] = bounds.max[k] - bounds.min[k];
}

void quantise_to_planes(std::span<const float> positions, std::span<const float> normals, const PositionGrid& grid,
                        const VertexPlanes& out) noexcept {
  HWY_DYNAMIC_DISPATCH(planes_here)(positions.data(), normals.data(), positions.size() / 3, grid, out);
}

void quantise_interleaved(std::span<const float> positions, std::span<const float> normals, const PositionGrid& grid,
                          std::byte* out_positions, std::byte* out_normals) noexcept {
  HWY_DYNAMIC_DISPATCH(interleaved_here)
  (positions.data(), normals.data(), positions.size() / 3, grid, out_positions, out_normals);
}

}  // namespace tweend::protocol
#endif
