#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "render/gl_handle.hpp"
#include "render/picture.hpp"

namespace tweend::render {

/// All keyframes of a mesh in one GPU buffer: a slot for each, written once. A picture only says which slots it binds, and
/// a keyframe that is added writes its own slot and nothing else. The context's thread only.
class KeyBuffer {
 public:
  /// @param slot_floats  of each keyframe's block
  /// @param most_bytes   beyond it the slot that was used least lately is written over; room for four there is always
  KeyBuffer(std::size_t slot_floats, std::size_t most_bytes);

  /// Where the keys' blocks begin, bytes; keys that are not there yet are written.
  /// @param keys      1 to 4, each of slot_floats
  /// @param expected  how many there will be: the first picture makes room for all
  [[nodiscard]] std::array<GLintptr, 4> place(std::span<const KeySource> keys, std::size_t expected);

  [[nodiscard]] GLuint name() const noexcept { return buffer_.name(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return slots_.size() * slot_bytes_; }
  /// How many keyframes have been written so far.
  [[nodiscard]] std::uint64_t uploads() const noexcept { return uploads_; }

 private:
  struct Slot {
    ResourceId id;
    std::uint64_t used = 0;  ///< the number of the picture that last bound it; 0: never, it is free
  };
  [[nodiscard]] std::uint32_t find_or_write(const KeySource& key);
  [[nodiscard]] std::uint32_t free_slot();
  void grow(std::size_t slots);

  const std::size_t slot_bytes_;
  const std::size_t most_slots_;
  GlBuffer buffer_;
  std::vector<Slot> slots_;
  std::map<ResourceId, std::uint32_t> slot_of_;
  std::uint64_t pictures_ = 0;
  std::uint64_t uploads_ = 0;
};

}  // namespace tweend::render
