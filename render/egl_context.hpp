#pragma once

#include <memory>
#include <string>
#include <vector>

#include "server/base/result.hpp"

namespace tweend::render {

/// What became of one way to a GL context.
struct DeviceAttempt {
  std::string name;       ///< "device 0 (/dev/dri/card0)", "Mesa surfaceless"
  bool software = false;  ///< draws on the processor
  bool taken = false;
  std::string outcome;  ///< the renderer it gave, or why it was not taken
};

/// An OpenGL 4.5 core context without a display or a window, current on the thread that opened it until it goes.
/// One thread only.
class EglContext {
 public:
  /// Tries each GPU by the device platform, then Mesa's surfaceless platform.
  /// @param attempts  filled in whatever comes of it; may be null
  /// @return Unavailable naming every way that was tried and why it failed
  [[nodiscard]] static Result<std::unique_ptr<EglContext>> open(std::vector<DeviceAttempt>* attempts = nullptr);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5, Mesa surfaceless"
  [[nodiscard]] const std::string& description() const noexcept { return description_; }
  /// Whether it draws on the processor.
  [[nodiscard]] bool software() const noexcept { return software_; }

 private:
  EglContext() = default;
  friend class ContextOpener;
  void* display_ = nullptr;
  void* context_ = nullptr;
  bool software_ = false;
  std::string description_;
};

}  // namespace tweend::render
