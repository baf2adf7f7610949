#pragma once

#include <array>
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <string>

#include "render/gpu_deform.hpp"
#include "render/gpu_mesh.hpp"
#include "render/picture.hpp"
#include "render/shader_program.hpp"

namespace tweend::render {

/// What sets one program that draws meshes apart from another.
struct MeshVariant {
  int sources = 1;      ///< keyframes that are bound: 1, 2 or 4
  bool posed = false;   ///< morphed and skinned; then one keyframe
  int influences = 0;   ///< of the skin: 0, 1, 4 or 8
  bool cutout = false;  ///< leaves out what is too transparent. Apart from the others: it decides depth late
};

/// The variant that draws the item, but for its materials.
[[nodiscard]] MeshVariant variant_of(const DrawItem& item) noexcept;
/// The vertex stage of a variant, up to but without its main().
[[nodiscard]] std::string vertex_prologue(const MeshVariant& variant);

/// A program of a variant, and where its uniforms are. The context's thread only.
class MeshProgram {
 public:
  /// @return Internal with the driver's log: the sources are ours
  [[nodiscard]] Status link(const MeshVariant& variant);
  /// Uses it for an item.
  void begin(const DrawItem& item, const PosePlace& pose) const;
  void set_material(const GpuMesh::Range& range) const;

 private:
  ShaderProgram program_;
  GLint world_from_model_ = -1;
  GLint world_from_model_normal_ = -1;
  GLint weights_ = -1;
  GLint nearest_ = -1;
  GLint pose_at_ = -1;
  GLint base_color_ = -1;
  GLint textured_ = -1;
  GLint unlit_ = -1;
  GLint alpha_cutoff_ = -1;
};

/// All of them, linked at the start: no picture waits for a compiler of ours.
class MeshPrograms {
 public:
  [[nodiscard]] Status link();
  [[nodiscard]] const MeshProgram& of(const MeshVariant& variant) const noexcept;

 private:
  static constexpr std::size_t kVertexStages = 7;  ///< 1, 2 and 4 keyframes; posed with 0, 1, 4 and 8 influences
  std::array<MeshProgram, 2 * kVertexStages> programs_;
};

}  // namespace tweend::render
