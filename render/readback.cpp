#include "render/readback.hpp"

#include <algorithm>
#include <utility>

#include "render/gl_error.hpp"

namespace tweend::render {
namespace {

/// What a pool keeps at most, the picture that was read last in any case: eight of 1280 × 720.
constexpr std::size_t kKept = 16;
constexpr std::size_t kKeptBytes = std::size_t{32} << 20U;

}  // namespace

ReadbackPool::~ReadbackPool() {
  std::unique_lock lock(mutex_);
  returned_.wait(lock, [this] { return out_ == 0; });
}

PixelsPtr ReadbackPool::take(Size size) {
  const std::size_t bytes = std::size_t{4} * size.width * size.height;
  std::unique_ptr<Pixels> pixels;
  {
    const std::lock_guard lock(mutex_);
    const auto fits = std::find_if(free_.begin(), free_.end(), [bytes](const auto& p) { return p->capacity_ == bytes; });
    if (fits != free_.end()) {
      pixels = std::move(*fits);
      free_.erase(fits);
    }
  }
  if (!pixels) {
    constexpr GLbitfield kMapping = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    pixels = std::make_unique<Pixels>();
    const auto size_bytes = static_cast<GLsizeiptr>(bytes);
    glNamedBufferStorage(pixels->buffer(), size_bytes, nullptr, kMapping | GL_CLIENT_STORAGE_BIT);
    pixels->bytes_ = static_cast<const std::byte*>(glMapNamedBufferRange(pixels->buffer(), 0, size_bytes, kMapping));
    if (pixels->bytes_ == nullptr) {
      static_cast<void>(take_gl_error());  // said by returning nothing
      return nullptr;
    }
    pixels->capacity_ = bytes;
  }
  pixels->size_ = size;
  pixels->pool_ = this;
  const std::lock_guard lock(mutex_);
  ++out_;
  return PixelsPtr(pixels.release());
}

void ReadbackPool::trim() {
  std::vector<std::unique_ptr<Pixels>> surplus;  // deleted behind the lock
  const std::lock_guard lock(mutex_);
  std::size_t kept = 0;
  for (const auto& pixels : free_) kept += pixels->capacity_;
  while (free_.size() > 1 && (free_.size() > kKept || kept > kKeptBytes)) {
    kept -= free_.front()->capacity_;
    surplus.push_back(std::move(free_.front()));
    free_.erase(free_.begin());
  }
}

void ReadbackPool::give_back(std::unique_ptr<Pixels> pixels) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(pixels));
  --out_;
  returned_.notify_all();  // under the lock: the pool may go as soon as it is let go
}

void intrusive_ptr_add_ref(const Pixels* pixels) noexcept { pixels->references_.fetch_add(1, std::memory_order_relaxed); }

void intrusive_ptr_release(const Pixels* pixels) noexcept {
  if (pixels->references_.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  pixels->pool_->give_back(std::unique_ptr<Pixels>(const_cast<Pixels*>(pixels)));
}

}  // namespace tweend::render
