#include "server/store/commit_queue.hpp"

#include <iterator>
#include <utility>

namespace tweend::store {

CommitQueue::CommitQueue(DocumentStore& store, Report report)
    : store_(store), report_(std::move(report)), thread_([this] { run(); }) {}

CommitQueue::~CommitQueue() { stop(); }

void CommitQueue::push(std::uint64_t ticket, std::uint64_t epoch, Commit commit) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({ticket, epoch, std::move(commit)});
  }
  wake_.notify_one();
}

void CommitQueue::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void CommitQueue::run() {
  for (;;) {
    std::vector<Entry> taken;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      taken.swap(waiting_);
    }
    write(std::move(taken));
  }
}

void CommitQueue::write(std::vector<Entry> entries) {
  Group lost{{}, failure_};
  Group group{{}, {}};
  std::vector<Commit> commits;
  for (Entry& e : entries) {
    if (e.epoch <= failed_epoch_) {
      lost.tickets.push_back(e.ticket);
      continue;
    }
    group.tickets.push_back(e.ticket);
    commits.push_back(std::move(e.commit));
  }
  if (!commits.empty()) {
    group.status = store_.commit(commits);
    if (!group.status) {
      failed_epoch_ = entries.back().epoch;  // epochs never go down along the queue
      failure_ = group.status.error();
    }
  }
  if (!lost.tickets.empty()) report_(std::move(lost));
  if (!group.tickets.empty()) report_(std::move(group));
}

}  // namespace tweend::store
