#include "render/gpu_cache.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace tweend::render {
namespace {

std::shared_ptr<const GlTexture> upload(const TextureSource& source) {
  auto texture = std::make_shared<GlTexture>(GlTexture::make(GLenum{GL_TEXTURE_2D}));
  const GLuint name = texture->name();
  const auto width = static_cast<GLsizei>(source.size.width);
  const auto height = static_cast<GLsizei>(source.size.height);
  const auto levels = static_cast<GLsizei>(std::bit_width(std::max(source.size.width, source.size.height)));
  glTextureStorage2D(name, levels, GL_SRGB8_ALPHA8, width, height);
  glTextureSubImage2D(name, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, source.rgba.data());
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glGenerateTextureMipmap(name);
  return texture;
}

}  // namespace

void GpuCache::begin_picture() {
  ++pictures_;
  std::size_t bytes = 0;
  for (const auto& [id, entry] : meshes_) bytes += entry.mesh->bytes();
  while (bytes > most_bytes_) {
    const auto least = std::min_element(meshes_.begin(), meshes_.end(),
                                        [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    if (least->second.used + 1 >= pictures_) break;  // the last picture needed all of it, and so may this one
    bytes -= least->second.mesh->bytes();
    meshes_.erase(least);
  }
}

GpuMesh& GpuCache::mesh(const MeshSource& source) {
  Entry& entry = meshes_[source.id];
  entry.used = pictures_;
  if (!entry.mesh) {
    GpuMesh::Textures textures;
    for (const MaterialSource& material : source.materials) {
      textures.push_back(material.base_color_texture ? texture(*material.base_color_texture) : nullptr);
    }
    entry.mesh = std::make_unique<GpuMesh>(source, textures, most_bytes_);
  }
  return *entry.mesh;
}

std::shared_ptr<const GlTexture> GpuCache::texture(const TextureSource& source) {
  std::weak_ptr<const GlTexture>& held = textures_[source.id];
  if (auto texture = held.lock()) return texture;
  std::erase_if(textures_, [&](const auto& t) { return t.second.expired() && t.first != source.id; });
  auto texture = upload(source);
  held = texture;
  return texture;
}

std::uint64_t GpuCache::key_uploads() const noexcept {
  std::uint64_t uploads = 0;
  for (const auto& [id, entry] : meshes_) uploads += entry.mesh->keys().uploads();
  return uploads;
}

}  // namespace tweend::render
