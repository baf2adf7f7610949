#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <utility>

#include "server/stage/stage.hpp"

// The way of an edit: plan on the head, hand to the store, and when it is durable publish and answer.

namespace tweend::stage {
namespace {

/// Answers kept for repeated retry keys, a scene; the oldest are forgotten.
constexpr std::size_t kRetryAnswers = 4'096;

/// Players whose clip an edit has taken away.
std::vector<std::size_t> players_off_their_clip(const SceneViewPtr& before, const SceneView& after) {
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; before && i < after.players->size(); ++i) {
    const Player& player = (*after.players)[i];
    const Player* was = before->find_player(player.actor);
    if (was != nullptr && was->clip != player.clip) moved.push_back(i);
  }
  return moved;
}

Error no_such_scene(const std::string& scene) {
  return fail(ErrorCode::NotFound, fmt::format("expected the name of a scene, found \"{}\"; scene.list names them", scene),
              "params.scene");
}

}  // namespace

Result<Stage::Document*> Stage::find_head(const EditOptions& options) {
  const auto at = documents_.find(options.scene);
  if (at == documents_.end() || at->second.removed) return no_such_scene(options.scene);
  const std::uint64_t revision = at->second.head.scene->revision;
  if (options.base_revision && *options.base_revision != revision) {
    Error error = fail(ErrorCode::Conflict,
                       fmt::format("expected the scene at revision {}, found it at {}: look again, then repeat the edit",
                                   *options.base_revision, revision),
                       "params.base_revision");
    error.revision = revision;
    return error;
  }
  return &at->second;
}

bool Stage::answered_before(const EditOptions& options, const EditDone& done) {
  if (options.retry_key.empty()) return false;
  const auto book = retries_.find(options.scene);
  if (book == retries_.end()) return false;
  const auto found = book->second.answers.find(options.retry_key);
  if (found == book->second.answers.end()) return false;
  // The first request may still be on its way to the disk: whatever waits with the same key is answered after it.
  std::uint64_t first = 0;
  for (const auto& [ticket, pending] : pending_) {
    if (pending.scene == options.scene && pending.retry_key == options.retry_key) first = ticket;
  }
  if (first == 0) {
    done(found->second);
    return true;
  }
  EditDone& both = pending_.at(first).done;
  both = [one = std::move(both), two = done](const Result<std::string>& answer) {
    one(answer);
    two(answer);
  };
  return true;
}

void Stage::edit(EditOptions options, EditPlan plan, EditDone done) {
  boost::asio::post(io_, [this, options = std::move(options), plan = std::move(plan), done = std::move(done)] {
    this->plan(options, plan, done);
  });
}

void Stage::plan(const EditOptions& options, const EditPlan& plan, const EditDone& done) {
  if (answered_before(options, done)) return;
  const auto document = find_head(options);
  if (!document) return done(document.error());
  const State& head = (*document)->head;
  Transaction transaction(*head.scene);
  Result<std::string> answer = plan(transaction);
  if (!answer) return done(answer.error());
  State after{std::make_shared<const model::Scene>(transaction.scene()),
              head.undo.pushed(options.method, transaction.undo_changes(), limits_.undo_steps),
              {}};
  submit(options, **document, std::move(after), transaction.subject(), std::move(*answer), done, transaction.layer_fades());
}

void Stage::move_history(EditOptions options, HistoryMove move,
                         std::function<std::string(std::uint64_t, const std::string&)> answer, EditDone done) {
  boost::asio::post(io_, [this, options = std::move(options), move, answer = std::move(answer), done = std::move(done)] {
    if (answered_before(options, done)) return;
    const auto document = find_head(options);
    if (!document) return done(document.error());
    const State& head = (*document)->head;
    const bool undoing = move == HistoryMove::Undo;
    const History& from = undoing ? head.undo : head.redo;
    if (from.empty()) {
      return done(
          fail(ErrorCode::NotFound, undoing ? "expected an edit to undo, found none" : "expected an edit to redo, found none"));
    }
    const History::Step& step = from.top();
    Transaction transaction(*head.scene);
    for (const Change& change : step.changes) transaction.apply(change);
    const History& to = undoing ? head.redo : head.undo;
    State after{std::make_shared<const model::Scene>(transaction.scene()), from.popped(),
                to.pushed(step.method, transaction.undo_changes(), limits_.undo_steps)};
    if (!undoing) std::swap(after.undo, after.redo);
    std::string text = answer(transaction.revision(), step.method);
    submit(options, **document, std::move(after), {}, std::move(text), done);
  });
}

void Stage::create_scene(EditOptions options, std::function<std::string(std::uint64_t)> answer, EditDone done) {
  boost::asio::post(io_, [this, options = std::move(options), answer = std::move(answer), done = std::move(done)] {
    if (answered_before(options, done)) return;
    const auto at = documents_.find(options.scene);
    if (at != documents_.end() && !at->second.removed) {
      return done(
          fail(ErrorCode::Conflict, fmt::format("expected a new name, found the scene \"{}\"", options.scene), "params.scene"));
    }
    const auto scenes = std::count_if(documents_.begin(), documents_.end(), [](const auto& d) { return !d.second.removed; });
    if (static_cast<std::size_t>(scenes) >= limits_.scenes) {
      return done(
          fail(ErrorCode::Limit, fmt::format("expected at most {} scenes, found as many; remove one first", limits_.scenes)));
    }
    model::Scene scene;
    scene.name = options.scene;
    scene.revision = 1;
    Document& document = documents_[options.scene];
    document.removed = false;
    State after{std::make_shared<const model::Scene>(std::move(scene)), {}, {}};
    submit(options, document, std::move(after), {}, answer(1), done);
  });
}

