#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/store/document_store.hpp"

namespace tweend::test {

/// A store in memory whose disk can be held up and can fail. Safe from any thread.
class ControlledStore final : public store::DocumentStore {
 public:
  explicit ControlledStore(std::vector<model::ScenePtr> scenes = {}) {
    for (model::ScenePtr& scene : scenes) durable_[scene->name] = std::move(scene);
  }

  Result<std::vector<model::ScenePtr>> load() override {
    const std::lock_guard lock(mutex_);
    if (load_fails_) return fail(ErrorCode::Unavailable, "the disk can't be read");
    std::vector<model::ScenePtr> scenes;
    for (const auto& [name, scene] : durable_) scenes.push_back(scene);
    return scenes;
  }

  Status commit(std::span<const store::Commit> commits) override {
    std::unique_lock lock(mutex_);
    groups_.emplace_back(commits.begin(), commits.end());
    changed_.notify_all();
    changed_.wait(lock, [this] { return !held_; });
    if (failures_ > 0) {
      --failures_;
      return fail(ErrorCode::Unavailable, "the disk is full");
    }
    for (const store::Commit& c : commits) {
      if (c.after) {
        durable_[c.scene] = c.after;
      } else {
        durable_.erase(c.scene);
      }
    }
    return {};
  }

  /// From now on commits wait for release().
  void hold() {
    const std::lock_guard lock(mutex_);
    held_ = true;
  }
  void release() {
    {
      const std::lock_guard lock(mutex_);
      held_ = false;
    }
    changed_.notify_all();
  }
  /// So many of the next commits fail, counted when they are let go.
  void fail_next(std::size_t commits) {
    const std::lock_guard lock(mutex_);
    failures_ = commits;
  }
  void fail_load() {
    const std::lock_guard lock(mutex_);
    load_fails_ = true;
  }

  /// Waits until so many commits have begun, held ones included.
  void wait_for_commits(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return groups_.size() >= count; });
  }
  /// What each commit was asked to write.
  [[nodiscard]] std::vector<std::vector<store::Commit>> groups() const {
    const std::lock_guard lock(mutex_);
    return groups_;
  }
  /// Null: no such scene.
  [[nodiscard]] model::ScenePtr durable(const std::string& scene) const {
    const std::lock_guard lock(mutex_);
    const auto at = durable_.find(scene);
    return at == durable_.end() ? nullptr : at->second;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, model::ScenePtr> durable_;
  std::vector<std::vector<store::Commit>> groups_;
  std::size_t failures_ = 0;
  bool held_ = false;
  bool load_fails_ = false;
};

}  // namespace tweend::test
