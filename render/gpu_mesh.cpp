#include "render/gpu_mesh.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <map>
#include <span>
#include <utility>

namespace tweend::render {
namespace {

// Attribute i of a kind is fed from binding i: shaders/tween.glsl and mesh.vert have the same numbers.
constexpr GLuint kPosition = 0;
constexpr GLuint kNormal = 4;
constexpr GLuint kTangent = 8;
constexpr GLuint kTexcoord = 12;
constexpr GLuint kSources = 4;
constexpr GLsizei kVectorBytes = 3 * sizeof(float);

}  // namespace

glm::vec3 linear_from_srgb(const glm::vec3& srgb) noexcept {
  glm::vec3 linear;
  for (int i = 0; i < 3; ++i) {
    const float c = glm::clamp(srgb[i], 0.0F, 1.0F);
    linear[i] = c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
  }
  return linear;
}

GpuMesh::GpuMesh(const MeshSource& source, const Textures& textures, std::size_t most_key_bytes)
    : deform_(source),
      keys_(source.vertex_count * (source.texcoords.empty() ? 6 : 9), most_key_bytes),
      stream_bytes_(static_cast<GLintptr>(source.vertex_count) * kVectorBytes),
      tangents_(!source.texcoords.empty()) {
  upload_indices(source, textures);
  upload_fixed(source);
  set_up(tweened_.name(), kSources);
  if (deform_.empty()) return;
  posed_ = GlVertexArray::make();
  set_up(posed_.name(), 1);
  deform_.attach_to(posed_.name());
}

void GpuMesh::upload_fixed(const MeshSource& source) {
  const auto upload = [this](GlBuffer& to, std::span<const float> values) {
    if (values.empty()) return;
    to = GlBuffer::make();
    glNamedBufferStorage(to.name(), static_cast<GLsizeiptr>(values.size_bytes()), values.data(), 0);
    fixed_bytes_ += values.size_bytes();
  };
  upload(texcoords_, source.texcoords);
  upload(colors_, source.colors);
}

void GpuMesh::set_up(GLuint vertex_array, GLuint sources) const {
  const auto attribute = [vertex_array](GLuint at, GLint floats) {
    glEnableVertexArrayAttrib(vertex_array, at);
    glVertexArrayAttribFormat(vertex_array, at, floats, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(vertex_array, at, at);
  };
  for (const GLuint kind : {kPosition, kNormal, kTangent}) {
    if (kind == kTangent && !tangents_) continue;
    for (GLuint i = kind; i < kind + sources; ++i) attribute(i, 3);
  }
  const auto fixed = [&](GLuint at, const GlBuffer& buffer, int floats) {
    if (!buffer) return;
    attribute(at, floats);
    glVertexArrayVertexBuffer(vertex_array, at, buffer.name(), 0, floats * static_cast<GLsizei>(sizeof(float)));
  };
  fixed(kTexcoord, texcoords_, 2);
  fixed(kColorAttribute, colors_, 4);
  glVertexArrayElementBuffer(vertex_array, indices_.name());
}

void GpuMesh::upload_indices(const MeshSource& source, const Textures& textures) {
  // Triangles of one material are drawn at once, however the file scatters them.
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_material;
  for (const PartSource& part : source.parts) {
    const auto run = source.indices.subspan(part.first_index, part.index_count);
    auto& indices = by_material[part.material];
    indices.insert(indices.end(), run.begin(), run.end());
  }
  glNamedBufferStorage(indices_.name(), static_cast<GLsizeiptr>(source.indices.size_bytes()), nullptr, GL_DYNAMIC_STORAGE_BIT);
  std::size_t first = 0;
  for (const auto& [material, indices] : by_material) {
    glNamedBufferSubData(indices_.name(), static_cast<GLintptr>(first * sizeof(std::uint32_t)),
                         static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data());
    const MaterialSource& shown = source.materials[material];
    ranges_.push_back({first, static_cast<GLsizei>(indices.size()), glm::vec4(linear_from_srgb(shown.base_color), shown.alpha),
                       textures[material], shown.wrap_u, shown.wrap_v, shown.alpha_cutoff, shown.unlit});
    first += indices.size();
  }
  fixed_bytes_ += source.indices.size_bytes();
}

PosePlace GpuMesh::bind(const DrawItem& item, FrameMemory& memory) {
  const bool posed = posed_ && GpuDeform::wanted(item);
  const GLuint array = posed ? posed_.name() : tweened_.name();
  if (item.vertices.empty()) {
    const std::array<GLintptr, 4> offsets = keys_.place(std::span(item.key).first(item.key_count), item.keys_expected);
    // Of three keyframes the fourth source is the first again, with weight 0.
    for (GLuint i = 0; i < (posed ? 1 : kSources); ++i) {
      bind_source(array, i, keys_.name(), offsets[i < item.key_count ? i : 0]);
    }
  } else {
    const FrameMemory::Piece piece = memory.take(item.vertices.size_bytes());
    if (!piece.memory.empty()) std::memcpy(piece.memory.data(), item.vertices.data(), item.vertices.size_bytes());
    for (GLuint i = 0; i < kSources; ++i) bind_source(array, i, piece.buffer, piece.offset);
  }
  glBindVertexArray(array);
  return posed ? deform_.bind(item, memory) : PosePlace{};
}

void GpuMesh::bind_source(GLuint vertex_array, GLuint source, GLuint buffer, GLintptr offset) const {
  glVertexArrayVertexBuffer(vertex_array, kPosition + source, buffer, offset, kVectorBytes);
  glVertexArrayVertexBuffer(vertex_array, kNormal + source, buffer, offset + stream_bytes_, kVectorBytes);
  if (tangents_) glVertexArrayVertexBuffer(vertex_array, kTangent + source, buffer, offset + 2 * stream_bytes_, kVectorBytes);
}

}  // namespace tweend::render
