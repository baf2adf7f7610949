// A packet for many readers, from the mailbox to the sockets as the server does it, beside the least that can be done: one
// `send` of the ready bytes for each of the same sockets in a bare loop that asks epoll where a socket is full. The readers
// live in a process of their own, on loopback. Counted is what the sending thread computes, in turn with the bare loop's.
// The readers have one processor, the sender has the other, as if they were other machines: left to itself the kernel now
// and then lets a reader wait for the sender's processor, and then no send pays for waking anybody.

#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "bench/support/draining_process.hpp"
#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"
#include "server/net/connection.hpp"
#include "server/streams/mailbox.hpp"

namespace {

using namespace tweend;

constexpr std::uint32_t kNewest = 1;  // this stream skips where it must, which here is never
constexpr std::uint32_t kEvery = 2;

double thread_cpu_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

std::byte payload_byte(std::size_t i) { return static_cast<std::byte>((i * 31 + (i >> 8U)) & 0xFFU); }

/// Readers that speak one framing, and both ways to reach them.
class Audience {
 public:
  Audience(net::Framing framing, std::size_t readers, bench::DrainingProcess& drain)
      : framing_(framing), drain_(drain), mailbox_([this](Task task) { boost::asio::post(io_, std::move(task)); }, metrics_) {
    poll_ = ::epoll_create1(EPOLL_CLOEXEC);
    for (const int end : drain.connect(readers)) {
      net::Tcp::socket socket(io_, net::Tcp::v4(), end);
      net::tune_socket(socket);
      connections_.push_back(std::make_shared<net::Connection>(std::move(socket), framing, metrics_));
      connections_.back()->expect_stream(kNewest, {});
      connections_.back()->expect_stream(kEvery, {.every = true});
      epoll_event event{};
      event.events = 0;
      event.data.u64 = connections_.size() - 1;
      ::epoll_ctl(poll_, EPOLL_CTL_ADD, end, &event);
    }
  }
  ~Audience() { ::close(poll_); }
  Audience(const Audience&) = delete;
  Audience& operator=(const Audience&) = delete;

  /// From here on only the first so many listen, to packets of this size.
  void address(std::size_t readers, std::size_t payload_bytes) {
    readers_ = readers;
    payload_bytes_ = payload_bytes;
    for (const std::uint32_t stream : {kNewest, kEvery}) {
      auto list = std::make_shared<streams::Subscriptions>();
      for (std::size_t i = 0; i < readers; ++i) list->push_back({connections_[i], stream});
      (stream == kNewest ? to_newest_ : to_every_) = std::move(list);
    }
    message_ = expected(kNewest, 0);
  }

  /// Bytes of one packet on the wire, written down by the documents.
  [[nodiscard]] std::string expected(std::uint32_t stream, std::uint32_t sequence) const {
    const std::size_t size = protocol::kPacketHeaderBytes + payload_bytes_;
    std::string bytes;
    if (framing_ == net::Framing::Line) {
      bytes = fmt::format("{{\"jsonrpc\":\"2.0\",\"method\":\"stream.packet\",\"params\":{{\"stream\":{},\"bytes\":{}}}}}\n",
                          stream, size);
    } else {
      bytes = size > 0xFFFF ? "\x82\x7F" : "\x82\x7E";
      for (std::size_t byte = size > 0xFFFF ? 8 : 2; byte > 0; --byte) bytes += static_cast<char>(size >> (8 * (byte - 1)));
    }
    const protocol::PacketHeaderBytes header = protocol::encode_header(header_of(stream, sequence));
    bytes.append(reinterpret_cast<const char*>(header.data()), header.size());
    for (std::size_t i = 0; i < payload_bytes_; ++i) bytes += static_cast<char>(payload_byte(i));
    return bytes;
  }

  /// So many packets to each, all handed over at once. @return what the thread computed for each delivery, ns
  double serve(std::size_t packets) {
    const std::uint32_t stream = packets == 1 ? kNewest : kEvery;
    for (std::size_t i = 0; i < packets; ++i) made_.push_back(make(stream));
    const double begin = thread_cpu_ns();
    for (streams::PacketPtr& packet : made_) mailbox_.put({std::move(packet), stream == kNewest ? to_newest_ : to_every_});
    io_.restart();
    io_.poll();
    double ns = thread_cpu_ns() - begin;
    made_.clear();
    drain_.expect(packets * readers_ * message_.size());
    while (!drain_.done()) {
      const double from = thread_cpu_ns();
      io_.restart();
      if (io_.poll() > 0) ns += thread_cpu_ns() - from;
    }
    return ns / static_cast<double>(packets * readers_);
  }

