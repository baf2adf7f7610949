#include "protocol/vertex_residuals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace tweend::protocol {
namespace {

constexpr std::size_t kPlanes = VertexPlanes::kCount;
constexpr std::size_t kOrders = 3;
constexpr std::size_t kForetellings = kOrders * kOrders;

/// Planes that are foretold alike.
struct Group {
  std::size_t first, count;
};
constexpr std::array kGroups{Group{0, 3}, Group{3, 2}};

std::uint16_t wrapped(int value) noexcept { return static_cast<std::uint16_t>(value); }

/// One plane of a packet and of those before.
struct PlaneHistory {
  std::uint16_t* now;
  const std::uint16_t* before;
  const std::uint16_t* earlier;

  [[nodiscard]] std::uint16_t foretold(std::size_t v, int time) const noexcept {
    return time == 0 ? std::uint16_t{0} : time == 1 ? before[v] : wrapped(2 * before[v] - earlier[v]);
  }
};

PlaneHistory plane_of(VertexHistory& history, std::size_t k) noexcept {
  return {history.now().plane[k], history.before(1).plane[k], history.before(2).plane[k]};
}

/// What time leaves of a block, behind the same of the two vertices before it (zeros before the first).
struct Remainder {
  static constexpr std::size_t kLead = 2;
  std::array<std::int16_t, kLead + kBlockVertices> value;

  Remainder(const PlaneHistory& plane, std::size_t first, std::size_t count, int time) noexcept {
    for (std::size_t lead = 0; lead < kLead; ++lead) {
      const std::size_t back = kLead - lead;
      value[lead] = first < back ? std::int16_t{0} : left(plane, first - back, time);
    }
    std::int16_t* const out = value.data() + kLead;
    // One loop each, which the compiler makes vectors of.
    if (time == 0) {
      for (std::size_t i = 0; i < count; ++i) out[i] = left(plane, first + i, 0);
    } else if (time == 1) {
      for (std::size_t i = 0; i < count; ++i) out[i] = left(plane, first + i, 1);
    } else {
      for (std::size_t i = 0; i < count; ++i) out[i] = left(plane, first + i, 2);
    }
  }

  [[nodiscard]] static std::int16_t left(const PlaneHistory& plane, std::size_t v, int time) noexcept {
    return static_cast<std::int16_t>(wrapped(plane.now[v] - plane.foretold(v, time)));
  }

  /// What space leaves of that, from the block's first vertex on.
  template <int kSpace>
  [[nodiscard]] std::int16_t residual(std::size_t i) const noexcept {
    const int v = value[kLead + i];
    if constexpr (kSpace == 0) return static_cast<std::int16_t>(v);
    if constexpr (kSpace == 1) return static_cast<std::int16_t>(wrapped(v - value[kLead + i - 1]));
    if constexpr (kSpace == 2) return static_cast<std::int16_t>(wrapped(v - 2 * value[kLead + i - 1] + value[kLead + i - 2]));
  }
};

/// About the bits that meshoptimizer will need: it packs bytes by sixteens in 2, 4 or 8 bits. Written as masks, which the
/// compiler makes vectors of.
template <int kSpace>
unsigned cost(const Remainder& remainder, std::size_t count) noexcept {
  std::int16_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int16_t r = remainder.residual<kSpace>(i);
    const auto size = static_cast<std::int16_t>(r ^ (r >> 15));  // so that −128 counts as a byte as 127 does
    const auto above = [size](std::int16_t limit, std::int16_t more) {
      const auto mask = static_cast<std::int16_t>(-static_cast<std::int16_t>(size > limit));
      return static_cast<std::int16_t>(mask & more);
    };
    bits = static_cast<std::int16_t>(bits + above(0, 1) + above(1, 2) + above(7, 4) + above(127, 8));
  }
  return static_cast<unsigned>(bits);
}

/// Blocks look much the same all over: a part of one is enough to choose by.
constexpr std::size_t kSample = 32;

std::uint8_t choose(VertexHistory& history, const Group& group, std::size_t first, std::size_t count, bool key) noexcept {
  std::array<unsigned, kForetellings> bits{};
  const std::size_t sample = std::min(count, kSample);
  const std::size_t orders = key ? 1 : kOrders;
  for (std::size_t k = group.first; k < group.first + group.count; ++k) {
    for (std::size_t time = 0; time < orders; ++time) {
      const Remainder remainder(plane_of(history, k), first, sample, static_cast<int>(time));
      bits[kOrders * time] += cost<0>(remainder, sample);
      bits[kOrders * time + 1] += cost<1>(remainder, sample);
      bits[kOrders * time + 2] += cost<2>(remainder, sample);
    }
  }
  const auto end = bits.begin() + static_cast<std::ptrdiff_t>(kOrders * orders);
  return static_cast<std::uint8_t>(std::min_element(bits.begin(), end) - bits.begin());
}

/// meshoptimizer packs the difference of each byte to the same byte of the vertex before, as a signed byte. So the low
/// bytes are sums of residuals, and the high bytes move only where such a difference is not the whole residual.
struct Sums {
  std::uint8_t low = 0;
  std::uint8_t high = 0;

