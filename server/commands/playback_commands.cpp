#include <fmt/format.h>

#include "server/commands/command_table.hpp"
#include "server/commands/playback_targets.hpp"

namespace tweend::commands {
namespace {

using stage::PlayersTurn;

struct PlayersParams : PlayerTarget {
  static constexpr std::string_view kName = "PlayersParams";
  static void describe(FieldList<PlayersParams>& f) { add_timed_player_fields(f); }
};

struct GetParams {
  static constexpr std::string_view kName = "PlayersGetParams";
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  static void describe(FieldList<GetParams>& f) { add_player_fields(f); }
};

struct PlayParams : PlayerTarget {
  static constexpr std::string_view kName = "PlayParams";
  std::optional<std::string> clip;
  std::optional<double> time;
  std::optional<double> speed;
  std::optional<stage::Loop> loop;
  std::optional<double> fade;
  static void describe(FieldList<PlayParams>& f) {
    using T = PlayParams;
    add_timed_player_fields(f);
    f.add<&T::clip>("clip", "The clip to play; another one than before starts at its range's start (backwards: its end).");
    f.add<&T::time>("time", "Where to start, media seconds.");
    f.add<&T::speed>("speed", "Media seconds a clock second; negative: backwards.");
    f.add<&T::loop>("loop", "What happens at the range's end.");
    f.add<&T::fade>("fade", "Clock seconds in which the new clip replaces what is shown, linearly.", protocol::kNotNegative);
  }
};

struct SeekParams : PlayerTarget {
  static constexpr std::string_view kName = "SeekParams";
  double time = 0.0;
  static void describe(FieldList<SeekParams>& f) {
    add_timed_player_fields(f);
    f.add<&SeekParams::time>("time", "Media seconds; outside the range it is clamped (once) or wrapped.");
  }
};

struct StepParams : PlayerTarget {
  static constexpr std::string_view kName = "StepParams";
  std::optional<double> seconds;
  std::optional<std::int64_t> keyframes;
  static void describe(FieldList<StepParams>& f) {
    using T = StepParams;
    add_timed_player_fields(f);
    f.add<&T::seconds>("seconds", "By so many media seconds; negative: back.");
    f.add<&T::keyframes>("keyframes", "To the n-th next keyframe; negative: previous.");
  }
  [[nodiscard]] Status check() const {
    if (seconds.has_value() == keyframes.has_value()) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected seconds or keyframes, found {}", seconds ? "both" : "neither"),
                  seconds ? "keyframes" : "seconds");
    }
    return {};
  }
};

struct SetParams : PlayerTarget {
  static constexpr std::string_view kName = "PlayerSetParams";
  std::optional<double> speed;
  std::optional<stage::Loop> loop;
  Nullable<std::array<double, 2>> range;
  static void describe(FieldList<SetParams>& f) {
    using T = SetParams;
    add_timed_player_fields(f);
    f.add<&T::speed>("speed", "Media seconds a clock second; negative: backwards.");
    f.add<&T::loop>("loop", "What happens at the range's end.");
    f.add<&T::range>("range", "[in, out], media seconds; null: the whole clip, however it grows.", protocol::kNotNegative);
  }
};

Result<Concerned> play(const PlayParams& p, const PlayersTurn& turn) {
  return for_players(p.actor, turn, [&](PlayerOnClip& t) -> Status {
    const stage::Player before = t.player;
    if (p.loop) t.player.set_loop(t.range(), *p.loop, turn.now_us);
    if (p.speed) t.player.set_speed(t.range(), *p.speed, turn.now_us);
    if (p.clip) {
      const model::ClipPtr next = t.actor.find_clip(*p.clip);
      if (!next) return no_such_clip(t.actor, *p.clip);
      t.player.leave_queue(t.range(), turn.now_us);
      if (next != t.clip) {
        t.player.rebase(t.range(), turn.now_us);  // spin goes on through a change of clip
        t.player.change_clip(*next, turn.now_us);
        t.clip = next;
      }
    }
    if (p.time) t.player.seek(t.range(), *p.time, turn.now_us);
    t.player.play(t.range(), turn.now_us);
    const bool elsewhere = t.player.jumps != before.jumps;
    if (elsewhere && before.playing) ++t.player.starts;
    if (elsewhere && p.fade.value_or(0.0) > 0.0) t.player.fade_from(before, *p.fade, turn.now_us);
    return {};
  });
}

