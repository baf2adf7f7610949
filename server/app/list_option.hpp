#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/result.hpp"

namespace tweend::app {

/// What stands between the separators; at least one piece, which may be empty.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

/// Finite numbers with a separator between them: "1280x720", "0,0.5,1". @return InvalidParams naming what is none
[[nodiscard]] Result<std::vector<double>> number_list(std::string_view text, char separator);

/// What the numbers of an option have to be.
struct ListShape {
  const char* form;  ///< as the help and the refusals show it: "WxH"
  char separator = ',';
  std::size_t least = 1;
  std::size_t most = std::numeric_limits<std::size_t>::max();
  std::function<bool(double)> fits = [](double) { return true; };
  const char* each = "a number";  ///< what `fits` demands, in words
};

/// An option of one argument that holds a list of numbers. CLI11's own lists take the arguments that follow, too many and
/// too few, and what is no number, each in some case.
CLI::Option* add_list(CLI::App& app, const std::string& name, const ListShape& shape, const std::string& help,
                      std::function<void(const std::vector<double>&)> take);

/// A validator: a finite number above zero.
[[nodiscard]] CLI::Validator finite_above_zero();

}  // namespace tweend::app
