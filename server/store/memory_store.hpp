#pragma once

#include <map>
#include <mutex>

#include "server/store/document_store.hpp"

namespace tweend::store {

/// Keeps documents for as long as the process lives.
class MemoryStore final : public DocumentStore {
 public:
  [[nodiscard]] Result<std::vector<model::ScenePtr>> load() override;
  [[nodiscard]] Status commit(std::span<const Commit> commits) override;

 private:
  std::mutex mutex_;
  std::map<std::string, model::ScenePtr> scenes_;
};

}  // namespace tweend::store
