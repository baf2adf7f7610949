#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl_handle.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

/// A stage's source: a `#version` line is put before, the parts follow each other.
using ShaderParts = std::vector<std::string_view>;

/// A linked program. The context's thread only.
class ShaderProgram {
 public:
  /// @param captured  outputs of the vertex stage that transform feedback writes, interleaved
  /// @return Internal with the driver's log: the sources are ours
  [[nodiscard]] static Result<ShaderProgram> link(const ShaderParts& vertex, const ShaderParts& fragment,
                                                  std::span<const char* const> captured = {});

  void use() const { glUseProgram(program_.name()); }
  /// Where a uniform is; -1, which setting ignores, if the program does not need it.
  [[nodiscard]] GLint location(const char* name) const { return glGetUniformLocation(program_.name(), name); }

  void set(GLint where, int value) const { glProgramUniform1i(program_.name(), where, value); }
  void set(GLint where, float value) const { glProgramUniform1f(program_.name(), where, value); }
  void set(GLint where, const glm::ivec3& v) const { glProgramUniform3iv(program_.name(), where, 1, &v.x); }
  void set(GLint where, const glm::vec2& v) const { glProgramUniform2fv(program_.name(), where, 1, &v.x); }
  void set(GLint where, const glm::vec3& v) const { glProgramUniform3fv(program_.name(), where, 1, &v.x); }
  void set(GLint where, const glm::vec4& v) const { glProgramUniform4fv(program_.name(), where, 1, &v.x); }
  void set(GLint where, const glm::mat3& m) const { glProgramUniformMatrix3fv(program_.name(), where, 1, GL_FALSE, &m[0].x); }
  void set(GLint where, const glm::mat4& m) const { glProgramUniformMatrix4fv(program_.name(), where, 1, GL_FALSE, &m[0].x); }

 private:
  GlProgram program_;
};

}  // namespace tweend::render
