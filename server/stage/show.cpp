#include "server/stage/show.hpp"

#include <algorithm>

namespace tweend::stage {

const Player* SceneView::find_player(std::string_view actor) const noexcept {
  const auto at = std::find_if(players->begin(), players->end(), [actor](const Player& p) { return p.actor == actor; });
  return at == players->end() ? nullptr : &*at;
}

SceneViewPtr StageView::find(std::string_view scene) const noexcept {
  const auto at = scenes.find(scene);
  return at == scenes.end() ? nullptr : at->second;
}

namespace {

/// What fades out, oldest first, and the player's own clip over it.
void show_clips(const model::Actor& actor, const Player& player, ClockUs at_us, ActorShow& out) {
  float weight = 1.0F;  // of the first nobody asks
  for (const Fade& fade : player.fades) {
    const double progress = fade.progress(at_us);
    if (progress >= 1.0) {
      out.shown.clips.clear();  // replaced wholly, with all before it
    } else if (const model::ClipPtr clip = actor.find_clip(fade.from.clip)) {
      const double time_s = fade.from.read(fade.from.range_of(*clip), at_us).time_s;
      out.shown.clips.push_back({clip, time_s, weight});
      out.moving = true;
    }
    weight = static_cast<float>(progress);
  }
  out.shown.clips.push_back({out.clip, out.time_s, weight});
}

void show_layer(const model::Actor& actor, const model::Layer& layer, float weight, const PlayerReading& reading,
                ActorShow& out) {
  const model::ClipPtr clip = actor.find_clip(layer.clip);
  if (!clip || clip->keyframes.empty() || clip->type() != model::ClipType::Skeletal) return;
  const double duration_s = clip->duration_s();
  Lap lap = laps_of(reading.run_s, duration_s);
  if (duration_s <= 0.0) lap = {};
  // A held time may be the clip's end.
  if (!reading.playing && reading.run_s == duration_s) lap = {0.0, duration_s};
  // Mixed, not summed: wraps of several at once are several jumps.
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15U;
  if (!clip->settings.closed) out.continuity += kOdd * static_cast<std::uint64_t>(static_cast<std::int64_t>(lap.whole));
  if (weight <= 0.0F || out.shown.layers.size() == out.shown.layers.capacity()) return;
  out.shown.layers.push_back({clip, lap.rest, weight, layer.additive, layer.mask});
}

/// The actor's layers in the order of their names, each after what is left of the one it took the place of.
void show_layers(const model::Actor& actor, const Player& player, const PlayerReading& reading, ClockUs at_us, ActorShow& out) {
  auto layer = actor.layers.begin();
  const auto show_own_below = [&](const std::string* name) {
    for (; layer != actor.layers.end() && (name == nullptr || layer->name < *name); ++layer) {
      show_layer(actor, *layer, player.weight_of(*layer, at_us), reading, out);
    }
  };
  // Ghosts are few and lie in no order: each name in turn.
  const std::string* last = nullptr;
  for (;;) {
    const std::string* next = nullptr;
    for (const LayerFade& f : player.layer_fades) {
      if (f.ghost && (last == nullptr || *last < f.layer) && (next == nullptr || f.layer < *next)) next = &f.layer;
    }
    if (next == nullptr) break;
    show_own_below(next);
    for (const LayerFade& f : player.layer_fades) {
      if (!f.ghost || f.layer != *next) continue;
      const std::uint64_t continuity = out.continuity;
      show_layer(actor, *f.ghost, f.from_weight * static_cast<float>(1.0 - f.progress(at_us)), reading, out);
      out.continuity = continuity;  // it goes without a jump
    }
    last = next;
  }
  show_own_below(nullptr);
  for (const LayerFade& f : player.layer_fades) out.moving = out.moving || f.progress(at_us) < 1.0;
}

}  // namespace

ActorShow show_actor(const model::ActorPtr& actor, const Player& player, ClockUs at_us) noexcept {
  if (player.moves_on_by(*actor, at_us)) return show_actor(actor, reached(*actor, player, at_us), at_us);
  const model::ClipPtr clip = clip_of(*actor, player);
  const PlayRange range = player.range_of(*clip);
  const PlayerReading reading = player.read(range, at_us);
  ActorShow show{actor, clip,  reading.time_s,     {}, actor->settings.spin_rad_s * reading.played_s,
                 false, false, player.jumps << 32U};
  show.shown.live = player.live;
  const bool can_move = range.length_s() > 0.0 || !actor->layers.empty();
  show.moving = reading.playing && player.speed != 0.0 && can_move;
  show.turning = reading.playing && actor->settings.spin_rad_s != 0.0;
  show.continuity += static_cast<std::uint64_t>(reading.wraps);
  show_clips(*actor, player, at_us, show);
  if (!actor->layers.empty() || !player.layer_fades.empty()) show_layers(*actor, player, reading, at_us, show);
  return show;
}

Show show_at(const SceneView& view, ClockUs at_us) {
  Show show;
  show_at(view, at_us, show);
  return show;
}

void show_at(const SceneView& view, ClockUs at_us, Show& out) {
  out.scene = view.scene;
  out.at_us = at_us;
  out.actors.clear();
  for (std::size_t i = 0; i < view.scene->actors.size(); ++i) {
    out.actors.push_back(show_actor(view.scene->actors[i], (*view.players)[i], at_us));
  }
}

void show_time(const SceneView& view, double time_s, ClockUs now_us, Show& out) {
  show_at(view, now_us, out);
  for (ActorShow& show : out.actors) {
    show.time_s = std::clamp(time_s, 0.0, show.clip->duration_s());
    show.shown = model::shown_clip(show.clip, show.time_s);
    show.spin_angle_rad = 0.0;
  }
}

}  // namespace tweend::stage
