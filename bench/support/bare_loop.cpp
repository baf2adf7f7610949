#include "bench/support/bare_loop.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <turbojpeg.h>

#include <chrono>
#include <glm/mat3x3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bench/support/server_process.hpp"
#include "render/shader_sources.hpp"

namespace tweend::bench {
namespace {

GLuint compile(GLenum stage, std::string_view text) {
  const GLuint shader = glCreateShader(stage);
  const std::string source = "#version 450 core\n" + std::string(text);
  const char* begin = source.c_str();
  glShaderSource(shader, 1, &begin, nullptr);
  glCompileShader(shader);
  GLint done = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done != GL_TRUE) give_up("the bare loop's shader does not compile");
  return shader;
}

GLuint link() {
  namespace shaders = render::shaders;
  const auto text = [](auto... parts) { return (std::string() + ... + std::string(parts)); };
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, text("#define SOURCES 2\n#define SHORTEST_DIRECTION 1e-6\n",
                                                         shaders::kFrame, shaders::kTween, shaders::kMeshVert)));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, text(shaders::kFrame, shaders::kLight, shaders::kMeshFrag)));
  glLinkProgram(program);
  GLint done = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done != GL_TRUE) give_up("the bare loop's program does not link");
  return program;
}

double ms_since(std::chrono::steady_clock::time_point& start) {
  const auto now = std::chrono::steady_clock::now();
  const double ms = std::chrono::duration<double, std::milli>(now - start).count();
  start = now;
  return ms;
}

}  // namespace

struct BareLoop::Impl {
  explicit Impl(const BareScene& scene)
      : width(scene.width),
        height(scene.height),
        index_count(static_cast<GLsizei>(scene.indices.size())),
        background(scene.background),
        pixels(std::size_t{4} * static_cast<std::size_t>(scene.width * scene.height)),
        file(tjBufSize(scene.width, scene.height, TJSAMP_420)) {
    open_context();
    make_target();
    upload(scene);
    set_program(scene);
  }

  ~Impl() {
    tjDestroy(jpeg);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);  // and with it all that was made in it
  }

  void open_context() {
    display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE || eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) {
      give_up("the bare loop found no EGL display");
    }
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
      give_up("the bare loop got no OpenGL 4.5 context");
    }
  }

  void make_target() const {
    GLuint framebuffer = 0, color = 0, depth = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenRenderbuffers(1, &color);
    glBindRenderbuffer(GL_RENDERBUFFER, color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    glGenRenderbuffers(1, &depth);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) give_up("the bare loop got no framebuffer");
    glViewport(0, 0, width, height);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glEnable(GL_DEPTH_TEST);
    glClearColor(background.x, background.y, background.z, 1.0F);
  }

  static void upload(const BareScene& scene) {
    GLuint vertex_array = 0, buffers[2] = {};
    glGenVertexArrays(1, &vertex_array);
    glBindVertexArray(vertex_array);
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.indices.size_bytes()), scene.indices.data(),
                 GL_STATIC_DRAW);
    const std::size_t block = scene.key[0].size_bytes();
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(2 * block), nullptr, GL_STATIC_DRAW);
    for (GLuint k = 0; k < 2; ++k) {
      glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(k * block), static_cast<GLsizeiptr>(block), scene.key[k].data());
      for (GLuint normal = 0; normal < 2; ++normal) {  // locations of shaders/tween.glsl: positions from 0, normals from 4
        const GLuint location = 4 * normal + k;
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, 0,
                              reinterpret_cast<const void*>(k * block + normal * block / 2));
      }
    }
  }

  void set_program(const BareScene& scene) {
    const GLuint program = link();
    glUseProgram(program);
    const struct {
      glm::mat4 clip_from_world;
      glm::vec4 eye, light_position, light_terms, grid_terms, grid_color;
    } frame{scene.clip_from_world,
            glm::vec4(scene.eye, 1.0F),
            glm::vec4(scene.light_position, 1.0F),
            scene.light_terms,
            glm::vec4(1.0F),
            glm::vec4(1.0F)};
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_UNIFORM_BUFFER, buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof frame, &frame, GL_STATIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
    const glm::mat4 identity(1.0F);
    const glm::mat3 upright(1.0F);
    glUniformMatrix4fv(glGetUniformLocation(program, "world_from_model"), 1, GL_FALSE, &identity[0].x);
    glUniformMatrix3fv(glGetUniformLocation(program, "world_from_model_normal"), 1, GL_FALSE, &upright[0].x);
    const glm::vec4 base_color(scene.base_color, 1.0F);
    glUniform4fv(glGetUniformLocation(program, "base_color"), 1, &base_color.x);
    glVertexAttrib4f(13, 1.0F, 1.0F, 1.0F, 1.0F);  // shaders/mesh.vert: vertices have no colours of their own
    weights = glGetUniformLocation(program, "weights");
  }

  BareTimes picture(float u) {
    BareTimes times;
    auto clock = std::chrono::steady_clock::now();
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glUniform4f(weights, 1.0F - u, u, 0.0F, 0.0F);
    glDrawElements(GL_TRIANGLES, index_count, GL_UNSIGNED_INT, nullptr);
    glFinish();
    times.draw_ms = ms_since(clock);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    times.read_ms = ms_since(clock);
    unsigned char* out = file.data();
    auto bytes = static_cast<unsigned long>(file.size());
    if (tjCompress2(jpeg, pixels.data(), width, 0, height, TJPF_RGBX, &out, &bytes, TJSAMP_420, 80,
                    TJFLAG_BOTTOMUP | TJFLAG_NOREALLOC) != 0) {
      give_up("the bare loop could not encode");
    }
    times.encode_ms = ms_since(clock);
    return times;
  }

  const int width, height;
  const GLsizei index_count;
  const glm::vec3 background;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  GLint weights = -1;
  tjhandle jpeg = tjInitCompress();
  std::vector<std::uint8_t> pixels;
  std::vector<std::uint8_t> file;
};

BareLoop::BareLoop(const BareScene& scene) : impl_(std::make_unique<Impl>(scene)) {}
BareLoop::~BareLoop() = default;

BareTimes BareLoop::picture(float u) { return impl_->picture(u); }

std::span<const std::uint8_t> BareLoop::pixels() const noexcept { return impl_->pixels; }

}  // namespace tweend::bench
