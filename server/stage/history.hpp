#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/stage/change.hpp"

namespace tweend::stage {

/// The steps that can be taken back, or taken again: a value that shares its tail, so that a head and what is durable each
/// hold theirs for the price of a pointer.
class History {
 public:
  struct Step {
    std::string method;
    std::vector<Change> changes;  ///< what takes it back (or does it again)
    std::shared_ptr<const Step> below;

    Step(std::string m, std::vector<Change> c, std::shared_ptr<const Step> b)
        : method(std::move(m)), changes(std::move(c)), below(std::move(b)) {}
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;
    ~Step();  ///< one step after the other: a long chain would not fit on the stack
  };

  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Precondition: not empty.
  [[nodiscard]] const Step& top() const noexcept { return *top_; }

  /// With one more step on top; of more than `most`, the oldest are forgotten.
  [[nodiscard]] History pushed(std::string method, std::vector<Change> changes, std::size_t most) const;
  /// Without the top step. Precondition: not empty.
  [[nodiscard]] History popped() const;

 private:
  std::shared_ptr<const Step> top_;
  std::size_t count_ = 0;  ///< how many may be taken; the chain may be longer
  std::size_t chain_ = 0;  ///< how many are linked
};

}  // namespace tweend::stage
