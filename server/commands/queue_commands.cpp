#include <fmt/format.h>

#include "server/commands/command_table.hpp"
#include "server/commands/playback_targets.hpp"

namespace tweend::commands {
namespace {

struct EntryParams {
  static constexpr std::string_view kName = "QueueEntry";
  std::string clip;
  std::optional<stage::Loop> loop;
  std::optional<std::int64_t> repeat;
  std::optional<double> fade;
  static void describe(FieldList<EntryParams>& f) {
    using T = EntryParams;
    f.add<&T::clip>("clip", "Name of the clip; the whole of it is played.");
    f.add<&T::loop>("loop",
                    "What one repeat is: once (the default) and repeat run through it, ping_pong there and back. A clip "
                    "that fades out goes on by it: once holds its end.");
    f.add<&T::repeat>("repeat", "How often; 1 if left out.", {.min = 1.0, .max = 1e9});
    f.add<&T::fade>("fade", "Clock seconds in which it replaces the one before, linearly.", protocol::kNotNegative);
  }
};

struct QueueParams : PlayerTarget {
  static constexpr std::string_view kName = "QueueParams";
  std::vector<EntryParams> clips;
  static void describe(FieldList<QueueParams>& f) {
    add_timed_player_fields(f);
    f.add<&QueueParams::clips>("clips", "Played in this order; after the last one it has ended.");
  }
  [[nodiscard]] Status check() const {
    if (clips.empty()) return fail(ErrorCode::InvalidParams, "expected at least one clip, found none", "clips");
    return {};
  }
};

Result<std::vector<stage::QueueEntry>> entries_of(const QueueParams& p, const model::Actor& actor) {
  std::vector<stage::QueueEntry> entries;
  entries.reserve(p.clips.size());
  for (const EntryParams& e : p.clips) {
    if (!actor.find_clip(e.clip)) {
      Error error = no_such_clip(actor, e.clip);
      error.path = fmt::format("params.clips[{}].clip", entries.size());
      return error;
    }
    entries.push_back({e.clip, e.loop.value_or(stage::Loop::Once), e.repeat.value_or(1), e.fade.value_or(0.0)});
  }
  return entries;
}

Result<Concerned> queue(const QueueParams& p, const stage::PlayersTurn& turn) {
  if (p.clips.size() > turn.limits.queued_clips) {
    return fail(ErrorCode::Limit,
                fmt::format("expected at most {} clips in a queue, found {}", turn.limits.queued_clips, p.clips.size()),
                "params.clips");
  }
  return for_players(p.actor, turn, [&](PlayerOnClip& t) -> Status {
    TWEEND_ASSIGN(std::vector<stage::QueueEntry> entries, entries_of(p, t.actor));
    t.player.start_queue(t.actor, std::move(entries), turn.now_us);
    return {};
  });
}

}  // namespace

void add_queue_commands(std::vector<Command>& t) {
  t.push_back(players_command<&queue>("playback.queue", "Play clips one after another, without a gap."));
}

}  // namespace tweend::commands
