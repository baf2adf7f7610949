#include "server/base/published.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace tweend {
namespace {

struct Pair {
  std::uint64_t number;
  std::uint64_t complement;  // ~number, or the value was torn
};

TEST(Published, ReadersKeepWhatTheyLoaded) {
  const auto first = std::make_shared<const int>(1);
  Published<int> published(first);
  const auto loaded = published.load();
  published.store(std::make_shared<const int>(2));
  EXPECT_EQ(loaded, first);
  EXPECT_EQ(*loaded, 1);
  EXPECT_EQ(*published.load(), 2);
}

TEST(Published, KeepsNoValueThatWasReplaced) {
  auto first = std::make_shared<const int>(1);
  const std::weak_ptr<const int> watch = first;
  Published<int> published(std::move(first));
  published.store(std::make_shared<const int>(2));
  EXPECT_TRUE(watch.expired());
}

TEST(Published, ReadersSeeWholeValuesInTheOrderTheyWereStored) {
  constexpr std::uint64_t kLast = 20'000;
  Published<Pair> published(std::make_shared<const Pair>(Pair{0, ~std::uint64_t{0}}));
  std::atomic<int> bad = 0;
  {
    std::vector<std::jthread> readers;
    for (int r = 0; r < 3; ++r) {
      readers.emplace_back([&] {
        for (std::uint64_t seen = 0; seen < kLast;) {
          const auto pair = published.load();
          if (pair->number < seen || pair->complement != ~pair->number) ++bad;
          seen = pair->number;
        }
      });
    }
    for (std::uint64_t i = 1; i <= kLast; ++i) published.store(std::make_shared<const Pair>(Pair{i, ~i}));
  }
  EXPECT_EQ(bad, 0);
}

/// Reads the published value while it is destroyed: with the lock still held that would never end.
struct Curious {
  Published<Curious>* published = nullptr;
  int* saw = nullptr;
  int number = 0;
  Curious(Published<Curious>* p, int* s, int n) : published(p), saw(s), number(n) {}
  Curious(const Curious&) = delete;
  Curious& operator=(const Curious&) = delete;
  ~Curious() {
    if (published != nullptr) *saw = published->load()->number;
  }
};

TEST(Published, DestroysTheOldValueOutsideTheLock) {
  int saw = 0;
  Published<Curious> published(nullptr);
  published.store(std::make_shared<const Curious>(&published, &saw, 1));
  published.store(std::make_shared<const Curious>(nullptr, nullptr, 2));
  EXPECT_EQ(saw, 2);
}

}  // namespace
}  // namespace tweend
