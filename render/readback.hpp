#pragma once

#include <atomic>
#include <boost/smart_ptr/intrusive_ptr.hpp>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "render/gl_handle.hpp"
#include "render/image_view.hpp"

namespace tweend::render {

class ReadbackPool;

/// Memory that the GPU writes a picture to and encoders read it from, without a copy between: mapped once, for good, and
/// used again. Shared as a PixelsPtr; goes back to its pool with its last reader, on whatever thread that is.
class Pixels {
 public:
  [[nodiscard]] ImageView view() const noexcept { return {size_, {bytes_, std::size_t{4} * size_.width * size_.height}}; }
  [[nodiscard]] GLuint buffer() const noexcept { return buffer_.name(); }

 private:
  friend class ReadbackPool;
  friend void intrusive_ptr_add_ref(const Pixels* pixels) noexcept;
  friend void intrusive_ptr_release(const Pixels* pixels) noexcept;
  mutable std::atomic<std::size_t> references_{0};
  GlBuffer buffer_ = GlBuffer::make();
  const std::byte* bytes_ = nullptr;
  std::size_t capacity_ = 0;
  Size size_;
  ReadbackPool* pool_ = nullptr;
};
using PixelsPtr = boost::intrusive_ptr<const Pixels>;

/// The pictures' memory. Made, asked and let go on the context's thread.
class ReadbackPool {
 public:
  ReadbackPool() = default;
  /// Waits until every picture has come back: their memory goes with the context.
  ~ReadbackPool();
  ReadbackPool(const ReadbackPool&) = delete;
  ReadbackPool& operator=(const ReadbackPool&) = delete;

  /// Room for a picture; null if the GPU has none.
  [[nodiscard]] PixelsPtr take(Size size);
  /// Lets go of what has come back beyond a few pictures.
  void trim();

 private:
  friend void intrusive_ptr_release(const Pixels* pixels) noexcept;
  void give_back(std::unique_ptr<Pixels> pixels);

  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<Pixels>> free_;
  std::size_t out_ = 0;
};

void intrusive_ptr_add_ref(const Pixels* pixels) noexcept;
void intrusive_ptr_release(const Pixels* pixels) noexcept;

}  // namespace tweend::render
