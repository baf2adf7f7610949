#include "protocol/vertex_records.hpp"

#include <algorithm>

// Compiled once per kind of vector unit: foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "protocol/vertex_records.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tweend::protocol::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

void sums_here(const BlockSteps& steps, RecordSums& sums, std::byte* out, std::size_t count) {
  constexpr std::size_t kPlanes = VertexPlanes::kCount;
  for (std::size_t v = 0; v < count; ++v, out += kResidualStride) {
    for (std::size_t k = 0; k < kPlanes; ++k) {
      out[k] = std::byte{sums[2 * k] = static_cast<std::uint8_t>(sums[2 * k] + steps[k][v])};
      out[kPlanes + k] = std::byte{sums[2 * k + 1] = static_cast<std::uint8_t>(sums[2 * k + 1] + (steps[k][v] >> 8))};
    }
    std::fill(out + 2 * kPlanes, out + kResidualStride, std::byte{0});
  }
}

#else

using Words = hn::Full128<std::uint16_t>;
using Pairs = hn::Full128<std::uint32_t>;
using Quads = hn::Full128<std::uint64_t>;
using Bytes = hn::Full128<std::uint8_t>;
constexpr std::size_t kLanes = 8;
constexpr std::size_t kRecord = 16;  ///< bytes that a vertex is written with; all beyond its stride are zeros

/// From low and high bytes by turns to low ones, then high ones.
HWY_INLINE hn::Vec<Bytes> in_order(hn::Vec<Bytes> by_turns) {
  alignas(16) static constexpr std::uint8_t kOrder[16] = {0, 2, 4, 6, 8, 1, 3, 5, 7, 9, 10, 10, 10, 10, 10, 10};
  return hn::TableLookupBytes(by_turns, hn::Load(Bytes(), kOrder));
}

/// Eight vertices from index v; writes kRecord - kResidualStride bytes beyond them.
HWY_INLINE void eight_vertices(const BlockSteps& steps, std::size_t v, hn::Vec<Bytes>& sums, std::uint8_t* out) {
  static_assert(VertexPlanes::kCount == 5);
  const Words d;
  const auto plane = [&](std::size_t k) HWY_ATTR { return hn::LoadU(d, steps[k].data() + v); };
  const auto write = [&](auto record) HWY_ATTR {
    sums = hn::Add(sums, hn::BitCast(Bytes(), record));
    hn::StoreU(in_order(sums), Bytes(), out);
    out += kResidualStride;
  };
  // Two vertices of the first four planes, and of the last one.
  const auto two = [&](auto four, auto last) HWY_ATTR {
    const auto a = hn::BitCast(Quads(), four);
    const auto b = hn::BitCast(Quads(), last);
    write(hn::InterleaveLower(Quads(), a, b));
    write(hn::InterleaveUpper(Quads(), a, b));
  };
  const auto four = [&](auto xy, auto zu, auto w) HWY_ATTR {
    const auto a = hn::BitCast(Pairs(), xy);
    const auto b = hn::BitCast(Pairs(), zu);
    const auto c = hn::BitCast(Pairs(), w);
    const auto none = hn::Zero(Pairs());
    two(hn::InterleaveLower(Pairs(), a, b), hn::InterleaveLower(Pairs(), c, none));
    two(hn::InterleaveUpper(Pairs(), a, b), hn::InterleaveUpper(Pairs(), c, none));
  };
  const auto x = plane(0), y = plane(1), z = plane(2), u = plane(3), w = plane(4), none = hn::Zero(d);
  four(hn::InterleaveLower(d, x, y), hn::InterleaveLower(d, z, u), hn::InterleaveLower(d, w, none));
  four(hn::InterleaveUpper(d, x, y), hn::InterleaveUpper(d, z, u), hn::InterleaveUpper(d, w, none));
}

void sums_here(const BlockSteps& steps, RecordSums& sums, std::byte* out, std::size_t count) {
  auto sum = hn::LoadU(Bytes(), sums.data());
  std::size_t v = 0;
  for (; v + kLanes < count; v += kLanes) {
    eight_vertices(steps, v, sum, reinterpret_cast<std::uint8_t*>(out + v * kResidualStride));
  }
  // The last ones, eight at most: nothing is written behind them.
  std::uint8_t last[kLanes * kResidualStride + kRecord - kResidualStride];
  eight_vertices(steps, v, sum, last);
  std::copy_n(reinterpret_cast<const std::byte*>(last), (count - v) * kResidualStride, out + v * kResidualStride);
  hn::StoreU(sum, Bytes(), sums.data());
}

#endif

}  // namespace
}  // namespace tweend::protocol::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tweend::protocol {

HWY_EXPORT(sums_here);

void write_sums(const BlockSteps& steps, RecordSums& sums, std::span<std::byte> out) noexcept {
  HWY_DYNAMIC_DISPATCH(sums_here)(steps, sums, out.data(), out.size() / kResidualStride);
}

}  // namespace tweend::protocol
#endif
