#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/base/result.hpp"
#include "server/model/scene.hpp"

namespace tweend::store {

/// One accepted edit as it must survive.
struct Commit {
  std::string scene;      ///< its name
  model::ScenePtr after;  ///< the scene with the edit in it; null: the scene was removed
  std::string method;
  std::string retry_key;  ///< empty: none
  std::string answer;     ///< the result's JSON, for a repetition of retry_key
};

/// Where documents live. One thread (CommitQueue's) calls commit(); load() comes before the first commit.
class DocumentStore {
 public:
  virtual ~DocumentStore() = default;

  /// Every scene as the last commit left it.
  [[nodiscard]] virtual Result<std::vector<model::ScenePtr>> load() = 0;

  /// Makes all of them durable, in order, or none.
  /// @return Unavailable saying what stood in the way
  [[nodiscard]] virtual Status commit(std::span<const Commit> commits) = 0;
};

}  // namespace tweend::store
