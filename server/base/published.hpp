#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace tweend {

/// A value that one thread replaces and many read, always whole.
///
/// A lock is held for the copy of one pointer and nothing else. It stands here in place of
/// std::atomic<std::shared_ptr>, whose GCC 12 implementation ThreadSanitizer reports (its load
/// unlocks with relaxed order); swap it in when the toolchain allows, callers won't notice.
template <class T>
class Published {
 public:
  explicit Published(std::shared_ptr<const T> value) : value_(std::move(value)) {}

  [[nodiscard]] std::shared_ptr<const T> load() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

  void store(std::shared_ptr<const T> value) {
    {
      const std::lock_guard lock(mutex_);
      value_.swap(value);
    }
    // The old value, if this was its last owner, is destroyed here, outside the lock.
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const T> value_;
};

}  // namespace tweend
