#include "server/assets/gltf_buffers.hpp"

#include <fmt/format.h>

#include <utility>

#include "server/assets/meshopt_view.hpp"

namespace tweend::assets {
namespace {

constexpr std::string_view kMeshopt = "EXT_meshopt_compression";
constexpr std::size_t kMostBytes = std::size_t{1} << 48U;  // sums and products of such lengths stay far from overflow
constexpr std::size_t kLeastStride = 4;
constexpr std::size_t kMostStride = 252;

}  // namespace

Result<GltfBuffers::Bytes> GltfBuffers::buffer(const JsonNode& reference) {
  TWEEND_ASSIGN(const JsonNode node, file_.refer(reference, "buffers"));
  const std::size_t index = node.position();
  if (const auto known = buffers_.find(index); known != buffers_.end()) return known->second;
  TWEEND_ASSIGN(const Bytes bytes, load(node));
  buffers_.emplace(index, bytes);
  return bytes;
}

Result<GltfBuffers::Bytes> GltfBuffers::load(const JsonNode& node) {
  TWEEND_ASSIGN(const JsonNode length, node.get("byteLength"));
  TWEEND_ASSIGN(const std::size_t bytes, length.whole(1, kMostBytes));
  std::string_view content;
  if (const auto uri = node.find("uri")) {
    TWEEND_ASSIGN(std::string fetched, uris_.fetch(*uri));
    content = fetched_[node.position()] = std::move(fetched);
  } else if (node.position() == 0 && file_.bin()) {
    content = *file_.bin();
  } else {
    return node.error("expected a uri, or to be the first buffer of a .glb with a binary chunk; found neither");
  }
  if (content.size() < bytes)
    return length.error(fmt::format("expected at most the {} bytes there are, found {}", content.size(), bytes));
  return std::as_bytes(std::span(content)).first(bytes);
}

Result<GltfBuffers::Bytes> GltfBuffers::slice(const JsonNode& node) {
  TWEEND_ASSIGN(const JsonNode reference, node.get("buffer"));
  TWEEND_ASSIGN(const Bytes whole, buffer(reference));
  TWEEND_ASSIGN(const std::size_t offset, node.whole_or("byteOffset", 0, 0, kMostBytes));
  TWEEND_ASSIGN(const JsonNode length_node, node.get("byteLength"));
  TWEEND_ASSIGN(const std::size_t length, length_node.whole(1, kMostBytes));
  if (offset > whole.size() || length > whole.size() - offset) {
    return length_node.error(fmt::format("expected at most {} bytes from byte {} of the buffer of {}, found {}",
                                         offset > whole.size() ? 0 : whole.size() - offset, offset, whole.size(), length));
  }
  return whole.subspan(offset, length);
}

Result<GltfBuffers::Bytes> GltfBuffers::unpack(const JsonNode& view, const JsonNode& extension) {
  TWEEND_ASSIGN(const MeshoptView how, read_meshopt_view(extension));
  TWEEND_ASSIGN(const JsonNode length, view.get("byteLength"));
  TWEEND_ASSIGN(const std::size_t bytes, length.whole(1, kMostBytes));
  if (bytes != how.bytes()) {
    return length.expected(
        fmt::format("{} bytes for the {} elements of {} bytes that are packed", how.bytes(), how.count, how.stride));
  }
  if (bytes > unpacked_bytes_left_) {
    return length.error(fmt::format("expected at most {} more bytes to be unpacked, found {}", unpacked_bytes_left_, bytes),
                        ErrorCode::Limit);
  }
  TWEEND_ASSIGN(const Bytes packed, slice(extension));
  TWEEND_ASSIGN(std::vector<std::byte> unpacked, unpack_meshopt(how, packed, extension));
  unpacked_bytes_left_ -= bytes;
  return Bytes(unpacked_[view.position()] = std::move(unpacked));
}

Result<GltfView> GltfBuffers::view(const JsonNode& reference) {
  TWEEND_ASSIGN(const JsonNode node, file_.refer(reference, "bufferViews"));
  if (const auto known = views_.find(node.position()); known != views_.end()) return known->second;
  GltfView view;
  if (const auto stride = node.find("byteStride")) {
    TWEEND_ASSIGN(view.stride, stride->whole(kLeastStride, kMostStride));
    if (view.stride % 4 != 0) return stride->expected("a multiple of 4");
  }
  if (const auto meshopt = find_extension(node, kMeshopt)) {
    TWEEND_ASSIGN(view.bytes, unpack(node, *meshopt));
  } else {
    TWEEND_ASSIGN(view.bytes, slice(node));
  }
  views_.emplace(node.position(), view);
  return view;
}

}  // namespace tweend::assets
