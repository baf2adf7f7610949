#pragma once

#include <string>
#include <utility>

namespace tweend::assets {

/// A file descriptor that closes itself. Move-only.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) noexcept : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor();

  [[nodiscard]] int get() const noexcept { return fd_; }
  [[nodiscard]] bool is_open() const noexcept { return fd_ >= 0; }
  /// Hands the descriptor over; whoever takes it closes it.
  [[nodiscard]] int release() noexcept { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

/// What came of opening: a descriptor, or the errno that says why there is none.
struct Opened {
  Descriptor descriptor;
  int error = 0;
};

/// Opens `path` under the folder `root` and never anything outside of it, whatever symbolic links say and whoever
/// renames folders meanwhile: the kernel resolves the whole path beneath `root` (openat2).
/// Safe from any thread. Where the kernel or a seccomp filter has no openat2, open_beneath_by_steps does it.
/// @param path   relative; "." is the root itself
/// @param flags  as of open(2); O_CLOEXEC is added
/// @return EXDEV where the path would leave
[[nodiscard]] Opened open_beneath(int root, const std::string& path, int flags);

/// The same promise with openat alone, one component at a time, at the price of following no symbolic link at all:
/// links are refused with ELOOP or ENOTDIR, except that O_PATH opens a last component that is one as the link itself.
/// @param path  without "..", which could not be told from a way out
[[nodiscard]] Opened open_beneath_by_steps(int root, const std::string& path, int flags);

}  // namespace tweend::assets
