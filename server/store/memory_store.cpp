#include "server/store/memory_store.hpp"

namespace tweend::store {

Result<std::vector<model::ScenePtr>> MemoryStore::load() {
  const std::lock_guard lock(mutex_);
  std::vector<model::ScenePtr> scenes;
  for (const auto& [name, scene] : scenes_) scenes.push_back(scene);
  return scenes;
}

Status MemoryStore::commit(std::span<const Commit> commits) {
  const std::lock_guard lock(mutex_);
  for (const Commit& c : commits) {
    if (c.after) {
      scenes_[c.scene] = c.after;
    } else {
      scenes_.erase(c.scene);
    }
  }
  return {};
}

}  // namespace tweend::store
