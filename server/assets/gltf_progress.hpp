#pragma once

#include <cstddef>
#include <functional>
#include <utility>

namespace tweend::assets {

/// Takes how much of an import is done, 0 to 1, never falling; on the importing thread.
using ImportProgress = std::function<void(double fraction)>;

/// Counts the parts of a file that have been read.
class GltfProgress {
 public:
  /// @param tell   may be empty
  /// @param parts  there are
  GltfProgress(ImportProgress tell, std::size_t parts) : tell_(std::move(tell)), parts_(parts) {}

  void part_done() {
    ++done_;
    if (tell_ && parts_ > 0 && done_ <= parts_) tell_(static_cast<double>(done_) / static_cast<double>(parts_));
  }

 private:
  ImportProgress tell_;
  std::size_t parts_;
  std::size_t done_ = 0;
};

}  // namespace tweend::assets
