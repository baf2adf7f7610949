#include "tests/render/support/offscreen.hpp"

#include <array>
#include <glm/vec3.hpp>
#include <stdexcept>
#include <string>

namespace tweend::render::test {
namespace {

constexpr const char* kCaptureMain = R"(
out vec3 tweened_position;
out vec3 tweened_normal;
out vec3 tweened_tangent;

void main() {
  tweened_position = TWEENED_POSITION;
  tweened_normal = TWEENED_NORMAL;
  tweened_tangent = TWEENED_TANGENT;
#ifdef POSED
  deform(tweened_position, tweened_normal);
#endif
  gl_Position = vec4(0.0);
}
)";

}  // namespace

Offscreen::Offscreen(std::size_t gpu_bytes) {
  auto context = EglContext::open();
  if (!context) throw std::runtime_error(context.error().message);
  context_ = std::move(*context);
  auto renderer = Renderer::make(gpu_bytes);
  if (!renderer) throw std::runtime_error(renderer.error().message);
  renderer_ = std::move(*renderer);
}

Image Offscreen::draw(const Picture& picture, int samples) {
  auto target = RenderTarget::make(picture.size, samples);
  EXPECT_TRUE(target) << target.error().message;
  if (!target) return Image(picture.size);
  renderer_->draw(picture, **target);
  ReadbackPool pool;
  const PixelsPtr pixels = pool.take(picture.size);
  (*target)->read_into(pixels->buffer());
  glFinish();
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  return Image(pixels->view());
}

Tweened capture_tween(GpuCache& cache, const DrawItem& item) {
  constexpr std::array<const char*, 3> kCaptured{"tweened_position", "tweened_normal", "tweened_tangent"};
  const std::string prologue = vertex_prologue(variant_of(item));
  const auto program = ShaderProgram::link({prologue, kCaptureMain}, {}, kCaptured);
  EXPECT_TRUE(program) << program.error().message;
  program->use();
  program->set(program->location("weights"), glm::vec4(item.weight[0], item.weight[1], item.weight[2], item.weight[3]));
  program->set(program->location("nearest"), static_cast<int>(item.nearest));

  const std::size_t count = item.mesh->vertex_count;
  const GlBuffer written = GlBuffer::make();
  glNamedBufferStorage(written.name(), static_cast<GLsizeiptr>(count * 9 * sizeof(float)), nullptr, 0);
  const auto target = RenderTarget::make({1, 1}, 1);  // nothing reaches it, but a draw wants one
  EXPECT_TRUE(target) << target.error().message;
  glBindFramebuffer(GL_FRAMEBUFFER, (*target)->framebuffer());
  cache.begin_picture();
  FrameMemory memory;
  const PosePlace pose = cache.mesh(*item.mesh).bind(item, memory);
  program->set(program->location("pose_at"), glm::ivec3(pose.palette, pose.targets, pose.target_count));
  glEnable(GL_RASTERIZER_DISCARD);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, written.name());
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);

  Tweened tweened;
  const std::vector<float> all = read_buffer(written.name(), 0, count * 9);
  for (std::size_t v = 0; v < count; ++v) {
    const auto* at = all.data() + 9 * v;
    tweened.positions.insert(tweened.positions.end(), at, at + 3);
    tweened.normals.insert(tweened.normals.end(), at + 3, at + 6);
    if (!item.mesh->texcoords.empty()) tweened.tangents.insert(tweened.tangents.end(), at + 6, at + 9);
  }
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  return tweened;
}

std::vector<float> read_buffer(GLuint name, GLintptr offset_bytes, std::size_t floats) {
  std::vector<float> values(floats);
  glGetNamedBufferSubData(name, offset_bytes, static_cast<GLsizeiptr>(floats * sizeof(float)), values.data());
  return values;
}

}  // namespace tweend::render::test