Result<Concerned> pause(const PlayersParams& p, const PlayersTurn& turn) {
  return for_players(p.actor, turn, [&](PlayerOnClip& t) -> Status {
    t.player.pause(t.range(), turn.now_us);
    return {};
  });
}

Result<Concerned> stop(const PlayersParams& p, const PlayersTurn& turn) {
  return for_players(p.actor, turn, [&](PlayerOnClip& t) -> Status {
    t.player.stop(t.range(), turn.now_us);
    return {};
  });
}

Result<Concerned> seek(const SeekParams& p, const PlayersTurn& turn) {
  return for_players(p.actor, turn, [&](PlayerOnClip& t) -> Status {
    t.player.seek(t.range(), p.time, turn.now_us);
    return {};
  });
}

Result<Concerned> step(const StepParams& p, const PlayersTurn& turn) {
  return for_players(p.actor, turn, [&](PlayerOnClip& t) -> Status {
    t.player.pause(t.range(), turn.now_us);
    const double here_s = t.player.read(t.range(), turn.now_us).time_s;
    const std::optional<double> there_s =
        p.seconds ? here_s + *p.seconds
                  : stage::step_keyframes(t.clip->times_s, t.range(), t.player.loop, here_s, *p.keyframes);
    if (there_s) t.player.seek(t.range(), *there_s, turn.now_us);
    return {};
  });
}

Result<Concerned> set(const SetParams& p, const PlayersTurn& turn) {
  return for_players(p.actor, turn, [&](PlayerOnClip& t) -> Status {
    if (p.loop) t.player.set_loop(t.range(), *p.loop, turn.now_us);
    if (p.speed) t.player.set_speed(t.range(), *p.speed, turn.now_us);
    if (!p.range) return {};
    if (!*p.range) {
      t.player.set_range(*t.clip, std::nullopt, turn.now_us);
      return {};
    }
    const auto [in_s, out_s] = **p.range;
    if (!(in_s < out_s && out_s <= t.clip->duration_s())) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected in < out within the {} s of the clip \"{}\", found [{}, {}]", t.clip->duration_s(),
                              t.clip->name, in_s, out_s),
                  "params.range");
    }
    t.player.set_range(*t.clip, stage::PlayRange{in_s, out_s}, turn.now_us);
    return {};
  });
}

Result<PlayersResult> get(const GetParams& p, const QueryContext& context) {
  const stage::SceneViewPtr view = context.view->find(scene_or_main(p.scene));
  if (!view) return no_such_scene(scene_or_main(p.scene));
  TWEEND_ASSIGN(const Concerned indices, concerned_players(*view->scene, p.actor));
  return players_result(*view, indices, context.now_us);
}

}  // namespace

void add_playback_commands(std::vector<Command>& t) {
  t.push_back(players_command<&play>("playback.play", "Let time run; after the end of a `once`, from the start again."));
  t.push_back(players_command<&pause>("playback.pause", "Hold the time."));
  t.push_back(players_command<&stop>("playback.stop", "Hold the time at the range's start."));
  t.push_back(players_command<&seek>("playback.seek", "Move the playhead."));
  t.push_back(players_command<&step>("playback.step", "Pause, then move by seconds or keyframes."));
  t.push_back(players_command<&set>("playback.set", "Change speed, loop or range."));
  t.push_back(query_command<&get>("playback.get", Role::View, "The players, as the answer's clock reading shows them."));
}

}  // namespace tweend::commands
