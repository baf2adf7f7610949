#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>

namespace tweend::assets {

/// Gives out names, none twice.
class ExportNames {
 public:
  /// `wanted`, or where that is taken `wanted_2`, `wanted_3` …
  [[nodiscard]] std::string unique(const std::string& wanted);

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, std::size_t> next_;  ///< the number to try for a name
};

}  // namespace tweend::assets