  /// The bare loop: the same bytes to the same sockets.
  double send_bare() {
    const double begin = thread_cpu_ns();
    written_.assign(readers_, 0);
    for (std::size_t i = 0; i < readers_; ++i) send_rest(i);
    double ns = thread_cpu_ns() - begin;
    drain_.expect(readers_ * message_.size());
    epoll_event events[64];
    while (!drain_.done()) {
      const double from = thread_cpu_ns();
      const int ready = ::epoll_wait(poll_, events, 64, 0);
      for (int i = 0; i < ready; ++i) send_rest(events[i].data.u64);
      if (ready > 0) ns += thread_cpu_ns() - from;
    }
    return ns / static_cast<double>(readers_);
  }

  /// Ends the program unless all get what they should, in whichever way.
  void require_right_bytes(std::size_t first_reader) {
    constexpr std::size_t kWaiting = 3;
    drain_.keep(5 * message_.size());
    const std::uint32_t newest = sequence_[kNewest];
    serve(1);
    const std::uint32_t every = sequence_[kEvery];
    serve(kWaiting);
    send_bare();
    std::string right = expected(kNewest, newest);
    for (std::uint32_t i = 0; i < kWaiting; ++i) right += expected(kEvery, every + i);
    right += message_;
    for (std::size_t i = 0; i < readers_; ++i) {
      if (drain_.kept(first_reader + i) != right)
        bench::give_up(fmt::format("reader {} has got other bytes than it should", i));
    }
    drain_.keep(0);
    const std::int64_t sent = metrics_.packets_sent_total.load();
    if (sent != counted_ || metrics_.packets_skipped_total.load() != 0) {
      bench::give_up(fmt::format("expected {} packets to be counted as sent and none as skipped, found {}", counted_, sent));
    }
  }

 private:
  [[nodiscard]] protocol::PacketHeader header_of(std::uint32_t stream, std::uint32_t sequence) const {
    protocol::PacketHeader header;
    header.flags = protocol::kFlagKey;
    header.stream = stream;
    header.sequence = sequence;
    header.server_us = sequence + 1;
    header.payload_bytes = static_cast<std::uint32_t>(payload_bytes_);
    return header;
  }
  streams::PacketPtr make(std::uint32_t stream) {
    const streams::NewPacketPtr packet = pool_->take();
    if (packet->payload.bytes().size() != payload_bytes_) {
      const auto bytes = packet->payload.resize(payload_bytes_);
      for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = payload_byte(i);
    }
    packet->source = 1;
    packet->header = header_of(0, sequence_[stream]++);
    counted_ += static_cast<std::int64_t>(readers_);
    return packet;
  }
  void send_rest(std::size_t reader) {
    const int socket = connections_[reader]->socket().native_handle();
    const ssize_t sent =
        ::send(socket, message_.data() + written_[reader], message_.size() - written_[reader], MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0 && errno != EAGAIN) bench::give_up("a reader has gone");
    const bool waited = written_[reader] > 0;
    if (sent > 0) written_[reader] += static_cast<std::size_t>(sent);
    const bool waits = written_[reader] < message_.size();
    if (!waits && !waited) return;
    epoll_event event{};
    event.events = waits ? EPOLLOUT : 0U;
    event.data.u64 = reader;
    ::epoll_ctl(poll_, EPOLL_CTL_MOD, socket, &event);
  }

