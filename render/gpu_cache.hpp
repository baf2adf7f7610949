#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

#include "render/gpu_mesh.hpp"
#include "render/picture.hpp"

namespace tweend::render {

/// What has been uploaded, by content. Meshes that no picture has shown for longest make room for new ones.
/// The context's thread only.
class GpuCache {
 public:
  /// @param most_bytes  of meshes and their keyframes together; one picture may need more
  explicit GpuCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Meshes asked for from here on belong to one picture and stay until the next begins.
  void begin_picture();
  /// The mesh, uploaded the first time. Good until the next begin_picture().
  [[nodiscard]] GpuMesh& mesh(const MeshSource& source);
  /// Lets everything go; what is asked for next is uploaded anew.
  void forget() noexcept { meshes_.clear(); }

  /// How many keyframes have been written to the GPU so far, by meshes that are there.
  [[nodiscard]] std::uint64_t key_uploads() const noexcept;
  [[nodiscard]] std::size_t mesh_count() const noexcept { return meshes_.size(); }

 private:
  struct Entry {
    std::unique_ptr<GpuMesh> mesh;
    std::uint64_t used = 0;  ///< the picture's number
  };
  [[nodiscard]] std::shared_ptr<const GlTexture> texture(const TextureSource& source);

  const std::size_t most_bytes_;
  std::uint64_t pictures_ = 0;
  std::map<ResourceId, Entry> meshes_;
  std::map<ResourceId, std::weak_ptr<const GlTexture>> textures_;  ///< held by the meshes that show them
};

}  // namespace tweend::render