  /// What a residual adds to both, the high byte's in the high half.
  [[nodiscard]] static std::uint16_t step(std::int16_t residual) noexcept {
    return wrapped((residual & 0xFF) | ((residual + 128) & 0xFF00));
  }
  [[nodiscard]] std::uint16_t step_to(Sums next) const noexcept {
    const int low_step = static_cast<std::int8_t>(static_cast<std::uint8_t>(next.low - low));
    return wrapped(low_step + 256 * (next.high - high));
  }
};

template <int kSpace>
void find_steps(const Remainder& remainder, std::size_t count, std::uint16_t* out) noexcept {
  for (std::size_t i = 0; i < count; ++i) out[i] = Sums::step(remainder.residual<kSpace>(i));
}

void find_steps(const PlaneHistory& plane, int chosen, std::size_t first, std::size_t count, std::uint16_t* out) noexcept {
  const Remainder remainder(plane, first, count, chosen / static_cast<int>(kOrders));
  const int space = chosen % static_cast<int>(kOrders);
  if (space == 0) return find_steps<0>(remainder, count, out);
  if (space == 1) return find_steps<1>(remainder, count, out);
  find_steps<2>(remainder, count, out);
}

void read_plane(const PlaneHistory& plane, int chosen, std::size_t first, std::size_t count, Sums& sums,
                const std::byte* in) noexcept {
  const int time = chosen / static_cast<int>(kOrders);
  const int space = chosen % static_cast<int>(kOrders);
  const auto left = [&](std::size_t back) { return first < back ? 0 : int{Remainder::left(plane, first - back, time)}; };
  int last = left(1);
  int second_last = left(2);
  for (std::size_t v = first; v < first + count; ++v, in += kResidualStride) {
    const Sums next{std::to_integer<std::uint8_t>(in[0]), std::to_integer<std::uint8_t>(in[kPlanes])};
    const int residual = sums.step_to(next);
    sums = next;
    const int here = space == 0 ? residual : space == 1 ? last + residual : 2 * last - second_last + residual;
    second_last = last;
    last = wrapped(here);
    plane.now[v] = wrapped(last + plane.foretold(v, time));
  }
}

}  // namespace

void VertexHistory::resize(std::size_t vertices) {
  if (vertices == vertices_) return;
  vertices_ = vertices;
  integers_.resize(3 * kPlanes * vertices);
}

void VertexHistory::advance(bool key) noexcept {
  const std::size_t free = earlier_ != before_ ? earlier_ : 3 - now_ - before_;
  earlier_ = key ? now_ : before_;
  before_ = now_;
  now_ = free;
}

VertexPlanes VertexHistory::planes(std::size_t slot) noexcept {
  VertexPlanes planes;
  for (std::size_t k = 0; k < kPlanes; ++k) planes.plane[k] = integers_.data() + (slot * kPlanes + k) * vertices_;
  return planes;
}

void write_residuals(VertexHistory& history, bool key, std::span<std::byte> foretellings,
                     std::span<std::byte> residuals) noexcept {
  BlockSteps steps{};
  RecordSums sums{};
  for (std::size_t block = 0; block < foretellings.size(); ++block) {
    const std::size_t first = block * kBlockVertices;
    const std::size_t count = std::min(kBlockVertices, history.vertices() - first);
    unsigned nibbles = 0;
    for (std::size_t g = 0; g < kGroups.size(); ++g) {
      const std::uint8_t chosen = choose(history, kGroups[g], first, count, key);
      nibbles |= unsigned{chosen} << (4 * g);
      for (std::size_t k = kGroups[g].first; k < kGroups[g].first + kGroups[g].count; ++k) {
        find_steps(plane_of(history, k), chosen, first, count, steps[k].data());
      }
    }
    write_sums(steps, sums, residuals.subspan(first * kResidualStride, count * kResidualStride));
    foretellings[block] = static_cast<std::byte>(nibbles);
  }
}

Status check_foretellings(bool key, std::span<const std::byte> foretellings) {
  const unsigned most = key ? kOrders : kForetellings;
  for (const std::byte byte : foretellings) {
    const auto nibbles = std::to_integer<unsigned>(byte);
    if ((nibbles & 15U) >= most || nibbles >> 4U >= most) {
      return fail(ErrorCode::Parse, fmt::format("expected foretellings below {} in a {}, found {:#04x}", most,
                                                key ? "key" : "packet that is none", nibbles));
    }
  }
  return {};
}

void read_residuals(VertexHistory& history, std::span<const std::byte> foretellings,
                    std::span<const std::byte> residuals) noexcept {
  std::array<Sums, kPlanes> sums{};
  for (std::size_t block = 0; block < foretellings.size(); ++block) {
    const std::size_t first = block * kBlockVertices;
    const std::size_t count = std::min(kBlockVertices, history.vertices() - first);
    const auto nibbles = std::to_integer<unsigned>(foretellings[block]);
    for (std::size_t g = 0; g < kGroups.size(); ++g) {
      const auto chosen = static_cast<int>((nibbles >> (4 * g)) & 15U);
      for (std::size_t k = kGroups[g].first; k < kGroups[g].first + kGroups[g].count; ++k) {
        read_plane(plane_of(history, k), chosen, first, count, sums[k], residuals.data() + first * kResidualStride + k);
      }
    }
  }
}

}  // namespace tweend::protocol
