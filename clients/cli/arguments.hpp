#pragma once

#include <nlohmann/json.hpp>

#include "clients/cli/json.hpp"

namespace tweend::cli {

/// What the arguments of a command said.
struct Arguments {
  Json params = Json::object();  ///< of the request
  Json own = Json::object();     ///< what only this program uses, by the names of own()

  [[nodiscard]] bool has(const char* name) const { return own.contains(name); }
  /// An own value, or what holds without it.
  template <class T>
  [[nodiscard]] T get(const char* name, T otherwise) const {
    return own.value(name, std::move(otherwise));
  }
};

}  // namespace tweend::cli
