#include "render/gpu_deform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>

#include "server/base/log.hpp"

namespace tweend::render {
namespace {

// The attributes and texture units of shaders/deform.glsl.
constexpr GLuint kEntries = 1;
constexpr GLuint kWeights = 5;
constexpr GLuint kRowsUnit = 1;
constexpr GLuint kWordsUnit = 2;
constexpr GLuint kDisplacementsUnit = 3;

/// A target of a picture: its run and its weight, two texels of words.
using TargetWords = std::array<std::int32_t, 8>;

GlBuffer buffer_of(std::span<const std::byte> bytes) {
  GlBuffer buffer = GlBuffer::make();
  glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  return buffer;
}

std::size_t most_texels() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  return static_cast<std::size_t>(most);
}

}  // namespace

GpuDeform::GpuDeform(const MeshSource& source) {
  if (source.skin.per_vertex > 0) upload_skin(source.skin);
  if (!source.morphs.empty()) upload_morphs(source.morphs);
}

bool GpuDeform::wanted(const DrawItem& item) noexcept {
  return item.vertices.empty() && (!item.palette.empty() || std::any_of(item.morph_weights.begin(), item.morph_weights.end(),
                                                                        [](float w) { return w != 0.0F; }));
}

std::size_t GpuDeform::influences(const DrawItem& item) noexcept {
  return item.palette.empty() ? 0 : item.mesh->skin.per_vertex;
}

void GpuDeform::upload_skin(const SkinSource& skin) {
  per_vertex_ = skin.per_vertex;
  entries_ = buffer_of(std::as_bytes(skin.entries));
  bytes_ += skin.entries.size_bytes();
  if (per_vertex_ == 1) return;
  weights_ = buffer_of(std::as_bytes(skin.weights));
  bytes_ += skin.weights.size_bytes();
}

void GpuDeform::upload_morphs(const std::vector<MorphSource>& morphs) {
  std::size_t texels = 0;
  const std::size_t most = most_texels();
  for (const MorphSource& morph : morphs) {
    const std::size_t count = morph.positions.size() / 3;
    const std::size_t wanted = count + morph.normals.size() / 3;
    Run& run = runs_.emplace_back();
    if (wanted > most - texels) {
      log::warn(
          fmt::format("expected morph targets of at most {} displacements on this device, found more; pictures leave "
                      "target {} of a mesh out",
                      most, runs_.size() - 1));
      continue;
    }
    run = {static_cast<std::int32_t>(morph.first_vertex), static_cast<std::int32_t>(count), static_cast<std::int32_t>(texels),
           morph.normals.empty() ? -1 : static_cast<std::int32_t>(texels + count)};
    texels += wanted;
  }
  if (texels == 0) return;
  displacements_ = GlBuffer::make();
  const std::size_t size = texels * 3 * sizeof(float);
  glNamedBufferStorage(displacements_.name(), static_cast<GLsizeiptr>(size), nullptr, GL_DYNAMIC_STORAGE_BIT);
  const auto write = [this](std::int32_t texel, std::span<const float> values) {
    glNamedBufferSubData(displacements_.name(), GLintptr{texel} * 3 * GLintptr{sizeof(float)},
                         static_cast<GLsizeiptr>(values.size_bytes()), values.data());
  };
  for (std::size_t i = 0; i < morphs.size(); ++i) {
    if (runs_[i].vertex_count == 0) continue;
    write(runs_[i].positions, morphs[i].positions);
    if (runs_[i].normals >= 0) write(runs_[i].normals, morphs[i].normals);
  }
  displacement_texels_ = GlTexture::make(GLenum{GL_TEXTURE_BUFFER});
  glTextureBuffer(displacement_texels_.name(), GL_RGB32F, displacements_.name());
  bytes_ += size;
}

void GpuDeform::attach_to(GLuint vertex_array) const {
  const auto each = static_cast<GLsizei>(per_vertex_);
  for (GLuint i = 0; 4 * i < per_vertex_; ++i) {
    glEnableVertexArrayAttrib(vertex_array, kEntries + i);
    glVertexArrayAttribIFormat(vertex_array, kEntries + i, std::min(each, 4), GL_UNSIGNED_SHORT, 0);
    glVertexArrayAttribBinding(vertex_array, kEntries + i, kEntries + i);
    glVertexArrayVertexBuffer(vertex_array, kEntries + i, entries_.name(), GLintptr{i} * 4 * GLintptr{sizeof(std::uint16_t)},
                              each * static_cast<GLsizei>(sizeof(std::uint16_t)));
    if (per_vertex_ == 1) return;
    glEnableVertexArrayAttrib(vertex_array, kWeights + i);
    glVertexArrayAttribFormat(vertex_array, kWeights + i, 4, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(vertex_array, kWeights + i, kWeights + i);
    glVertexArrayVertexBuffer(vertex_array, kWeights + i, weights_.name(), GLintptr{i} * 4 * GLintptr{sizeof(float)},
                              each * static_cast<GLsizei>(sizeof(float)));
  }
}

PosePlace GpuDeform::bind(const DrawItem& item, FrameMemory& memory) const {
  const std::size_t weights = std::min(item.morph_weights.size(), runs_.size());
  const auto weighs = [&](std::size_t i) { return item.morph_weights[i] != 0.0F && runs_[i].vertex_count > 0; };
  std::size_t targets = 0;
  for (std::size_t i = 0; i < weights; ++i) {
    if (weighs(i)) ++targets;
  }

  // One piece for both: they are read from one buffer.
  const FrameMemory::Piece piece = memory.take(item.palette.size_bytes() + targets * sizeof(TargetWords));
  if (piece.memory.empty()) return {};
  if (!item.palette.empty()) std::memcpy(piece.memory.data(), item.palette.data(), item.palette.size_bytes());
  std::byte* to = piece.memory.data() + item.palette.size_bytes();
  for (std::size_t i = 0; i < weights; ++i) {
    if (!weighs(i)) continue;
    const Run& run = runs_[i];
    const TargetWords words{run.first_vertex, run.vertex_count, run.positions, run.normals,
                            std::bit_cast<std::int32_t>(item.morph_weights[i])};
    std::memcpy(to, words.data(), sizeof words);
    to += sizeof words;
  }
  glBindTextureUnit(kRowsUnit, piece.rows);
  glBindTextureUnit(kWordsUnit, piece.words);
  if (displacement_texels_) glBindTextureUnit(kDisplacementsUnit, displacement_texels_.name());
  const auto rows = static_cast<GLint>(item.palette.size_bytes() / FrameMemory::kTexelBytes);
  return {piece.first_texel(), piece.first_texel() + rows, static_cast<GLint>(targets)};
}

}  // namespace tweend::render
