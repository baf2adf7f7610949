#include "render/renderer.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "render/shader_sources.hpp"

namespace tweend::render {
namespace {

/// The uniform block of shaders/frame.glsl, std140: every member is 16 bytes or a multiple.
struct FrameBlock {
  glm::mat4 clip_from_world;
  glm::vec4 eye;
  glm::vec4 light_position;
  glm::vec4 light_terms;
  glm::vec4 grid_terms;
  glm::vec4 grid_color;
};
static_assert(sizeof(FrameBlock) == 64 + 5 * 16);

/// Cells of 1, 10, 100 … metres (or 0.1 …), a good dozen of them between the eye and what it looks at.
float grid_cell_m(float focus_m) { return std::pow(10.0F, std::floor(std::log10(std::max(focus_m, 1e-6F) / 3.0F))); }

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::make(std::size_t gpu_bytes) {
  std::unique_ptr<Renderer> renderer(new Renderer(gpu_bytes));
  TWEEND_TRY(renderer->link_programs());
  renderer->make_samplers();
  glNamedBufferStorage(renderer->frame_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  return renderer;
}

Status Renderer::link_programs() {
  TWEEND_TRY(mesh_programs_.link());
  TWEEND_TRY(bone_drawer_.link());
  TWEEND_ASSIGN(grid_program_,
                ShaderProgram::link({shaders::kFrame, shaders::kGridVert}, {shaders::kFrame, shaders::kGridFrag}));
  grid_center_ = grid_program_.location("center");
  return {};
}

void Renderer::make_samplers() {
  constexpr std::array<GLint, 3> kModes{GL_REPEAT, GL_MIRRORED_REPEAT, GL_CLAMP_TO_EDGE};  // in TextureWrap's order
  for (std::size_t i = 0; i < samplers_.size(); ++i) {
    samplers_[i] = GlSampler::make();
    const GLuint name = samplers_[i].name();
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, kModes[i / kModes.size()]);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, kModes[i % kModes.size()]);
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
}

void Renderer::draw(const Picture& picture, const RenderTarget& target) {
  cache_.begin_picture();
  memory_.begin_picture();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  glViewport(0, 0, static_cast<GLsizei>(picture.size.width), static_cast<GLsizei>(picture.size.height));
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  const glm::vec3 background = linear_from_srgb(picture.background);
  glClearColor(background.x, background.y, background.z, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  set_frame(picture);
  for (const DrawItem& item : picture.items) draw_item(item);
  glFrontFace(GL_CCW);
  bone_drawer_.draw(picture.bones, memory_);
  if (picture.grid) draw_grid(picture);
  if (!picture.bones_over.empty()) {
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
    bone_drawer_.draw(picture.bones_over, memory_);
  }
  memory_.end_picture();
  target.resolve();
}

void Renderer::set_frame(const Picture& picture) {
  const PointLight& light = picture.light;
  const glm::vec3 background = linear_from_srgb(picture.background);
  // Lines stand out from a dark background and from a light one.
  const bool dark = glm::dot(background, glm::vec3(0.2126F, 0.7152F, 0.0722F)) < 0.2F;
  const float cell_m = grid_cell_m(picture.view.focus_m);
  const FrameBlock block{picture.view.clip_from_view * picture.view.view_from_world,
                         glm::vec4(picture.view.eye, 1.0F),
                         glm::vec4(light.position, 1.0F),
                         glm::vec4(light.ambient, light.diffuse, light.specular, light.shininess),
                         glm::vec4(cell_m, 8.0F * picture.view.focus_m, 0.0F, 0.0F),
                         glm::vec4(glm::vec3(dark ? 0.35F : 0.05F), 1.0F)};
  glNamedBufferSubData(frame_.name(), 0, sizeof block, &block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.name());
}

void Renderer::draw_item(const DrawItem& item) {
  GpuMesh& mesh = cache_.mesh(*item.mesh);
  const PosePlace pose = mesh.bind(item, memory_);
  // A mirrored actor's triangles run the other way round.
  glFrontFace(glm::determinant(glm::mat3(item.world_from_model)) < 0.0F ? GL_CW : GL_CCW);
  // Vertices without colours of their own take this one.
  glVertexAttrib4f(kColorAttribute, 1.0F, 1.0F, 1.0F, 1.0F);
  MeshVariant variant = variant_of(item);
  const MeshProgram* begun = nullptr;
  for (const GpuMesh::Range& range : mesh.ranges()) {
    variant.cutout = range.alpha_cutoff.has_value();
    const MeshProgram& program = mesh_programs_.of(variant);
    if (&program != begun) program.begin(item, pose);
    begun = &program;
    program.set_material(range);
    if (range.texture) {
      glBindTextureUnit(0, range.texture->name());
      glBindSampler(0, samplers_[3 * static_cast<std::size_t>(range.wrap_u) + static_cast<std::size_t>(range.wrap_v)].name());
    }
    glDrawElements(GL_TRIANGLES, range.index_count, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(range.first_index * sizeof(std::uint32_t)));
  }
}

void Renderer::draw_grid(const Picture& picture) const {
  // Centred on what the view looks at, so that the ground ends nowhere in sight.
  const glm::vec3 ahead =
      glm::vec3(glm::inverse(picture.view.view_from_world) * glm::vec4(0.0F, 0.0F, -picture.view.focus_m, 1.0F));
  grid_program_.use();
  grid_program_.set(grid_center_, glm::vec2(ahead.x, ahead.z));
  glBindVertexArray(no_vertices_.name());
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);  // the picture stays opaque
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace tweend::render
