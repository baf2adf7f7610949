#include "server/animation/blend_vertices.hpp"

#include <algorithm>
#include <array>

#include "server/animation/blend_kernels.hpp"

namespace tweend::animation {
namespace {

/// The streams of VertexAttributes and VertexTarget, so that all three are treated alike.
struct Stream {
  std::span<const float> VertexAttributes::*source;
  std::span<float> VertexTarget::*target;
  void (*blend)(const StreamBlend&) noexcept;
};
constexpr std::array kStreams{
    Stream{&VertexAttributes::positions, &VertexTarget::positions, &blend_values},
    Stream{&VertexAttributes::normals, &VertexTarget::normals, &blend_directions},
    Stream{&VertexAttributes::tangents, &VertexTarget::tangents, &blend_directions},
};

/// nullptr, or what is wrong.
const char* find_misuse(std::span<const VertexAttributes> sources, std::span<const float> weights, std::size_t nearest,
                        const VertexTarget& out) {
  if (sources.empty() || sources.size() > 4) return "blend_vertices: takes 1 to 4 sources";
  if (weights.size() != sources.size()) return "blend_vertices: needs one weight per source";
  if (nearest >= sources.size()) return "blend_vertices: `nearest` names no source";
  std::size_t size = 0;
  for (const Stream& stream : kStreams) {
    const std::size_t wanted = (out.*stream.target).size();
    if (wanted == 0) continue;
    if (wanted % 3 != 0) return "blend_vertices: output length is not a multiple of 3";
    if (size != 0 && wanted != size) return "blend_vertices: output streams differ in length";
    size = wanted;
    const auto differs = [&](const VertexAttributes& source) { return (source.*stream.source).size() != wanted; };
    if (std::ranges::any_of(sources, differs)) return "blend_vertices: a source differs from the output in length";
  }
  return nullptr;
}

}  // namespace

Status blend_vertices(std::span<const VertexAttributes> sources, std::span<const float> weights, std::size_t nearest,
                      const VertexTarget& out) noexcept {
  if (const char* misuse = find_misuse(sources, weights, nearest, out)) return fail(ErrorCode::Internal, misuse);
  const bool is_copy = sources.size() == 1 && weights.front() == 1.0F;
  for (const Stream& stream : kStreams) {
    const std::span<float> target = out.*stream.target;
    if (target.empty()) continue;
    if (is_copy) {
      std::ranges::copy(sources.front().*stream.source, target.begin());
      continue;
    }
    StreamBlend blend{.source_count = sources.size(), .nearest = nearest, .out = target.data(), .size = target.size()};
    for (std::size_t i = 0; i < sources.size(); ++i) blend.source[i] = (sources[i].*stream.source).data();
    std::ranges::copy(weights, blend.weight.begin());
    stream.blend(blend);
  }
  return {};
}

}  // namespace tweend::animation
