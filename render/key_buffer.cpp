#include "render/key_buffer.hpp"

#include <algorithm>
#include <utility>

namespace tweend::render {
namespace {

/// A keyframe that so many pictures did not need has likely been replaced by an edit.
constexpr std::uint64_t kStalePictures = 1'000;

}  // namespace

KeyBuffer::KeyBuffer(std::size_t slot_floats, std::size_t most_bytes)
    : slot_bytes_(slot_floats * sizeof(float)), most_slots_(std::max<std::size_t>(4, most_bytes / slot_bytes_)) {}

std::array<GLintptr, 4> KeyBuffer::place(std::span<const KeySource> keys, std::size_t expected) {
  ++pictures_;
  const std::size_t wanted = std::min(std::max(expected, keys.size()), most_slots_);
  // Keyframes are added one at a time: doubling keeps the copies few.
  if (slots_.size() < wanted) grow(std::min(std::max(wanted, 2 * slots_.size()), most_slots_));
  // Those that are there come first: a slot that this picture binds is not given to another of its keys.
  for (const KeySource& key : keys) {
    if (const auto at = slot_of_.find(key.id); at != slot_of_.end()) slots_[at->second].used = pictures_;
  }
  std::array<GLintptr, 4> offsets{};
  for (std::size_t i = 0; i < keys.size(); ++i) offsets[i] = static_cast<GLintptr>(find_or_write(keys[i]) * slot_bytes_);
  return offsets;
}

std::uint32_t KeyBuffer::find_or_write(const KeySource& key) {
  if (const auto at = slot_of_.find(key.id); at != slot_of_.end()) return at->second;
  const std::uint32_t slot = free_slot();
  if (slots_[slot].used != 0) slot_of_.erase(slots_[slot].id);
  slots_[slot] = {key.id, pictures_};
  slot_of_[key.id] = slot;
  glNamedBufferSubData(buffer_.name(), static_cast<GLintptr>(slot * slot_bytes_), static_cast<GLsizeiptr>(slot_bytes_),
                       key.block.data());
  ++uploads_;
  return slot;
}

std::uint32_t KeyBuffer::free_slot() {
  const auto least = [this] {
    return static_cast<std::uint32_t>(
        std::min_element(slots_.begin(), slots_.end(), [](const Slot& a, const Slot& b) { return a.used < b.used; }) -
        slots_.begin());
  };
  const std::uint32_t slot = least();
  const bool stale = pictures_ - slots_[slot].used > kStalePictures;
  if (slots_[slot].used == 0 || stale || slots_.size() >= most_slots_) return slot;
  grow(std::min(slots_.size() * 2, most_slots_));
  return least();
}

void KeyBuffer::grow(std::size_t slots) {
  GlBuffer larger = GlBuffer::make();
  glNamedBufferStorage(larger.name(), static_cast<GLsizeiptr>(slots * slot_bytes_), nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (buffer_) {
    glCopyNamedBufferSubData(buffer_.name(), larger.name(), 0, 0, static_cast<GLsizeiptr>(bytes()));
  }
  buffer_ = std::move(larger);
  slots_.resize(slots);
}

}  // namespace tweend::render
