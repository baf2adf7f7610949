#include "server/store/memory_store.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>

namespace tweend::store {
namespace {

model::ScenePtr scene(const char* name, std::uint64_t revision) {
  model::Scene s;
  s.name = name;
  s.revision = revision;
  return std::make_shared<const model::Scene>(std::move(s));
}

TEST(MemoryStore, KeepsTheLastCommitOfEachScene) {
  MemoryStore store;
  const std::array commits{Commit{"a", scene("a", 1), "x", "", ""}, Commit{"b", scene("b", 1), "x", "", ""},
                           Commit{"a", scene("a", 2), "x", "", ""}};
  ASSERT_TRUE(store.commit(commits));
  const auto loaded = store.load();
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded->size(), 2U);
  EXPECT_EQ((*loaded)[0]->revision, 2U);
}

TEST(MemoryStore, ForgetsRemovedScenes) {
  MemoryStore store;
  const std::array commits{Commit{"a", scene("a", 1), "x", "", ""}, Commit{"a", nullptr, "scene.remove", "", ""}};
  ASSERT_TRUE(store.commit(commits));
  EXPECT_TRUE(store.load()->empty());
}

}  // namespace
}  // namespace tweend::store
