#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "render/gl_handle.hpp"

namespace tweend::render {

/// Memory for what the GPU is told anew with each picture: palettes, weights, vertices of the moment. Buffers that stay mapped,
/// used in turn, so that one picture is written while the one before is still drawn. Only growing allocates.
/// The context's thread only.
class FrameMemory {
 public:
  static constexpr std::size_t kTexelBytes = 16;

  /// What take() gives.
  struct Piece {
    std::span<std::byte> memory;  ///< to be written before the draw; empty: the device has no memory left
    GLuint buffer = 0;
    GLintptr offset = 0;  ///< in the buffer, a multiple of 16
    GLuint rows = 0;      ///< a buffer texture over all of `buffer`: four floats a texel
    GLuint words = 0;     ///< the same: four integers a texel
    [[nodiscard]] GLint first_texel() const noexcept { return static_cast<GLint>(offset / GLintptr{kTexelBytes}); }
  };

  FrameMemory() = default;
  ~FrameMemory();
  FrameMemory(const FrameMemory&) = delete;
  FrameMemory& operator=(const FrameMemory&) = delete;

  /// Waits, should the GPU still be at the picture that used this turn's buffer; that is rare.
  void begin_picture();
  /// Pieces are good until the picture ends, `memory` until the next take().
  [[nodiscard]] Piece take(std::size_t bytes);
  /// All draws of the picture have been issued.
  void end_picture();

  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  struct Turn {
    GlBuffer buffer;
    GlTexture rows;
    GlTexture words;
    std::byte* mapped = nullptr;
    std::size_t size = 0;
    std::size_t used = 0;
    GLsync drawn = nullptr;  ///< behind the last draw that reads it
  };
  [[nodiscard]] static Turn make(std::size_t bytes);

  std::array<Turn, 3> turns_;
  std::size_t current_ = 0;
};

}  // namespace tweend::render