  const net::Framing framing_;
  bench::DrainingProcess& drain_;
  Metrics metrics_;
  boost::asio::io_context io_{1};
  streams::Mailbox mailbox_;
  std::shared_ptr<streams::PacketPool> pool_ = std::make_shared<streams::PacketPool>();
  std::vector<std::shared_ptr<net::Connection>> connections_;
  std::shared_ptr<const streams::Subscriptions> to_newest_, to_every_;
  std::vector<streams::PacketPtr> made_;
  std::size_t readers_ = 0;
  std::size_t payload_bytes_ = 0;
  std::uint32_t sequence_[3] = {0, 0, 0};
  std::int64_t counted_ = 0;
  std::string message_;
  std::vector<std::size_t> written_;
  int poll_ = -1;
};

struct Case {
  const char* name;
  std::size_t readers;
  std::size_t payload_bytes;
  std::size_t rounds;
  std::size_t ticks;  ///< a round
};

/// As in a server, both the sender and the readers have gone to sleep when the next packet comes.
constexpr std::chrono::milliseconds kBetweenTicks{1};
/// What is aimed at, of a bare send. A delivery costs some 0.2 us beside its system call.
constexpr double kMostOfASend = 1.1;
constexpr double kMostOfASendWaiting = 0.12;
constexpr std::size_t kMostReaders = 1000;
constexpr std::size_t kWaiting = 32;
constexpr Case kCases[] = {{"100 x 1 KiB", 100, 1024, 41, 12},
                           {"1000 x 1 KiB", 1000, 1024, 15, 2},
                           {"100 x 64 KiB", 100, 65536, 9, 3},
                           {"1000 x 64 KiB", 1000, 65536, 5, 1}};

/// Nanoseconds a delivery: 0 the server, 1 the server with 32 waiting, 2 the bare loop.
bench::Race race(Audience& audience, const Case& c) {
  bench::Race race{{{}, {}, {}}};
  const auto mean = [&c](auto tick) {
    tick();  // wakes what slept while the other was at it
    double ns = 0.0;
    for (std::size_t i = 0; i < c.ticks; ++i) {
      std::this_thread::sleep_for(kBetweenTicks);
      ns += tick();
    }
    return ns / static_cast<double>(c.ticks);
  };
  for (std::size_t round = 0; round < c.rounds; ++round) {
    race.ns_per_item[0].push_back(mean([&] { return audience.serve(1); }));
    race.ns_per_item[2].push_back(mean([&] { return audience.send_bare(); }));
    // More than a socket takes at once is not what waits for one write.
    if (c.payload_bytes * kWaiting <= std::size_t{64} << 10U) {
      race.ns_per_item[1].push_back(mean([&] { return audience.serve(kWaiting); }));
    }
  }
  return race;
}

/// Deliveries a second from the first byte to the last one read, one packet at a time.
double deliveries_per_s(Audience& audience, const Case& c) {
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < c.ticks; ++i) audience.serve(1);
  const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return static_cast<double>(c.ticks * c.readers) / s;
}

}  // namespace

/// Usage: bench_fan_out [CASE]
int main(int count, char** arguments) {
  const auto chosen = [&](const Case& c) { return count < 2 || std::string_view(arguments[1]) == c.name; };
  if (std::none_of(std::begin(kCases), std::end(kCases), chosen)) {
    std::string names;
    for (const Case& c : kCases) names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", c.name);
    bench::give_up(fmt::format("expected one of {}, or nothing for all of them, found \"{}\"", names, arguments[1]));
  }
  bench::pin_to_processor(1);  // the readers
  bench::DrainingProcess drain(2 * kMostReaders);
  bench::pin_to_processor(0);  // the sender
  struct Spoken {
    const char* name;
    std::size_t first_reader;
    std::unique_ptr<Audience> audience;
  };
  Spoken all[] = {{"line", 0, std::make_unique<Audience>(net::Framing::Line, kMostReaders, drain)},
                  {"websocket", kMostReaders, std::make_unique<Audience>(net::Framing::WebSocket, kMostReaders, drain)}};
  std::printf("fan-out on loopback, CPU time of the sending thread per delivery, us\n%-16s %-10s %9s %9s %9s %12s\n", "readers",
              "framing", "bare send", "server", "32 wait", "deliveries/s");
  std::vector<bench::Claim> claims;
  for (const Case& c : kCases) {
    if (!chosen(c)) continue;
    for (const Spoken& spoken : all) {
      Audience& audience = *spoken.audience;
      audience.address(c.readers, c.payload_bytes);
      audience.require_right_bytes(spoken.first_reader);
      const bench::Race found = race(audience, c);
      const bool waiting = !found.ns_per_item[1].empty();
      std::printf("%-16s %-10s %9.2f %9.2f %9.2f %12.0f   server / bare %.2f, 32 waiting / bare %.3f\n", c.name, spoken.name,
                  found.ns(2) * 1e-3, found.ns(0) * 1e-3, waiting ? found.ns(1) * 1e-3 : 0.0, deliveries_per_s(audience, c),
                  found.ratio(0, 2), waiting ? found.ratio(1, 2) : 0.0);
      std::fflush(stdout);
      if (c.readers != 100 || c.payload_bytes != 1024) continue;
      claims.push_back({fmt::format("fan_out_{}_100", spoken.name), found.ratio(0, 2), kMostOfASend});
      claims.push_back({fmt::format("fan_out_{}_32_waiting", spoken.name), found.ratio(1, 2), kMostOfASendWaiting});
    }
  }
  return bench::report(claims) ? 0 : 1;
}
