#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>
#include <vector>

namespace tweend::bench {

/// three.js in a Node of its own, asked by lines.
class ThreeProcess {
 public:
  /// Whether Node and three.js are there; `./dev bench` sees to it.
  [[nodiscard]] static bool is_installed();
  /// @param script  in bench/three
  /// @param file    what the script is to work on
  ThreeProcess(const std::string& script, const std::string& file);
  ~ThreeProcess();
  ThreeProcess(const ThreeProcess&) = delete;
  ThreeProcess& operator=(const ThreeProcess&) = delete;

  /// The numbers that answer a line; see the scripts.
  [[nodiscard]] std::vector<double> ask(const std::string& line);

 private:
  pid_t pid_ = -1;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
};

}  // namespace tweend::bench
