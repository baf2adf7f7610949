#include "server/commands/conversation.hpp"

#include <fmt/format.h>

#include <utility>

#include "server/commands/command_table.hpp"
#include "server/commands/timed_act.hpp"

namespace tweend::commands {
namespace {

/// Messages above this are parsed, decoded and printed on workers.
constexpr std::size_t kLargeJson = 64U << 10U;
/// Answers of a batch leave together: this is where they stop to grow.
constexpr std::size_t kBatchAnswerBytes = 64U << 20U;
/// What may wait before the connection stops reading.
constexpr std::size_t kQueuedMessages = 1'024;
constexpr std::size_t kQueuedBytes = 1U << 20U;

stage::EditOptions options_of(const Command& command, const void* params) {
  const EditTarget& target = command.target(params);
  return {scene_or_main(target.scene), std::string(command.name), target.base_revision, target.retry_key.value_or("")};
}

}  // namespace

Conversation::Conversation(const Services& services, Post to_network, std::shared_ptr<Peer> peer, Role role)
    : services_(services), to_network_(std::move(to_network)), peer_(std::move(peer)), role_(role) {}

void Conversation::receive(std::string text) {
  Unit& unit = units_.emplace_back();
  unit.number = next_unit_++;
  unit.bytes = text.size();
  queued_bytes_ += unit.bytes;
  const std::uint64_t number = unit.number;
  if (text.size() <= kLargeJson) {
    const protocol::Message message = protocol::parse_message(text, services_.limits);
    return parsed(number, message.batch, decode_items(message));
  }
  services_.workers.post([self = shared_from_this(), number, text = std::move(text)] {
    const protocol::Message message = protocol::parse_message(text, self->services_.limits);
    self->to_network_([self, number, batch = message.batch, items = decode_items(message)]() mutable {
      self->parsed(number, batch, std::move(items));
    });
  });
}

void Conversation::reject(const Error& error) {
  Unit& unit = units_.emplace_back();
  unit.number = next_unit_++;
  Item item;
  item.id = "null";
  item.refused = error;
  std::vector<Item> items;
  items.push_back(std::move(item));
  parsed(unit.number, false, std::move(items));
}

std::vector<Conversation::Item> Conversation::decode_items(const protocol::Message& message) {
  std::vector<Item> items;
  items.reserve(message.items.size());
  for (const auto& entry : message.items) {
    Item& item = items.emplace_back();
    if (const auto* rejected = std::get_if<protocol::Rejected>(&entry)) {
      item.id = rejected->id;
      item.refused = rejected->error;
      continue;
    }
    const auto& request = std::get<protocol::Request>(entry);
    item.id = request.id;
    item.command = find_command(request.method);
    if (item.command == nullptr) {
      item.refused =
          fail(ErrorCode::UnknownMethod,
               fmt::format("expected a method of this server, found \"{}\"; rpc.discover names them", request.method));
      continue;
    }
    auto params = decode_params(*item.command, request.params);
    if (params) {
      item.params = std::move(*params);
    } else {
      item.refused = params.error();
    }
  }
  return items;
}

bool Conversation::wants_more() const noexcept {
  return units_.size() < kQueuedMessages && queued_bytes_ < kQueuedBytes && !peer_->congested();
}

void Conversation::resume() {
  advance();
  if (progress_) progress_();
}

void Conversation::close() {
  closed_ = true;
  progress_ = {};
  services_.events.forget(peer_.get());
  if (const auto heard = services_.events.audience_change()) services_.stage.set_audience(*heard);
  for (const auto& [stream, open] : streams_) {
    add(services_.metrics.streams, -1);
    unsubscribe_later(stream, open.key);
  }
  streams_.clear();
  units_.clear();
  queued_bytes_ = 0;
}

void Conversation::unsubscribe_later(std::uint32_t stream, const streams::StreamKey& key) const {
  services_.stage.post([&hub = services_.hub, key, peer = peer_, stream] { hub.unsubscribe(key, peer.get(), stream); });
}

void Conversation::stream_ended(std::uint32_t stream, const std::string& reason) {
  const auto at = streams_.find(stream);
  if (at == streams_.end()) return;  // closed by the client meanwhile
  // It may still be read, where the client is cut off; or have gone on elsewhere while the word of its end was on its way.
  unsubscribe_later(stream, at->second.key);
  streams_.erase(at);
  add(services_.metrics.streams, -1);
  std::string params = fmt::format(R"({{"stream":{},"reason":)", stream);
  protocol::append_json_string(reason, params);
  params += '}';
  peer_->send_after_packets(std::make_shared<const std::string>(protocol::notification_json("stream.ended", params)));
}

void Conversation::move_to_rung(std::uint32_t stream, std::size_t rung) {
  const auto at = streams_.find(stream);
  auto* frames = at == streams_.end() ? nullptr : std::get_if<streams::FramesSpec>(&at->second.key.what);
  if (frames == nullptr || frames->rung == rung) return;
  const streams::StreamKey from = at->second.key;
  frames->rung = rung;
  if (!at->second.subscribed) return;
  services_.stage.post(
      [&hub = services_.hub, from, to = at->second.key, stream, sink = std::weak_ptr<streams::PacketSink>(peer_)] {
        hub.retune(from, to, {sink, stream});
      });
}

Conversation::Unit* Conversation::find_unit(std::uint64_t number) noexcept {
  if (units_.empty() || number < units_.front().number || number > units_.back().number) return nullptr;
  return &units_[number - units_.front().number];
}

void Conversation::parsed(std::uint64_t number, bool batch, std::vector<Item> items) {
  Unit* unit = find_unit(number);
  if (unit == nullptr) return;  // closed meanwhile
  unit->parsed = true;
  unit->batch = batch;
  unit->items = std::move(items);
  add(services_.metrics.requests_total, static_cast<std::int64_t>(unit->items.size()));
  // A ping that came alone waits for nothing, not even for its turn to be answered.
  if (!batch && unit->items.front().command != nullptr && unit->items.front().command->shape == Shape::Ping) {
    Item& item = unit->items.front();
    const QueryContext context{services_, nullptr, steady_now_us()};
    if (!item.refused && !item.id.empty()) {
      peer_->send(protocol::answer_json(item.id, *item.command->query(item.params.get(), context)));
      item.id.clear();
    }
  }
  advance();
}

void Conversation::advance() {
  if (advancing_) return;  // an answer that was ready at once: the loop below goes on
  advancing_ = true;
  while (!closed_) {
    Unit* unit = find_unit(cursor_.unit);
    if (unit == nullptr || !unit->parsed) break;
    if (cursor_.item == unit->items.size()) {
      cursor_ = {cursor_.unit + 1, 0};
      continue;
    }
    if (!may_start(unit->items[cursor_.item])) break;
    const ItemKey key = cursor_;
    ++cursor_.item;
    start(key);
    flush();
  }
  advancing_ = false;
}

bool Conversation::may_start(const Item& item) const noexcept {
  if (item.refused) return true;
  if (peer_->congested()) return false;
  switch (item.command->shape) {
    case Shape::Ping:
      return true;
    case Shape::Edit:
    case Shape::HeavyEdit:
    case Shape::SceneEdit:
      return !worker_busy_;
    case Shape::Players:
      return !worker_busy_ && outstanding_edits_ == 0;
    case Shape::Query:
    case Shape::WorkerQuery:
    case Shape::AsyncQuery:
    case Shape::Connection:
      // A heavy edit may be answered before its worker has said that it is done.
      return outstanding_ == 0 && !worker_busy_;
  }
  return false;
}

void Conversation::start(const ItemKey& key) {
  Item& item = find_unit(key.unit)->items[key.item];
  started(item.command != nullptr && !item.refused && item.command->is_edit());
  if (item.refused || item.command == nullptr) return finish(key, Result<std::string>(item.refused.value_or(Error{})));
  if (find_unit(key.unit)->answer_bytes > kBatchAnswerBytes) {
    return finish(
        key, Result<std::string>(
                 fail(ErrorCode::Limit, fmt::format("expected a batch with answers of at most {} bytes, found more; ask in "
                                                    "smaller batches",
                                                    kBatchAnswerBytes))));
  }
  if (item.command->role > role_) {
    return finish(
        key, Result<std::string>(fail(ErrorCode::Forbidden, fmt::format("expected the role {}, found {}",
                                                                        role_name(item.command->role), role_name(role_)))));
  }
  if (item.command->timed != nullptr && item.command->timed(item.params.get()).at_us) return start_timed(key, item);
  switch (item.command->shape) {
    case Shape::Ping:
    case Shape::Query:
      return start_query(key, item);
    case Shape::WorkerQuery:
      return start_worker_query(key, item);
    case Shape::AsyncQuery:
      return start_async_query(key, item);
    case Shape::Edit:
    case Shape::HeavyEdit:
    case Shape::SceneEdit:
      return start_edit(key, item);
    case Shape::Players:
      return start_players(key, item);
    case Shape::Connection:
      return start_connection(key, item);
  }
}

void Conversation::started(bool edit) {
  ++outstanding_;
  if (edit) ++outstanding_edits_;
}

void Conversation::start_query(const ItemKey& key, Item& item) {
  const QueryContext context{services_, services_.stage.view(), steady_now_us()};
  finish(key, item.command->query(item.params.get(), context));
}

void Conversation::start_worker_query(const ItemKey& key, Item& item) {
  worker_busy_ = true;
  services_.workers.post([self = shared_from_this(), key, id = item.id, command = item.command, params = item.params,
                          view = services_.stage.view(), now_us = steady_now_us()] {
    // Printed here to the last brace: a large answer costs the network thread nothing but a pointer.
    Answer answer = print(id, command->query(params.get(), QueryContext{self->services_, view, now_us}));
    self->to_network_([self, key, answer = std::move(answer)]() mutable {
      self->worker_busy_ = false;
      self->finish(key, std::move(answer));
    });
  });
}

void Conversation::start_async_query(const ItemKey& key, Item& item) {
  const QueryContext context{services_, services_.stage.view(), steady_now_us()};
  item.command->async_query(
      item.params.get(), context, [self = shared_from_this(), key, id = item.id](const Result<std::string>& result) {
        Answer answer = print(id, result);
        self->to_network_([self, key, answer = std::move(answer)]() mutable { self->finish(key, std::move(answer)); });
      });
}

void Conversation::start_edit(const ItemKey& key, Item& item) {
  const Command& command = *item.command;
  if (command.shape == Shape::SceneEdit) {
    return command.scene_edit(
        item.params.get(), services_, options_of(command, item.params.get()),
        [self = shared_from_this(), key](Result<std::string> result) { self->finish_later(key, std::move(result)); });
  }
  const auto scratch = std::make_shared<EditScratch>();
  const ClockUs now_us = steady_now_us();
  if (command.shape == Shape::Edit) return plan_on_strand(key, command, item.params, scratch, now_us);
  // Files are read, normals computed and contents hashed on a worker, against the newest head; the strand finds the results
  // in the scratch and plans again in no time. Whatever this first plan says of errors, the second one decides.
  worker_busy_ = true;
  services_.workers.post([self = shared_from_this(), key, &command, params = item.params, scratch, now_us] {
    const std::string scene = scene_or_main(command.target(params.get()).scene);
    if (const model::ScenePtr head = self->services_.stage.head(scene)) {
      stage::Transaction rehearsal(*head);
      EditContext context{self->services_, rehearsal, *scratch, "", self->services_.stage.view()->find(scene), now_us};
      static_cast<void>(command.edit(params.get(), context));
    }
    self->plan_on_strand(key, command, params, scratch, now_us);
    self->to_network_([self] {
      self->worker_busy_ = false;
      self->advance();
    });
  });
}

void Conversation::plan_on_strand(const ItemKey& key, const Command& command, Params params,
                                  std::shared_ptr<EditScratch> scratch, ClockUs now_us) {
  stage::EditOptions options = options_of(command, params.get());
  const std::string scene = options.scene;
  const auto plan = [self = shared_from_this(), &command, params = std::move(params), scratch = std::move(scratch), scene,
                     now_us](stage::Transaction& transaction) {
    EditContext context{self->services_, transaction, *scratch, "", self->services_.stage.view()->find(scene), now_us};
    return command.edit(params.get(), context);
  };
  services_.stage.edit(std::move(options), plan, [self = shared_from_this(), key](Result<std::string> result) {
    self->finish_later(key, std::move(result));
  });
}

void Conversation::start_players(const ItemKey& key, Item& item) {
  const auto change = [command = item.command, params = item.params](const stage::PlayersTurn& turn) {
    return command->players(params.get(), turn);
  };
  const auto done = [self = shared_from_this(), key, command = item.command](Result<stage::PlayersAnswer> answer) {
    if (!answer) return self->finish_later(key, answer.error());
    self->finish_later(key, command->players_answer(*answer));
  };
  services_.stage.change_players(item.command->players_scene(item.params.get()), change, done);
}

void Conversation::start_timed(const ItemKey& key, Item& item) {
  const auto act = timed_act(*item.command, item.params, services_);
  if (!act) return finish(key, Result<std::string>(act.error()));
  const Timed& timed = item.command->timed(item.params.get());
  const auto answer = [](stage::ScheduledId id, ClockUs at_us) { return protocol::encode(ScheduledResult{id, at_us}); };
  services_.stage.schedule(
      timed_scene(*item.command, item.params), std::string(item.command->name), {*timed.at_us, timed.late == Late::Error}, *act,
      answer, [self = shared_from_this(), key](Result<std::string> result) { self->finish_later(key, std::move(result)); });
}

void Conversation::start_connection(const ItemKey& key, Item& item) {
  if (!peer_->can_push()) {
    return finish(
        key, Result<std::string>(fail(ErrorCode::InvalidRequest,
                                      fmt::format("expected {} on line JSON or a WebSocket, found it on a single HTTP request",
                                                  item.command->name))));
  }
  item.command->connection(item.params.get(), shared_from_this(), [self = shared_from_this(), key](ConnectionAnswer answer) {
    self->finish(key, answer.result, std::move(answer.afterwards));
  });
}

void Conversation::finish_later(const ItemKey& key, Result<std::string> result) {
  to_network_([self = shared_from_this(), key, result = std::move(result)] { self->finish(key, result); });
}

Conversation::Answer Conversation::print(const std::string& id, const Result<std::string>& result) {
  if (id.empty()) return {{}, !result};  // a notification is not answered
  return {result ? protocol::answer_json(id, *result) : protocol::answer_json(id, result.error()), !result};
}

void Conversation::finish(const ItemKey& key, const Result<std::string>& result, Task afterwards) {
  if (closed_ || find_unit(key.unit) == nullptr) return;
  finish(key, print(find_unit(key.unit)->items[key.item].id, result), std::move(afterwards));
}

void Conversation::finish(const ItemKey& key, Answer answer, Task afterwards) {
  Unit* unit = find_unit(key.unit);
  if (closed_ || unit == nullptr) return;
  Item& item = unit->items[key.item];
  --outstanding_;
  if (item.command != nullptr && !item.refused && item.command->is_edit()) --outstanding_edits_;
  if (answer.failed) add(services_.metrics.request_errors_total);
  item.text = std::move(answer.text);
  unit->answer_bytes += item.text.size();
  item.afterwards = std::move(afterwards);
  item.params.reset();
  ++unit->answered;
  flush();
  advance();
  if (progress_) progress_();
}

void Conversation::flush() {
  while (!closed_ && !units_.empty()) {
    Unit& unit = units_.front();
    if (!unit.parsed || unit.answered < unit.items.size()) return;
    std::string text;
    std::vector<Task> afterwards;
    for (Item& item : unit.items) {
      if (item.afterwards) afterwards.push_back(std::move(item.afterwards));
      if (item.text.empty()) continue;
      if (!unit.batch) {
        text = std::move(item.text);
        continue;
      }
      text += text.empty() ? '[' : ',';
      text += item.text;
    }
    if (unit.batch && !text.empty()) text += ']';
    queued_bytes_ -= unit.bytes;
    if (cursor_.unit == unit.number) cursor_ = {unit.number + 1, 0};
    units_.pop_front();
    if (!text.empty()) peer_->send(std::move(text));
    for (const Task& task : afterwards) task();
  }
}

}  // namespace tweend::commands
