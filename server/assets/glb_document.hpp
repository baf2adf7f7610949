#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/base/result.hpp"

namespace tweend::assets {

// A glTF 2.0 document to be written, as plain values: what stands in its JSON, and the bytes of its one buffer.
// Indices are places in the document's lists.

enum class GlbShape : std::uint8_t { Scalar, Vec2, Vec3, Vec4, Mat4 };
enum class GlbComponent : std::uint16_t { U8 = 5121, U16 = 5123, U32 = 5125, F32 = 5126 };
/// What a buffer view is for: WebGL's names of ARRAY_BUFFER and ELEMENT_ARRAY_BUFFER, or neither.
enum class GlbUse : std::uint16_t { None = 0, Vertices = 34962, Indices = 34963 };

struct GlbBufferView {
  std::size_t offset = 0;
  std::size_t bytes = 0;
  GlbUse use = GlbUse::None;
};

struct GlbAccessor {
  std::optional<std::size_t> view{};  ///< empty: all zeros
  GlbShape shape = GlbShape::Scalar;
  GlbComponent component = GlbComponent::F32;
  std::size_t count = 0;
  std::vector<float> min{};  ///< of each number of an element; empty: not told
  std::vector<float> max{};
};

struct GlbNode {
  std::string name;
  std::vector<std::size_t> children{};
  std::array<float, 3> translation{0.0F, 0.0F, 0.0F};
  std::array<float, 4> rotation{0.0F, 0.0F, 0.0F, 1.0F};  ///< unit xyzw
  std::array<float, 3> scale{1.0F, 1.0F, 1.0F};
  std::optional<std::size_t> mesh{};
  std::optional<std::size_t> skin{};
};

struct GlbMorph {
  std::size_t position = 0;
  std::optional<std::size_t> normal{};
};

struct GlbPrimitive {
  std::vector<std::pair<std::string, std::size_t>> attributes;
  std::size_t indices = 0;
  std::optional<std::size_t> material{};
  std::vector<GlbMorph> targets{};
};

struct GlbMesh {
  std::string name;
  std::vector<GlbPrimitive> primitives;
  std::vector<float> weights;  ///< of the targets, where nothing animates them
  std::vector<std::string> target_names;
};

struct GlbSkin {
  std::vector<std::size_t> joints;  ///< none twice
  std::size_t inverse_bind_matrices = 0;
};

struct GlbChannel {
  std::size_t sampler = 0;
  std::size_t node = 0;
  std::string path;
};

struct GlbSampler {
  std::size_t input = 0;
  std::size_t output = 0;
  std::string interpolation;
};

struct GlbAnimation {
  std::string name;
  std::vector<GlbChannel> channels;
  std::vector<GlbSampler> samplers;
};

struct GlbTexture {
  std::size_t image = 0;
  std::uint16_t wrap_s = 10497;  ///< WebGL's names: REPEAT; MIRRORED_REPEAT 33648, CLAMP_TO_EDGE 33071
  std::uint16_t wrap_t = 10497;
};

struct GlbMaterial {
  std::string name;
  std::array<float, 4> base_color{1.0F, 1.0F, 1.0F, 1.0F};  ///< linear
  std::optional<std::size_t> texture{};
  std::optional<float> alpha_cutoff{};
  bool unlit = false;
};

struct GlbDocument {
  std::vector<std::size_t> roots{};
  std::vector<GlbNode> nodes{};
  std::vector<GlbMesh> meshes{};
  std::vector<GlbSkin> skins{};
  std::vector<GlbAnimation> animations{};
  std::vector<GlbMaterial> materials{};
  std::vector<GlbTexture> textures{};
  std::vector<std::size_t> png_images{};  ///< their buffer views
  std::vector<GlbAccessor> accessors{};
  std::vector<GlbBufferView> views{};
  std::string buffer{};
};

/// Floats in each element of a shape.
[[nodiscard]] std::size_t numbers_of(GlbShape shape) noexcept;

/// A buffer view of these bytes, from a multiple of 4 on.
std::size_t add_view(GlbDocument& document, std::span<const std::byte> bytes, GlbUse use);
/// An accessor of floats; with `bounds` its least and greatest numbers are told.
/// @param values  finite, whole elements, at least one
std::size_t add_floats(GlbDocument& document, std::span<const float> values, GlbShape shape, GlbUse use, bool bounds);
/// An accessor of `count` three-dimensional zeros, which takes no bytes.
std::size_t add_zeros(GlbDocument& document, std::size_t count);
/// An accessor of triangles' indices, in 16 bits where they fit.
std::size_t add_indices(GlbDocument& document, std::span<const std::uint32_t> indices);
/// An accessor of four of a skin's joints each, in 8 bits where they fit.
std::size_t add_joints(GlbDocument& document, std::span<const std::uint16_t> joints);

/// The document as a .glb file (glTF 2.0, section 4.4): the header, the JSON, the buffer.
/// @return Limit for more than `most_bytes`
[[nodiscard]] Result<std::string> write_document(const GlbDocument& document, std::size_t most_bytes);

}  // namespace tweend::assets
