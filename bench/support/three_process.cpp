#include "bench/support/three_process.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "bench/support/server_process.hpp"

namespace tweend::bench {
namespace {

const std::string kFolder = TWEEND_THREE_DIR;

}  // namespace

bool ThreeProcess::is_installed() {
  return std::filesystem::exists(kFolder + "/node_modules/three") && std::system("command -v node >/dev/null") == 0;
}

ThreeProcess::ThreeProcess(const std::string& script, const std::string& file) {
  int questions[2];
  int answers[2];
  if (::pipe(questions) != 0 || ::pipe(answers) != 0) give_up(std::strerror(errno));
  pid_ = ::fork();
  if (pid_ < 0) give_up(std::strerror(errno));
  if (pid_ == 0) {
    ::dup2(questions[0], STDIN_FILENO);
    ::dup2(answers[1], STDOUT_FILENO);
    for (const int end : {questions[0], questions[1], answers[0], answers[1]}) ::close(end);
    ::execlp("node", "node", (kFolder + "/" + script).c_str(), file.c_str(), nullptr);
    ::_exit(127);
  }
  ::close(questions[0]);
  ::close(answers[1]);
  to_ = ::fdopen(questions[1], "w");
  from_ = ::fdopen(answers[0], "r");
}

ThreeProcess::~ThreeProcess() {
  std::fclose(to_);  // the end of its input ends it
  std::fclose(from_);
  ::waitpid(pid_, nullptr, 0);
}

std::vector<double> ThreeProcess::ask(const std::string& line) {
  std::fprintf(to_, "%s\n", line.c_str());
  std::fflush(to_);
  std::vector<double> numbers;
  if (std::fgetc(from_) != '[') give_up("three.js did not answer: " + line);
  for (char separator = ','; separator == ',';) {
    double number = 0.0;
    if (std::fscanf(from_, "%lf%c", &number, &separator) != 2) give_up("three.js answered no list of numbers");
    numbers.push_back(number);
  }
  std::fgetc(from_);  // the end of the line
  return numbers;
}

}  // namespace tweend::bench