void Stage::remove_scene(EditOptions options, std::function<std::string(std::uint64_t)> answer, EditDone done) {
  boost::asio::post(io_, [this, options = std::move(options), answer = std::move(answer), done = std::move(done)] {
    if (answered_before(options, done)) return;
    const auto document = find_head(options);
    if (!document) return done(document.error());
    const std::uint64_t revision = (*document)->head.scene->revision + 1;
    std::string text = answer(revision);
    remember_retry(options.scene, options.retry_key, text);
    (*document)->removed = true;
    publish_head_map();
    commit_later(
        {options.scene, {}, {options.scene, options.method, revision, {}}, options.retry_key, std::move(text), done, {}});
  });
}

void Stage::submit(const EditOptions& options, Document& document, State after, EditSubject subject, std::string answer,
                   EditDone done, std::vector<LayerFadeRequest> layer_fades) {
  document.head = after;
  publish_head_map();
  remember_retry(options.scene, options.retry_key, answer);
  const std::uint64_t revision = after.scene->revision;
  commit_later({options.scene,
                std::move(after),
                {options.scene, options.method, revision, std::move(subject)},
                options.retry_key,
                std::move(answer),
                std::move(done),
                std::move(layer_fades)});
}

void Stage::commit_later(Pending pending) {
  const std::uint64_t ticket = next_ticket_++;
  pending.epoch = epoch_;
  store::Commit commit{pending.scene, pending.after.scene, pending.event.method, pending.retry_key, pending.answer};
  pending_.emplace(ticket, std::move(pending));
  queue_->push(ticket, epoch_, std::move(commit));
}

void Stage::remember_retry(const std::string& scene, const std::string& key, const std::string& answer) {
  if (key.empty()) return;
  if (retries_.size() > 4 * limits_.scenes)
    std::erase_if(retries_, [this](const auto& b) { return !documents_.contains(b.first); });
  RetryBook& book = retries_[scene];
  book.answers[key] = answer;
  book.order.push_back(key);
  if (book.order.size() > kRetryAnswers) {
    book.answers.erase(book.order.front());
    book.order.pop_front();
  }
}

void Stage::forget_retry(const std::string& scene, const std::string& key) {
  if (key.empty()) return;
  RetryBook& book = retries_[scene];
  book.answers.erase(key);
  std::erase(book.order, key);
}

void Stage::committed(const store::CommitQueue::Group& group) {
  std::vector<Pending> entries;
  for (const std::uint64_t ticket : group.tickets) {
    auto node = pending_.extract(ticket);
    entries.push_back(std::move(node.mapped()));
  }
  if (group.status) {
    group_succeeded(std::move(entries));
  } else {
    group_failed(std::move(entries), group.status.error());
  }
}

void Stage::group_succeeded(std::vector<Pending> entries) {
  add(metrics_.commits_total);
  add(metrics_.edits_total, static_cast<std::int64_t>(entries.size()));
  const ClockUs now_us = steady_now_us();
  advance(now_us);  // what happens under the old document happens first
  // Of several edits of a scene in one group, only the last one's view is published: nobody can have seen the others.
  std::map<std::string, const State*> newest;
  std::map<std::string, std::vector<LayerFadeRequest>> layer_fades;
  for (const Pending& p : entries) {
    newest[p.scene] = &p.after;
    auto& fades = layer_fades[p.scene];
    fades.insert(fades.end(), p.layer_fades.begin(), p.layer_fades.end());
  }
  for (const auto& [name, after] : newest) {
    Document& document = documents_[name];
    if (!after->scene) {
      if (document.removed)
        documents_.erase(name);  // else: created again since
      else
        document.published = nullptr;
      publish(name, nullptr);
      forget_scheduled(name);
      continue;
    }
    document.durable = *after;
    const SceneViewPtr before = document.published;
    const auto players = players_for(*after->scene, before, now_us, layer_fades[name]);
    const auto view = std::make_shared<const SceneView>(SceneView{after->scene, players, next_serial_++});
    publish(name, view);
    if (const auto moved = players_off_their_clip(before, *view); !moved.empty()) {
      listener_->players_changed(view, moved, now_us);
    }
  }
  arm_timer();
  for (Pending& p : entries) {
    // Told first: whoever subscribes after the answer hears of nothing that came before.
    listener_->edited(p.event);
    p.done(std::move(p.answer));
  }
}

void Stage::group_failed(std::vector<Pending> lost, const Error& error) {
  add(metrics_.commit_failures_total);
  for (const Pending& p : lost) forget_retry(p.scene, p.retry_key);
  // Edits queued before this was known stand on the same lost heads; the queue fails them, and they come back here when
  // the heads have long been put right.
  if (lost.front().epoch == epoch_) drop_heads();
  for (const Pending& p : lost) {
    p.done(fail(ErrorCode::Unavailable, error.message.empty() ? std::string(phrase(ErrorCode::Unavailable)) : error.message));
  }
}

void Stage::drop_heads() {
  ++epoch_;
  for (auto at = documents_.begin(); at != documents_.end();) {
    Document& document = at->second;
    if (!document.published) {
      at = documents_.erase(at);
      continue;
    }
    document.head = document.durable;
    document.removed = false;
    ++at;
  }
  publish_head_map();
}

void Stage::publish_head_map() {
  auto heads = std::make_shared<HeadMap>();
  for (const auto& [name, document] : documents_) {
    if (!document.removed && document.head.scene) heads->emplace(name, document.head.scene);
  }
  heads_.store(std::move(heads));
}

}  // namespace tweend::stage
