#include "tests/cli/child_process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

namespace tweend::cli::test {
namespace {

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  return ends;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::string& in) {
  std::vector<char*> arguments;
  for (const auto& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const auto input = make_pipe();
  const auto output = make_pipe();
  pid_ = fork();
  if (pid_ == 0) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(input[0], STDIN_FILENO);
    dup2(output[1], STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execvp(arguments.front(), arguments.data());
    _exit(127);
  }
  close(input[0]);
  close(output[1]);
  output_ = output[0];
  const bool written = write(input[1], in.data(), in.size()) == static_cast<ssize_t>(in.size());
  close(input[1]);
  if (pid_ < 0 || !written) throw std::runtime_error("can't run " + command.front());
}

ChildProcess::~ChildProcess() {
  close_output();
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    (void)wait();
  }
}

std::string ChildProcess::read_line() {
  std::string line;
  for (char c = 0; read(output_, &c, 1) == 1 && c != '\n';) line += c;
  return line;
}

std::string ChildProcess::read_all() {
  std::string all;
  for (char c = 0; read(output_, &c, 1) == 1;) all += c;
  return all;
}

void ChildProcess::send_signal(int signal) const { kill(pid_, signal); }

void ChildProcess::close_output() {
  if (output_ >= 0) close(output_);
  output_ = -1;
}

int ChildProcess::wait() {
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace tweend::cli::test
