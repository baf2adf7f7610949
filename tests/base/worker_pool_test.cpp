#include "server/base/worker_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <thread>
#include <vector>

namespace tweend {
namespace {

TEST(WorkerPool, RunsEveryTaskOnceOnItsOwnThreads) {
  constexpr int kThreads = 4, kEach = 250;
  std::vector<std::atomic<int>> runs(kThreads * kEach);
  std::latch done(kThreads * kEach);
  std::atomic<bool> on_a_callers_thread = false;
  WorkerPool pool(3);
  {
    std::vector<std::jthread> callers;
    for (std::size_t t = 0; t < kThreads; ++t) {
      callers.emplace_back([&, t] {
        const auto caller = std::this_thread::get_id();
        for (std::size_t i = 0; i < kEach; ++i) {
          pool.post([&, caller, i, t] {
            if (std::this_thread::get_id() == caller) on_a_callers_thread = true;
            ++runs[t * kEach + i];
            done.count_down();
          });
        }
      });
    }
  }
  done.wait();
  for (const auto& count : runs) EXPECT_EQ(count.load(), 1);
  EXPECT_FALSE(on_a_callers_thread);
}

TEST(WorkerPool, RunsAsManyTasksAtOnceAsItHasThreads) {
  std::latch all_started(3), done(3);
  WorkerPool pool(3);
  for (int i = 0; i < 3; ++i) {
    pool.post([&] {
      all_started.arrive_and_wait();  // none gets past unless all three run
      done.count_down();
    });
  }
  done.wait();
}

TEST(WorkerPool, RunsATaskPostedByATaskAfterIt) {
  std::latch done(1);
  bool outer_ended = false, in_order = false;
  WorkerPool pool(1);
  pool.post([&] {
    pool.post([&] {
      in_order = outer_ended;
      done.count_down();
    });
    outer_ended = true;
  });
  done.wait();
  EXPECT_TRUE(in_order);
}

TEST(WorkerPool, StopCarriesOutWhatRunsAndWhatWaits) {
  WorkerPool pool(1);
  std::latch started(1), go_on(1);
  int runs = 0;  // by the one worker, read after it was joined
  pool.post([&] {
    started.count_down();
    go_on.wait();
    ++runs;
  });
  started.wait();
  for (int i = 0; i < 100; ++i) pool.post([&runs] { ++runs; });
  go_on.count_down();
  pool.stop();
  EXPECT_EQ(runs, 101);
}

TEST(WorkerPool, MayBeStoppedTwiceAndIsStoppedByItsEnd) {
  std::atomic<int> runs = 0;
  {
    WorkerPool pool(2);
    pool.post([&runs] { ++runs; });
    pool.stop();
    pool.stop();
    EXPECT_EQ(runs, 1);
  }
  {
    WorkerPool pool(2);
    for (int i = 0; i < 50; ++i) pool.post([&runs] { ++runs; });
  }
  EXPECT_EQ(runs, 51);
}

TEST(WorkerPool, LetsGoOfWhatATaskHeldOnceItHasRun) {
  const auto held = std::make_shared<int>(7);
  WorkerPool pool(1);
  for (int i = 0; i < 10; ++i) pool.post([held] { EXPECT_EQ(*held, 7); });
  pool.stop();
  EXPECT_EQ(held.use_count(), 1);
}

}  // namespace
}  // namespace tweend
