#include "server/store/commit_queue.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/controlled_store.hpp"

namespace tweend::store {
namespace {

/// Collects what a queue reports.
class Reports {
 public:
  CommitQueue::Report taker() {
    return [this](CommitQueue::Group group) {
      const std::lock_guard lock(mutex_);
      for (const std::uint64_t ticket : group.tickets) (group.status ? done_ : failed_).push_back(ticket);
      ++groups_;
      changed_.notify_all();
    };
  }
  void wait_for_tickets(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return done_.size() + failed_.size() >= count; });
  }
  std::vector<std::uint64_t> done() {
    const std::lock_guard lock(mutex_);
    return done_;
  }
  std::vector<std::uint64_t> failed() {
    const std::lock_guard lock(mutex_);
    return failed_;
  }
  std::size_t groups() {
    const std::lock_guard lock(mutex_);
    return groups_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::uint64_t> done_, failed_;
  std::size_t groups_ = 0;
};

Commit commit(std::uint64_t ticket) { return {"main", nullptr, std::to_string(ticket), "", ""}; }

TEST(CommitQueue, WhatWaitsTogetherIsOneCommitInOrder) {
  test::ControlledStore disk;
  Reports reports;
  disk.hold();
  CommitQueue queue(disk, reports.taker());
  queue.push(1, 1, commit(1));
  disk.wait_for_commits(1);  // the writer is at the first one: all others wait
  for (std::uint64_t t = 2; t <= 50; ++t) queue.push(t, 1, commit(t));
  disk.release();
  reports.wait_for_tickets(50);
  std::vector<std::uint64_t> all;
  for (std::uint64_t t = 1; t <= 50; ++t) all.push_back(t);
  EXPECT_EQ(reports.done(), all);
  EXPECT_EQ(reports.groups(), 2U);
  ASSERT_EQ(disk.groups().size(), 2U);
  EXPECT_EQ(disk.groups()[1].size(), 49U);
  EXPECT_EQ(disk.groups()[1].front().method, "2");
}

TEST(CommitQueue, AFailurePoisonsItsEpochAndNoLaterOne) {
  test::ControlledStore disk;
  Reports reports;
  disk.hold();
  disk.fail_next(1);
  CommitQueue queue(disk, reports.taker());
  queue.push(1, 1, commit(1));
  disk.wait_for_commits(1);
  queue.push(2, 1, commit(2));  // built on an edit that is about to be lost
  disk.release();
  reports.wait_for_tickets(2);
  EXPECT_EQ(reports.failed(), (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(disk.groups().size(), 1U) << "the second was never written";

  queue.push(3, 1, commit(3));  // still of the lost epoch
  queue.push(4, 2, commit(4));
  reports.wait_for_tickets(4);
  EXPECT_EQ(reports.failed(), (std::vector<std::uint64_t>{1, 2, 3}));
  EXPECT_EQ(reports.done(), (std::vector<std::uint64_t>{4}));
}

TEST(CommitQueue, StoppingCommitsWhatWaits) {
  test::ControlledStore disk;
  Reports reports;
  {
    CommitQueue queue(disk, reports.taker());
    for (std::uint64_t t = 1; t <= 100; ++t) queue.push(t, 1, commit(t));
    queue.stop();
    EXPECT_EQ(reports.done().size(), 100U);
  }
}

TEST(CommitQueue, ManyThreadsMayPush) {
  test::ControlledStore disk;
  Reports reports;
  CommitQueue queue(disk, reports.taker());
  std::vector<std::thread> threads;
  for (std::uint64_t base = 0; base < 4; ++base) {
    threads.emplace_back([&queue, base] {
      for (std::uint64_t i = 1; i <= 250; ++i) queue.push(base * 250 + i, 1, commit(i));
    });
  }
  for (std::thread& t : threads) t.join();
  reports.wait_for_tickets(1000);
  const auto done = reports.done();
  EXPECT_EQ(std::set<std::uint64_t>(done.begin(), done.end()).size(), 1000U);
}

// Wherever the disk fails, what was reported done is on it, and nothing else.
TEST(CommitQueue, WhatIsReportedDoneIsWrittenWhereverTheDiskFails) {
  for (std::size_t failing = 0; failing < 6; ++failing) {
    test::ControlledStore disk;
    Reports reports;
    CommitQueue queue(disk, reports.taker());
    std::uint64_t epoch = 1;
    for (std::uint64_t t = 1; t <= 6; ++t) {
      if (t == failing + 1) disk.fail_next(1);
      queue.push(t, epoch, commit(t));
      reports.wait_for_tickets(t);
      if (!reports.failed().empty()) epoch = 2;
    }
    EXPECT_EQ(reports.failed(), (std::vector<std::uint64_t>{failing + 1}));
    EXPECT_EQ(reports.done().size(), 5U);
  }
}

// The writer is held up at commit N of a row, which then fails: all that has queued behind it falls with it, unwritten.
TEST(CommitQueue, EverythingBehindAFailureFallsWithItAndNothingBeforeIt) {
  for (std::uint64_t failing = 1; failing <= 5; ++failing) {
    test::ControlledStore disk;
    Reports reports;
    CommitQueue queue(disk, reports.taker());
    for (std::uint64_t t = 1; t < failing; ++t) {
      queue.push(t, 3, commit(t));
      reports.wait_for_tickets(t);
    }
    disk.hold();
    disk.fail_next(1);
    queue.push(failing, 3, commit(failing));
    disk.wait_for_commits(failing);
    for (std::uint64_t t = failing + 1; t <= 10; ++t) queue.push(t, 3, commit(t));
    queue.push(11, 4, commit(11));  // whoever builds edits has started again
    queue.push(12, 4, commit(12));
    disk.release();
    reports.wait_for_tickets(12);
    std::vector<std::uint64_t> lost, kept;
    for (std::uint64_t t = 1; t <= 12; ++t) (t < failing || t > 10 ? kept : lost).push_back(t);
    EXPECT_EQ(reports.failed(), lost);
    EXPECT_EQ(reports.done(), kept);
    std::vector<std::string> written;
    for (const auto& group : disk.groups()) {
      for (const Commit& c : group) written.push_back(c.method);
    }
    std::vector<std::string> asked;
    for (std::uint64_t t = 1; t <= failing; ++t) asked.push_back(std::to_string(t));
    asked.insert(asked.end(), {"11", "12"});
    EXPECT_EQ(written, asked) << "what fell was never written";
  }
}

TEST(CommitQueue, TellsEachOfTheLostWhy) {
  test::ControlledStore disk;
  disk.fail_next(1);
  std::vector<CommitQueue::Group> groups;
  {
    CommitQueue queue(disk, [&groups](CommitQueue::Group group) { groups.push_back(std::move(group)); });
    queue.push(1, 1, commit(1));
    disk.wait_for_commits(1);
    queue.push(2, 1, commit(2));
  }
  ASSERT_FALSE(groups.empty());
  for (const CommitQueue::Group& group : groups) {
    ASSERT_FALSE(group.status);
    EXPECT_EQ(group.status.error().code, ErrorCode::Unavailable);
    EXPECT_EQ(group.status.error().message, "the disk is full");
  }
}

TEST(CommitQueue, StoppingReportsWhatFailsWhileItStops) {
  test::ControlledStore disk;
  Reports reports;
  disk.hold();
  disk.fail_next(1);
  CommitQueue queue(disk, reports.taker());
  queue.push(1, 1, commit(1));
  disk.wait_for_commits(1);
  for (std::uint64_t t = 2; t <= 20; ++t) queue.push(t, 1, commit(t));
  disk.release();
  queue.stop();
  queue.stop();
  EXPECT_EQ(reports.failed().size(), 20U);
  EXPECT_TRUE(reports.done().empty());
}

}  // namespace
}  // namespace tweend::store
