#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>

namespace tweend::bench {

/// What the bare loop draws: one mesh between two keyframes, each a block of positions and then normals.
struct BareScene {
  int width = 0;
  int height = 0;
  std::span<const std::uint32_t> indices;
  std::span<const float> key[2];
  glm::mat4 clip_from_world{1.0F};
  glm::vec3 eye{0.0F};
  glm::vec3 light_position{0.0F};
  glm::vec4 light_terms{0.0F};  ///< ambient, diffuse, specular, shininess
  glm::vec3 background{0.0F};   ///< linear
  glm::vec3 base_color{1.0F};   ///< linear
};

/// How long the steps of a picture took, milliseconds.
struct BareTimes {
  double draw_ms = 0.0;
  double read_ms = 0.0;
  double encode_ms = 0.0;
};

/// Pictures as one would write them down first, to know what the machine can do: a context, two buffers, and for each picture
/// clear, draw, finish, read, encode, one after the other. Shares the text of the shaders with tweend's renderer and nothing
/// else. The context is current on the thread that makes this, until it goes.
class BareLoop {
 public:
  explicit BareLoop(const BareScene& scene);
  ~BareLoop();
  BareLoop(const BareLoop&) = delete;
  BareLoop& operator=(const BareLoop&) = delete;

  /// A picture and its JPEG file.
  /// @param u  0: the first keyframe, 1: the second
  BareTimes picture(float u);
  /// RGBA, bottom row first, of the last picture.
  [[nodiscard]] std::span<const std::uint8_t> pixels() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tweend::bench
