#include "render/gpu_mesh.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <utility>

namespace tweend::render {
namespace {

// Attribute i of a kind is fed from binding i: shaders/tween.glsl has the same numbers.
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
    : keys_(source.vertex_count * (source.texcoords.empty() ? 6 : 9), most_key_bytes),
      stream_bytes_(static_cast<GLintptr>(source.vertex_count) * kVectorBytes),
      tangents_(!source.texcoords.empty()) {
  const GLuint array = vertex_array_.name();
  upload_indices(source, textures);
  for (const GLuint kind : {kPosition, kNormal, kTangent}) {
    if (kind == kTangent && !tangents_) continue;
    for (GLuint i = kind; i < kind + kSources; ++i) {
      glEnableVertexArrayAttrib(array, i);
      glVertexArrayAttribFormat(array, i, 3, GL_FLOAT, GL_FALSE, 0);
      glVertexArrayAttribBinding(array, i, i);
    }
  }
  if (source.texcoords.empty()) return;
  texcoords_ = GlBuffer::make();
  glNamedBufferStorage(texcoords_.name(), static_cast<GLsizeiptr>(source.texcoords.size_bytes()), source.texcoords.data(), 0);
  fixed_bytes_ += source.texcoords.size_bytes();
  glEnableVertexArrayAttrib(array, kTexcoord);
  glVertexArrayAttribFormat(array, kTexcoord, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, kTexcoord, kTexcoord);
  glVertexArrayVertexBuffer(array, kTexcoord, texcoords_.name(), 0, 2 * sizeof(float));
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
    ranges_.push_back({first, static_cast<GLsizei>(indices.size()), linear_from_srgb(source.materials[material].base_color),
                       textures[material]});
    first += indices.size();
  }
  glVertexArrayElementBuffer(vertex_array_.name(), indices_.name());
  fixed_bytes_ += source.indices.size_bytes();
}

void GpuMesh::bind(const DrawItem& item) {
  const std::array<GLintptr, 4> offsets = keys_.place(std::span(item.key).first(item.key_count), item.keys_expected);
  const GLuint array = vertex_array_.name();
  for (GLuint i = 0; i < kSources; ++i) {
    // Of three keyframes the fourth source is the first again, with weight 0.
    const GLintptr offset = offsets[i < item.key_count ? i : 0];
    glVertexArrayVertexBuffer(array, kPosition + i, keys_.name(), offset, kVectorBytes);
    glVertexArrayVertexBuffer(array, kNormal + i, keys_.name(), offset + stream_bytes_, kVectorBytes);
    if (tangents_) glVertexArrayVertexBuffer(array, kTangent + i, keys_.name(), offset + 2 * stream_bytes_, kVectorBytes);
  }
  glBindVertexArray(array);
}

}  // namespace tweend::render
