#include "server/assets/open_beneath.hpp"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace tweend::assets {
namespace {

// The kernel answers EAGAIN when a rename elsewhere kept it from proving that ".." in a link stayed beneath.
constexpr int kAttempts = 16;

Opened opened(long fd) {
  if (fd < 0) return {Descriptor(), errno};
  return {Descriptor(static_cast<int>(fd)), 0};
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

Opened open_beneath(int root, const std::string& path, int flags) {
  open_how how{};
  how.flags = static_cast<unsigned>(flags | O_CLOEXEC);
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  for (int attempt = 1;; ++attempt) {
    Opened result = opened(::syscall(SYS_openat2, root, path.c_str(), &how, sizeof(how)));
    const int error = result.error;
    if (error == ENOSYS || error == EPERM) return open_beneath_by_steps(root, path, flags);
    if ((error != EAGAIN && error != EINTR) || attempt == kAttempts) return result;
  }
}

Opened open_beneath_by_steps(int root, const std::string& path, int flags) {
  Descriptor folder;
  std::size_t begin = 0;
  for (;;) {
    const int from = folder.is_open() ? folder.get() : root;
    const std::size_t slash = path.find('/', begin);
    const bool last = slash == std::string::npos;
    const std::string component = path.substr(begin, last ? slash : slash - begin);
    if (component.empty()) return {Descriptor(), ENOENT};
    if (component == "..") return {Descriptor(), EXDEV};
    const int step_flags = last ? flags : O_PATH | O_DIRECTORY;
    Opened step = opened(::openat(from, component.c_str(), step_flags | O_NOFOLLOW | O_CLOEXEC));
    if (last || !step.descriptor.is_open()) return step;
    folder = std::move(step.descriptor);
    begin = slash + 1;
  }
}

}  // namespace tweend::assets
