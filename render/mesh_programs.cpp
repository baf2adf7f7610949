#include "render/mesh_programs.hpp"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "render/shader_sources.hpp"

namespace tweend::render {
namespace {

constexpr std::array<MeshVariant, 7> kVertexVariants{{{.sources = 1},
                                                      {.sources = 2},
                                                      {.sources = 4},
                                                      {.posed = true},
                                                      {.posed = true, .influences = 1},
                                                      {.posed = true, .influences = 4},
                                                      {.posed = true, .influences = 8}}};

/// Turns normals as the inverse transpose does, but for their length, and also where an actor is scaled flat and has no
/// inverse: the cofactors, with the sign of the determinant.
glm::mat3 normal_matrix(const glm::mat3& m) {
  const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0.0F ? -cofactors : cofactors;
}

/// What both stages are told of a variant.
std::string defines(const MeshVariant& variant) {
  // The bound below which a direction means nothing is animation's, blend_kernels.hpp; tests hold the two together.
  return fmt::format("#define SOURCES {}\n#define INFLUENCES {}\n#define SHORTEST_DIRECTION 1e-6\n{}{}", variant.sources,
                     variant.influences, variant.posed ? "#define POSED\n" : "", variant.cutout ? "#define CUTOUT\n" : "");
}

}  // namespace

MeshVariant variant_of(const DrawItem& item) noexcept {
  if (!item.vertices.empty()) return {};
  if (GpuDeform::wanted(item)) return {.posed = true, .influences = static_cast<int>(GpuDeform::influences(item))};
  return {.sources = item.key_count <= 2 ? static_cast<int>(item.key_count) : 4};
}

std::string vertex_prologue(const MeshVariant& variant) {
  return fmt::format("{}{}{}{}", defines(variant), shaders::kFrame, shaders::kTween,
                     variant.posed ? shaders::kDeform : std::string_view());
}

Status MeshProgram::link(const MeshVariant& variant) {
  const std::string vertex = vertex_prologue(variant), fragment = defines(variant);
  TWEEND_ASSIGN(program_, ShaderProgram::link({vertex, shaders::kMeshVert},
                                              {fragment, shaders::kFrame, shaders::kLight, shaders::kMeshFrag}));
  world_from_model_ = program_.location("world_from_model");
  world_from_model_normal_ = program_.location("world_from_model_normal");
  weights_ = program_.location("weights");
  nearest_ = program_.location("nearest");
  pose_at_ = program_.location("pose_at");
  base_color_ = program_.location("base_color");
  textured_ = program_.location("textured");
  unlit_ = program_.location("unlit");
  alpha_cutoff_ = program_.location("alpha_cutoff");
  return {};
}

void MeshProgram::begin(const DrawItem& item, const PosePlace& pose) const {
  program_.use();
  program_.set(world_from_model_, item.world_from_model);
  program_.set(world_from_model_normal_, normal_matrix(glm::mat3(item.world_from_model)));
  program_.set(weights_, glm::vec4(item.weight[0], item.weight[1], item.weight[2], item.weight[3]));
  program_.set(nearest_, static_cast<int>(item.nearest));
  program_.set(pose_at_, glm::ivec3(pose.palette, pose.targets, pose.target_count));
}

void MeshProgram::set_material(const GpuMesh::Range& range) const {
  program_.set(base_color_, range.base_color);
  program_.set(textured_, range.texture ? 1 : 0);
  program_.set(unlit_, range.unlit ? 1 : 0);
  if (range.alpha_cutoff) program_.set(alpha_cutoff_, *range.alpha_cutoff);
}

Status MeshPrograms::link() {
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    MeshVariant variant = kVertexVariants[i % kVertexStages];
    variant.cutout = i >= kVertexStages;
    TWEEND_TRY(programs_[i].link(variant));
  }
  return {};
}

const MeshProgram& MeshPrograms::of(const MeshVariant& variant) const noexcept {
  std::size_t at = 0;
  if (variant.posed) {
    at = variant.influences == 0 ? 3 : variant.influences == 1 ? 4 : variant.influences == 4 ? 5 : 6;
  } else {
    at = variant.sources == 1 ? 0 : variant.sources == 2 ? 1 : 2;
  }
  return programs_[at + (variant.cutout ? kVertexStages : 0)];
}

}  // namespace tweend::render
