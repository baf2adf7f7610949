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

model::ClipPtr clip_of(const model::Actor& actor, const Player& player) noexcept {
  const model::ClipPtr clip = actor.find_clip(player.clip);
  return clip ? clip : actor.clips.front();
}

ActorShow show_actor(const model::ActorPtr& actor, const Player& player, ClockUs at_us) noexcept {
  const model::ClipPtr clip = clip_of(*actor, player);
  const PlayRange range = player.range_of(*clip);
  const PlayerReading reading = player.read(range, at_us);
  ActorShow show{
      actor, clip,  reading.time_s,     model::shown_clip(clip, reading.time_s), actor->settings.spin_rad_s * reading.played_s,
      false, false, player.jumps << 32U};
  show.shown.live = player.live;
  show.moving = reading.playing && range.length_s() > 0.0 && player.speed != 0.0;
  show.turning = reading.playing && actor->settings.spin_rad_s != 0.0;
  show.continuity += static_cast<std::uint64_t>(reading.wraps);
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
