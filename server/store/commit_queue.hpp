#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/store/document_store.hpp"

namespace tweend::store {

/// Group commit: one writer thread takes all edits that wait, makes them one commit, and reports them together.
///
/// A failed commit poisons its epoch: everything queued since was built on edits that are lost, and fails with it unwritten.
/// Whoever builds edits then starts again from what is durable, under a greater epoch.
class CommitQueue {
 public:
  /// A group, in the order it was queued, and how it ended.
  struct Group {
    std::vector<std::uint64_t> tickets;
    Status status;
  };
  /// Called on the writer thread, one group after another.
  using Report = std::function<void(Group)>;

  CommitQueue(DocumentStore& store, Report report);
  ~CommitQueue();  ///< stop()
  CommitQueue(const CommitQueue&) = delete;
  CommitQueue& operator=(const CommitQueue&) = delete;

  /// @param ticket  the caller's number for this edit, told by the report
  /// Safe from any thread; never waits for the disk.
  void push(std::uint64_t ticket, std::uint64_t epoch, Commit commit);

  /// Commits what waits, reports it, joins the thread. Nothing may be pushed after.
  void stop();

 private:
  struct Entry {
    std::uint64_t ticket;
    std::uint64_t epoch;
    Commit commit;
  };
  void run();
  void write(std::vector<Entry> entries);

  DocumentStore& store_;
  const Report report_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Entry> waiting_;
  bool stopping_ = false;
  std::uint64_t failed_epoch_ = 0;  ///< writer thread only; epochs count from 1
  Error failure_;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace tweend::store
