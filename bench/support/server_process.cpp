#include "bench/support/server_process.hpp"

#include <sched.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>

#include "bench/support/loopback.hpp"

namespace tweend::bench {
namespace {

std::string beside_this_program(const char* name) {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
}

std::uint16_t wait_for_port(const std::string& file) {
  for (int tries = 0; tries < 1000; ++tries) {
    int port = 0;
    if (std::ifstream(file) >> port) return static_cast<std::uint16_t>(port);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  give_up("the server did not open its port within 10 s");
}

}  // namespace

void give_up(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::exit(1);
}

void pin_to_processor(unsigned processor) {
  if (std::thread::hardware_concurrency() < 2) return;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(processor, &set);
  ::sched_setaffinity(0, sizeof set, &set);
}

ServerProcess::ServerProcess() {
  std::string folder = (std::filesystem::temp_directory_path() / "tweend-bench-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) give_up("no temporary folder could be made");
  folder_ = folder;
  const std::string program = beside_this_program("tweend"), port_file = folder_ + "/port";
  const char* arguments[] = {program.c_str(), "serve",       "--no-auth",       "--listen",
                             "127.0.0.1:0",   "--port-file", port_file.c_str(), nullptr};
  // posix_spawn takes char* const[] for reasons of age; it changes nothing.
  if (::posix_spawn(&pid_, program.c_str(), nullptr, nullptr, const_cast<char* const*>(arguments), environ) != 0) {
    give_up("could not start " + program);
  }
  port_ = wait_for_port(port_file);
}

ServerProcess::~ServerProcess() {
  ::kill(pid_, SIGTERM);
  ::waitpid(pid_, nullptr, 0);
  std::filesystem::remove_all(folder_);
}

double ServerProcess::cpu_seconds() const {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &time) != 0) give_up("the server has ended");
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

LineClient::LineClient(std::uint16_t port) : socket_(connect_loopback(port)) {}

LineClient::~LineClient() { ::close(socket_); }

std::string_view LineClient::exchange(std::string_view line) {
  while (!line.empty()) {
    const ssize_t sent = ::send(socket_, line.data(), line.size(), MSG_NOSIGNAL);
    if (sent <= 0) give_up("the server closed the connection");
    line.remove_prefix(static_cast<std::size_t>(sent));
  }
  received_.clear();
  char chunk[65536];
  while (received_.empty() || received_.back() != '\n') {
    const ssize_t got = ::recv(socket_, chunk, sizeof chunk, 0);
    if (got <= 0) give_up("the server closed the connection");
    received_.append(chunk, static_cast<std::size_t>(got));
  }
  return received_;
}

}  // namespace tweend::bench
