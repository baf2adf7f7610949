#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace tweend {

using Task = std::function<void()>;

/// Hands a task to some thread or queue; never runs it before returning. Safe from any thread.
using Post = std::function<void(Task)>;

/// Threads for import, evaluation, encoding and large JSON: whatever must not hold up the network or the stage.
class WorkerPool {
 public:
  explicit WorkerPool(std::size_t threads);
  ~WorkerPool();  ///< stop()
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Safe from any thread. Tasks may not throw.
  void post(Task task);
  /// Carries out what waits, joins. Nothing may be posted after.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tweend
