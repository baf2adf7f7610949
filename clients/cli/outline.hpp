#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's
class App;
}

namespace tweend::cli {

/// What may be written after a command: what a completion needs to know.
struct Outline {
  struct Option {
    std::string name;   ///< `--eye`, `-h`
    std::string shape;  ///< of its value (ValueKind::shape); empty: a flag
  };
  struct Argument {
    std::string shape;
    bool repeats = false;
  };
  std::string path;  ///< `scene create`; empty: the program itself
  std::vector<std::string> commands;
  std::vector<Option> options;
  std::vector<Argument> arguments;
};

/// The program and all its commands, each before those within it.
[[nodiscard]] std::vector<Outline> outline(const CLI::App& root);

}  // namespace tweend::cli
