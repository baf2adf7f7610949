// How long a command takes on loopback, one at a time from idle. Waking sleeping threads is most of it on a virtual machine,
// so the baseline of each command is a bare echo that hands the bytes through as many threads: none for what the network
// thread answers itself, there and back through one for a turn on the stage, and through three (stage, store, stage) for an
// edit. The client has one processor, whatever answers has the other.

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"

namespace {

using tweend::bench::LineClient;

constexpr int kRounds = 300;
constexpr int kBatch =
    20;  // exchanges of a kind in a row; the first, which finds its server's thread fast asleep, is not counted

/// A thread that sleeps until it is given a number, and passes it on: the least that handing over can cost.
class Relay {
 public:
  explicit Relay(Relay* next) : next_(next), thread_([this] { run(); }) {}
  ~Relay() {
    give(-1);
    thread_.join();
  }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  void give(int value) {
    {
      const std::lock_guard lock(mutex_);
      value_ = value;
    }
    wake_.notify_one();
  }
  [[nodiscard]] int take() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return value_ != 0; });
    return std::exchange(value_, 0);
  }

 private:
  void run() {
    if (next_ == nullptr) return;  // the last one is waited for by its owner
    for (int value = 0; (value = take()) > 0;) next_->give(value);
  }
  Relay* next_;
  std::mutex mutex_;
  std::condition_variable wake_;
  int value_ = 0;
  std::thread thread_;
};

/// Answers every chunk of one connection with itself, after handing it through so many threads and back.
class Echo {
 public:
  explicit Echo(int threads) : listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    relays_.push_back(std::make_unique<Relay>(nullptr));
    for (int i = 0; i < threads; ++i) relays_.push_back(std::make_unique<Relay>(relays_.back().get()));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || ::listen(listener_, 1) != 0) {
      tweend::bench::give_up("the echo can't listen");
    }
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~Echo() {
    ::close(listener_);
    thread_.join();
    while (!relays_.empty()) relays_.pop_back();  // those that give before those that take
  }
  Echo(const Echo&) = delete;
  Echo& operator=(const Echo&) = delete;
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void run() const {
    const int client = ::accept(listener_, nullptr, nullptr);
    char chunk[65536];
    for (ssize_t got = 0; (got = ::recv(client, chunk, sizeof chunk, 0)) > 0;) {
      if (relays_.size() > 1) {
        relays_.back()->give(static_cast<int>(got));
        static_cast<void>(relays_.front()->take());
      }
      if (::send(client, chunk, static_cast<std::size_t>(got), MSG_NOSIGNAL) != got) break;
    }
    ::close(client);
  }
  int listener_;
  std::uint16_t port_ = 0;
  std::vector<std::unique_ptr<Relay>> relays_;
  std::thread thread_;
};

struct Exchange {
  const char* name;
  LineClient* client;
  std::string request;
  std::string_view expected;  ///< somewhere in the answer
  std::vector<double> us{};

  void run() {
    const auto start = std::chrono::steady_clock::now();
    const std::string_view answer = client->exchange(request);
    us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
    if (answer.find(expected) == std::string_view::npos) tweend::bench::give_up("wrong answer: " + std::string(answer));
  }
  [[nodiscard]] double percentile(double p) {
    std::sort(us.begin(), us.end());
    return us[static_cast<std::size_t>(p * static_cast<double>(us.size() - 1))];
  }
};

std::string request(const std::string& method, const std::string& params) {
  return R"({"jsonrpc":"2.0","id":7,"method":")" + method + R"(","params":)" + params + "}\n";
}

}  // namespace

int main() {
  tweend::bench::pin_to_processor(1);  // all that answers
  Echo echo(0), through_one(1), through_three(3);
  const tweend::bench::ServerProcess server;
  tweend::bench::pin_to_processor(0);  // the one who asks
  LineClient to_echo(echo.port()), to_one(through_one.port()), to_three(through_three.port()), to_server(server.port());
  const std::string mesh =
      R"({"actor":"a","mesh":{"positions":[0,0,0,1,0,0,0,1,0],"indices":[0,1,2]},"closed":true,"duration":9})";
  if (to_server.exchange(request("actor.add", mesh)).find("\"vertices\":3") == std::string_view::npos)
    tweend::bench::give_up("no actor");
  if (to_server.exchange(request("keyframe.add", R"({"capture":true})")).find("\"keyframe\":1") == std::string_view::npos) {
    tweend::bench::give_up("no keyframe");
  }
  const std::string ping = request("server.ping", "{}");
  Exchange exchanges[] = {{"bare echo", &to_echo, ping, "server.ping"},
                          {"echo through 1 thread", &to_one, ping, "server.ping"},
                          {"echo through 3 threads", &to_three, ping, "server.ping"},
                          {"server.ping", &to_server, ping, "\"time_us\":"},
                          {"playback.get", &to_server, request("playback.get", "{}"), "\"players\":[{"},
                          {"playback.seek", &to_server, request("playback.seek", R"({"time":0})"), "\"time\":0"},
                          {"actor.update", &to_server, request("actor.update", R"({"visible":true})"), "\"revision\":"}};
  for (int i = 0; i < 200; ++i) {
    for (Exchange& e : exchanges) e.run();
  }
  for (Exchange& e : exchanges) e.us.clear();
  for (int i = 0; i < kRounds; ++i) {
    for (Exchange& e : exchanges) {  // in turn: the machine's speed drifts
      e.run();
      e.us.pop_back();
      for (int k = 1; k < kBatch; ++k) e.run();
    }
  }
  std::printf("command round trip on loopback, %d of each, %d at a time in turn\n%-24s %10s %10s\n", kRounds * (kBatch - 1),
              kBatch - 1, "", "median us", "p99 us");
  for (Exchange& e : exchanges) std::printf("%-24s %10.1f %10.1f\n", e.name, e.percentile(0.5), e.percentile(0.99));
  const auto ratio = [&](int command, int echo_of) {
    return exchanges[command].percentile(0.5) / exchanges[echo_of].percentile(0.5);
  };
  return tweend::bench::report({{"round_trip_ping_vs_echo", ratio(3, 0), 1.2},
                                {"round_trip_get_vs_echo", ratio(4, 0), 1.2},
                                {"round_trip_seek_vs_echo_through_1", ratio(5, 1), 1.4},
                                {"round_trip_edit_vs_echo_through_3", ratio(6, 2), 1.5}})
             ? 0
             : 1;
}
