#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace tweend::model {

/// Something that is worked out of an immutable value when it is first asked for, once. A copy of the value starts without it,
/// so that a copy may be changed. Safe from any thread.
template <class T>
class Memo {
 public:
  Memo() : state_(std::make_unique<State>()) {}
  Memo(const Memo&) : Memo() {}
  Memo& operator=(const Memo&) {
    state_ = std::make_unique<State>();
    return *this;
  }
  ~Memo() = default;

  /// @param make  called by whoever asks first; must be a pure function of the value this belongs to
  template <class Make>
  [[nodiscard]] const T& get(Make&& make) const {
    std::call_once(state_->once, [&] { state_->value.emplace(std::forward<Make>(make)()); });
    return *state_->value;
  }

 private:
  struct State {
    std::once_flag once;
    std::optional<T> value;
  };
  std::unique_ptr<State> state_;
};

}  // namespace tweend::model
