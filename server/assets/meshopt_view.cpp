#include "server/assets/meshopt_view.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <array>
#include <string_view>

namespace tweend::assets {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 32U;

template <class T, std::size_t N>
Result<T> pick(const JsonNode& node, const std::array<std::string_view, N>& names) {
  TWEEND_ASSIGN(const std::string_view text, node.text());
  std::string list;
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i] == text) return static_cast<T>(i);
    list += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  return node.expected("one of " + list);
}

Status check_stride(const MeshoptView& view, const JsonNode& stride) {
  using Mode = MeshoptView::Mode;
  using Filter = MeshoptView::Filter;
  const std::size_t n = view.stride;
  if (view.mode != Mode::Attributes) return n == 2 || n == 4 ? Status() : stride.expected("2 or 4 bytes an index");
  if (n % 4 != 0 || n > 256) return stride.expected("a multiple of 4, at most 256");
  if (view.filter == Filter::Octahedral && n != 4 && n != 8) return stride.expected("4 or 8 for the filter OCTAHEDRAL");
  if (view.filter == Filter::Quaternion && n != 8) return stride.expected("8 for the filter QUATERNION");
  return {};
}

/// The fewest bytes that could hold `view`: both encodings have parts that can't get any smaller.
std::size_t least_bytes(const MeshoptView& view) {
  // Sixteen values of one byte of the elements take at least a header of two bits.
  if (view.mode == MeshoptView::Mode::Attributes) return 1 + view.bytes() / 64;
  return view.mode == MeshoptView::Mode::Triangles ? 17 + view.count / 3 : 5 + view.count;
}

int decode(const MeshoptView& view, std::span<const std::byte> packed, std::vector<std::byte>& out) {
  const auto* const from = reinterpret_cast<const unsigned char*>(packed.data());
  switch (view.mode) {
    case MeshoptView::Mode::Attributes:
      return meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, from, packed.size());
    case MeshoptView::Mode::Triangles:
      return meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, from, packed.size());
    case MeshoptView::Mode::Indices:
      return meshopt_decodeIndexSequence(out.data(), view.count, view.stride, from, packed.size());
  }
  return -1;
}

void apply(MeshoptView::Filter filter, const MeshoptView& view, std::vector<std::byte>& bytes) {
  switch (filter) {
    case MeshoptView::Filter::None:
      break;
    case MeshoptView::Filter::Octahedral:
      meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
      break;
    case MeshoptView::Filter::Quaternion:
      meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
      break;
    case MeshoptView::Filter::Exponential:
      meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
      break;
  }
}

}  // namespace

Result<MeshoptView> read_meshopt_view(const JsonNode& extension) {
  using Names3 = std::array<std::string_view, 3>;
  using Names4 = std::array<std::string_view, 4>;
  MeshoptView view;
  TWEEND_ASSIGN(const JsonNode count, extension.get("count"));
  TWEEND_ASSIGN(view.count, count.whole(1, kMostElements));
  TWEEND_ASSIGN(const JsonNode mode, extension.get("mode"));
  TWEEND_ASSIGN(view.mode, pick<MeshoptView::Mode>(mode, Names3{"ATTRIBUTES", "TRIANGLES", "INDICES"}));
  if (const auto filter = extension.find("filter")) {
    TWEEND_ASSIGN(view.filter, pick<MeshoptView::Filter>(*filter, Names4{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}));
    if (view.mode != MeshoptView::Mode::Attributes && view.filter != MeshoptView::Filter::None) {
      return filter->expected("NONE, since only the mode ATTRIBUTES has filters");
    }
  }
  TWEEND_ASSIGN(const JsonNode stride, extension.get("byteStride"));
  TWEEND_ASSIGN(view.stride, stride.whole(2, 256));
  TWEEND_TRY(check_stride(view, stride));
  if (view.mode == MeshoptView::Mode::Triangles && view.count % 3 != 0) return count.expected("three indices a triangle");
  return view;
}

Result<std::vector<std::byte>> unpack_meshopt(const MeshoptView& view, std::span<const std::byte> packed,
                                              const JsonNode& extension) {
  if (packed.size() < least_bytes(view)) {
    return extension.error(fmt::format("expected at least {} bytes for {} elements of {} bytes, found {}", least_bytes(view),
                                       view.count, view.stride, packed.size()));
  }
  std::vector<std::byte> bytes(view.bytes());
  if (decode(view, packed, bytes) != 0) {
    return extension.error(fmt::format("expected {} elements of {} bytes as meshoptimizer packs them, found something else",
                                       view.count, view.stride));
  }
  apply(view.filter, view, bytes);
  return bytes;
}

}  // namespace tweend::assets
