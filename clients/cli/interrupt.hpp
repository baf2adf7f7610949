#pragma once

namespace tweend::cli {

/// While one lives, Ctrl-C does not end the program at once but sets a flag, so that what was begun is finished and summed up;
/// a second Ctrl-C ends it. One at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  [[nodiscard]] bool came() const noexcept;

 private:
  void (*before_)(int);
};

}  // namespace tweend::cli
