#include "render/shader_program.hpp"

#include <string>
#include <utility>

namespace tweend::render {
namespace {

constexpr std::string_view kVersion = "#version 450 core\n";

std::string log_of(GLuint name, decltype(glGetShaderiv) get, decltype(glGetShaderInfoLog) read) {
  GLint size = 0;
  get(name, GL_INFO_LOG_LENGTH, &size);
  std::string log(static_cast<std::size_t>(size), '\0');
  read(name, size, nullptr, log.data());
  return log;
}

Result<GlShader> compile(GLenum stage, const ShaderParts& parts) {
  std::vector<const GLchar*> texts{kVersion.data()};
  std::vector<GLint> sizes{static_cast<GLint>(kVersion.size())};
  for (const std::string_view part : parts) {
    texts.push_back(part.data());
    sizes.push_back(static_cast<GLint>(part.size()));
  }
  GlShader shader = GlShader::make(stage);
  glShaderSource(shader.name(), static_cast<GLsizei>(texts.size()), texts.data(), sizes.data());
  glCompileShader(shader.name());
  GLint done = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
  if (done == GL_TRUE) return shader;
  return fail(ErrorCode::Internal,
              "expected a shader that compiles, found: " + log_of(shader.name(), glGetShaderiv, glGetShaderInfoLog));
}

}  // namespace

Result<ShaderProgram> ShaderProgram::link(const ShaderParts& vertex, const ShaderParts& fragment,
                                          std::span<const char* const> captured) {
  ShaderProgram linked;
  linked.program_ = GlProgram::make();
  const GLuint program = linked.program_.name();
  TWEEND_ASSIGN(const GlShader vertex_shader, compile(GL_VERTEX_SHADER, vertex));
  glAttachShader(program, vertex_shader.name());
  GlShader fragment_shader;
  if (!fragment.empty()) {
    TWEEND_ASSIGN(fragment_shader, compile(GL_FRAGMENT_SHADER, fragment));
    glAttachShader(program, fragment_shader.name());
  }
  if (!captured.empty()) {
    glTransformFeedbackVaryings(program, static_cast<GLsizei>(captured.size()), captured.data(), GL_INTERLEAVED_ATTRIBS);
  }
  glLinkProgram(program);
  GLint done = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done == GL_TRUE) return linked;
  return fail(ErrorCode::Internal,
              "expected a program that links, found: " + log_of(program, glGetProgramiv, glGetProgramInfoLog));
}

}  // namespace tweend::render
