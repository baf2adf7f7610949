#include "render/frame_memory.hpp"

#include <algorithm>
#include <utility>

namespace tweend::render {
namespace {

constexpr std::size_t kLeastBytes = std::size_t{64} << 10U;

GlTexture view_of(const GlBuffer& buffer, GLenum format) {
  GlTexture view = GlTexture::make(GLenum{GL_TEXTURE_BUFFER});
  glTextureBuffer(view.name(), format, buffer.name());
  return view;
}

}  // namespace

FrameMemory::~FrameMemory() {
  for (const Turn& turn : turns_) {
    if (turn.drawn != nullptr) glDeleteSync(turn.drawn);
  }
}

void FrameMemory::begin_picture() {
  current_ = (current_ + 1) % turns_.size();
  Turn& turn = turns_[current_];
  turn.used = 0;
  if (turn.drawn == nullptr) return;
  glClientWaitSync(turn.drawn, GL_SYNC_FLUSH_COMMANDS_BIT, GL_TIMEOUT_IGNORED);
  glDeleteSync(std::exchange(turn.drawn, nullptr));
}

FrameMemory::Piece FrameMemory::take(std::size_t bytes) {
  Turn& turn = turns_[current_];
  // What earlier draws of this picture read lives on for them: the device keeps a buffer that is in use.
  if (turn.used + bytes > turn.size) turn = make(std::max({kLeastBytes, 2 * turn.size, bytes}));
  if (turn.mapped == nullptr) {
    turn = {};
    return {};
  }
  const std::size_t at = turn.used;
  turn.used += (bytes + kTexelBytes - 1) / kTexelBytes * kTexelBytes;
  return {{turn.mapped + at, bytes}, turn.buffer.name(), static_cast<GLintptr>(at), turn.rows.name(), turn.words.name()};
}

void FrameMemory::end_picture() {
  Turn& turn = turns_[current_];
  if (turn.used > 0) turn.drawn = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

FrameMemory::Turn FrameMemory::make(std::size_t bytes) {
  constexpr GLbitfield kAccess = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  Turn turn;
  turn.size = (bytes + kTexelBytes - 1) / kTexelBytes * kTexelBytes;
  turn.buffer = GlBuffer::make();
  glNamedBufferStorage(turn.buffer.name(), static_cast<GLsizeiptr>(turn.size), nullptr, kAccess);
  turn.mapped =
      static_cast<std::byte*>(glMapNamedBufferRange(turn.buffer.name(), 0, static_cast<GLsizeiptr>(turn.size), kAccess));
  turn.rows = view_of(turn.buffer, GL_RGBA32F);
  turn.words = view_of(turn.buffer, GL_RGBA32I);
  return turn;
}

std::size_t FrameMemory::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Turn& turn : turns_) bytes += turn.size;
  return bytes;
}

}  // namespace tweend::render
