#include "bench/support/draining_process.hpp"

#include <arpa/inet.h>
#include <sched.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include "bench/support/server_process.hpp"

namespace tweend::bench {
namespace {

constexpr std::size_t kMostKept = std::size_t{384} << 10U;

void raise_descriptor_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

/// In memory that both processes see.
struct DrainingProcess::Shared {
  std::atomic<std::uint64_t> read{0};
  std::atomic<std::size_t> keep{0};
  struct Reader {
    std::size_t kept;
    char bytes[kMostKept];
  };
  Reader readers[1];  // as many as were asked for; pages that are never touched cost nothing

  static std::size_t size(std::size_t most_readers) { return sizeof(Shared) + most_readers * sizeof(Reader); }

  void run(int orders, std::uint16_t port);
};

void DrainingProcess::Shared::run(int orders, std::uint16_t port) {
  const int poll = ::epoll_create1(0);
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = ~std::uint64_t{0};
  ::epoll_ctl(poll, EPOLL_CTL_ADD, orders, &event);
  std::vector<int> sockets;
  std::vector<char> chunk(std::size_t{1} << 20U);
  epoll_event events[256];
  for (;;) {
    const int ready = ::epoll_wait(poll, events, 256, -1);
    for (int i = 0; i < ready; ++i) {
      if (events[i].data.u64 == ~std::uint64_t{0}) {
        std::size_t more = 0;
        if (::read(orders, &more, sizeof more) != static_cast<ssize_t>(sizeof more)) ::_exit(0);  // the parent has gone
        for (; more > 0; --more) {
          sockaddr_in address{};
          address.sin_family = AF_INET;
          address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
          address.sin_port = htons(port);
          const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
          if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) ::_exit(1);
          event.data.u64 = sockets.size();
          sockets.push_back(socket);
          ::epoll_ctl(poll, EPOLL_CTL_ADD, socket, &event);
        }
        continue;
      }
      const std::size_t index = events[i].data.u64;
      const ssize_t got = ::recv(sockets[index], chunk.data(), chunk.size(), MSG_DONTWAIT);
      if (got <= 0) {
        if (got == 0) ::epoll_ctl(poll, EPOLL_CTL_DEL, sockets[index], nullptr);
        continue;
      }
      Reader& reader = readers[index];
      const std::size_t keeping = keep.load(std::memory_order_relaxed);
      const std::size_t kept = std::min(keeping - std::min(keeping, reader.kept), static_cast<std::size_t>(got));
      if (kept > 0) {
        std::memcpy(reader.bytes + reader.kept, chunk.data(), kept);
        reader.kept += kept;
      }
      read.fetch_add(static_cast<std::uint64_t>(got), std::memory_order_release);
    }
  }
}

DrainingProcess::DrainingProcess(std::size_t most_readers) : most_readers_(most_readers) {
  raise_descriptor_limit();
  void* const memory =
      ::mmap(nullptr, Shared::size(most_readers), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) give_up("no memory to share with the readers");
  shared_ = new (memory) Shared;
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || ::listen(listener_, 4096) != 0) {
    give_up("no listener for the readers");
  }
  ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
  int pipe[2];
  if (::pipe(pipe) != 0) give_up("no pipe to the readers");
  child_ = ::fork();
  if (child_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::close(pipe[1]);
    ::close(listener_);
    shared_->run(pipe[0], ntohs(address.sin_port));
    ::_exit(0);
  }
  ::close(pipe[0]);
  orders_ = pipe[1];
}

DrainingProcess::~DrainingProcess() {
  ::close(orders_);
  ::close(listener_);
  ::waitpid(child_, nullptr, 0);
  ::munmap(shared_, Shared::size(most_readers_));
}

std::vector<int> DrainingProcess::connect(std::size_t readers) {
  if (connected_ + readers > most_readers_) give_up("more readers than there is room for");
  std::vector<int> ends;
  for (; readers > 0; --readers) {
    // One at a time, so that both sides count them in the same order.
    const std::size_t one = 1;
    if (::write(orders_, &one, sizeof one) != static_cast<ssize_t>(sizeof one)) give_up("the readers have gone");
    const int end = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (end < 0) give_up("a reader could not be accepted");
    ends.push_back(end);
    ++connected_;
  }
  return ends;
}

bool DrainingProcess::done() const {
  const std::uint64_t read = shared_->read.load(std::memory_order_acquire);
  if (read > expected_) give_up("the readers have read more than was to be sent");
  if (read < expected_) ::sched_yield();
  return read == expected_;
}

void DrainingProcess::keep(std::size_t bytes) {
  shared_->keep = std::min(bytes, kMostKept);
  for (std::size_t i = 0; bytes > 0 && i < connected_; ++i) shared_->readers[i].kept = 0;
}

std::string DrainingProcess::kept(std::size_t index) const {
  const Shared::Reader& reader = shared_->readers[index];
  return {reader.bytes, reader.kept};
}

}  // namespace tweend::bench
