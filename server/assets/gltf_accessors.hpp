#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "server/assets/gltf_buffers.hpp"
#include "server/assets/gltf_file.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// glTF's `componentType`.
enum class GltfComponent : std::uint16_t { I8 = 5120, U8 = 5121, I16 = 5122, U16 = 5123, U32 = 5125, F32 = 5126 };

/// What one number of an accessor may be.
struct GltfNumber {
  GltfComponent component = GltfComponent::F32;
  bool normalized = false;  ///< whole numbers that stand for [0, 1] or [-1, 1]
  bool operator==(const GltfNumber&) const = default;
};

/// What an accessor says of itself, checked; its elements are not read yet.
struct GltfAccessor {
  JsonNode node;
  std::string_view type;  ///< SCALAR, VEC2, VEC3, VEC4, MAT4 …
  std::size_t width = 1;  ///< numbers an element
  std::size_t count = 0;  ///< elements, at least 1
  GltfNumber number;

  [[nodiscard]] std::size_t element_bytes() const noexcept;
};

/// What an accessor must be for its purpose.
struct GltfAccessorRule {
  std::string_view type;
  std::span<const GltfNumber> numbers;  ///< any one of them
};

/// Reads the accessors of a glTF file: every component type, normalized, interleaved and sparse ones. Each offset and count is
/// checked against the bytes there are. Not thread-safe.
class GltfAccessors {
 public:
  /// @param file, buffers  outlive this
  GltfAccessors(const GltfFile& file, GltfBuffers& buffers) : file_(file), buffers_(buffers) {}

  /// @param reference  the index of an accessor
  /// @return BadAsset naming what does not follow the rule; nothing is read yet
  [[nodiscard]] Result<GltfAccessor> describe(const JsonNode& reference, const GltfAccessorRule& rule) const;

  /// Whether the accessor that `reference` is the index of has that type.
  [[nodiscard]] Result<bool> has_type(const JsonNode& reference, std::string_view type) const;
  /// Success where the bytes of its view hold so many elements, or it has no view.
  [[nodiscard]] Status check_backed(const GltfAccessor& accessor);

  // The numbers of all elements, shape [count × width]. An accessor without a buffer view is zeros, whose count nothing
  // backs: whoever calls has made sure that it can't be too large.

  /// @return BadAsset naming the accessor and what in it does not fit the bytes, or is not a finite number
  [[nodiscard]] Result<std::vector<float>> floats(const GltfAccessor& accessor);
  /// Of one with whole numbers without a sign.
  [[nodiscard]] Result<std::vector<std::uint32_t>> wholes(const GltfAccessor& accessor);

 private:
  using Bytes = std::vector<std::byte>;
  /// Elements in a view: `bytes` each, one every `stride` bytes.
  struct Run {
    std::span<const std::byte> from;
    std::size_t stride = 0;
    std::size_t count = 0;
    std::size_t bytes = 0;
    [[nodiscard]] Bytes gather() const;
  };
  /// The elements side by side.
  [[nodiscard]] Result<Bytes> elements(const GltfAccessor& accessor);
  [[nodiscard]] Result<Bytes> dense(const GltfAccessor& accessor);
  [[nodiscard]] Status put_sparse(const GltfAccessor& accessor, const JsonNode& sparse, Bytes& elements);
  /// `count` elements of `bytes` each in the view that `node` names.
  [[nodiscard]] Result<Run> locate(const JsonNode& node, const JsonNode& count_node, std::size_t count, GltfComponent component,
                                   std::size_t bytes);

  const GltfFile& file_;
  GltfBuffers& buffers_;
};

/// Bytes of one.
[[nodiscard]] std::size_t size_of(GltfComponent component) noexcept;

}  // namespace tweend::assets
