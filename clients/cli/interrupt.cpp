#include "clients/cli/interrupt.hpp"

#include <csignal>
#include <cstdlib>

#include "clients/cli/exit_code.hpp"

namespace tweend::cli {
namespace {

// A signal handler reaches nothing else.
volatile std::sig_atomic_t interrupted = 0;

void note(int) {
  if (interrupted != 0) std::_Exit(static_cast<int>(ExitCode::Interrupted));
  interrupted = 1;
}

}  // namespace

Interrupt::Interrupt() {
  interrupted = 0;
  before_ = std::signal(SIGINT, note);
}

Interrupt::~Interrupt() { std::signal(SIGINT, before_); }

bool Interrupt::came() const noexcept { return interrupted != 0; }

}  // namespace tweend::cli
