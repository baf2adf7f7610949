#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "server/assets/json_document.hpp"

namespace tweend::assets {

/// What of a file is passed over, a line each; past 16 they are counted only.
class GltfWarnings {
 public:
  /// `"arm.glb" /meshes/0: message`
  void add(const JsonNode& node, const std::string& message) {
    if (lines_.size() < kMost) {
      lines_.push_back(node.place() + ": " + message);
    } else {
      ++left_out_;
    }
  }
  [[nodiscard]] std::vector<std::string> take() {
    if (left_out_ > 0) lines_.push_back(fmt::format("and {} more like these", left_out_));
    return std::move(lines_);
  }

 private:
  static constexpr std::size_t kMost = 16;
  std::vector<std::string> lines_;
  std::size_t left_out_ = 0;
};

}  // namespace tweend::assets
