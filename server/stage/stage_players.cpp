#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "server/stage/stage.hpp"

// Players over the published documents: made and followed through edits, and changed by commands.

namespace tweend::stage {

namespace {

const model::Layer* find_layer(const model::Actor& actor, const std::string& name) noexcept {
  const auto at = std::find_if(actor.layers.begin(), actor.layers.end(), [&](const model::Layer& l) { return l.name == name; });
  return at == actor.layers.end() ? nullptr : &*at;
}

}  // namespace

std::shared_ptr<const Players> Stage::players_for(const model::Scene& next, const SceneViewPtr& before, ClockUs now_us,
                                                  const std::vector<LayerFadeRequest>& layer_fades) {
  auto players = std::make_shared<Players>();
  players->reserve(next.actors.size());
  for (const model::ActorPtr& actor : next.actors) {
    const Player* old = before ? before->find_player(actor->name) : nullptr;
    const model::ActorPtr was = before ? before->scene->find_actor(actor->name) : nullptr;
    if (old == nullptr || was->model != actor->model) {  // new, or another model under the same name
      Player fresh;
      fresh.actor = actor->name;
      fresh.clip = actor->clips.front()->name;
      fresh.anchor_us = now_us;
      players->push_back(std::move(fresh));
      continue;
    }
    Player player = *old;
    if (was != actor) {
      player.follow_fades(*was, *actor, now_us);
      for (const LayerFadeRequest& fade : layer_fades) {
        if (fade.actor != actor->name) continue;
        player.fade_layer(fade.layer, find_layer(*was, fade.layer), find_layer(*actor, fade.layer), fade.length_s, now_us);
      }
      const model::ClipPtr clip = actor->find_clip(player.clip);
      if (clip) {
        player.follow(player.range_of(*clip_of(*was, player)), player.range_of(*clip), now_us);
      } else {
        player.pause(player.range_of(*clip_of(*was, player)), now_us);
        player.change_clip(*actor->clips.front(), now_us);
        player.anchor_phase_s = 0.0;
      }
    }
    players->push_back(std::move(player));
  }
  return players;
}

void Stage::publish(const std::string& scene, SceneViewPtr view) {
  auto next = std::make_shared<StageView>(*view_.load());
  if (view) {
    next->scenes[scene] = view;
    documents_[scene].published = view;
  } else {
    next->scenes.erase(scene);
  }
  std::int64_t actors = 0;
  for (const auto& [name, v] : next->scenes) actors += static_cast<std::int64_t>(v->scene->actors.size());
  metrics_.scenes = static_cast<std::int64_t>(next->scenes.size());
  metrics_.actors = actors;
  view_.store(std::move(next));
  listener_->published(scene, view);
}

void Stage::change_players(std::string scene, PlayersChange change, PlayersDone done) {
  boost::asio::post(io_, [this, scene = std::move(scene), change = std::move(change), done = std::move(done)] {
    const ClockUs now_us = steady_now_us();
    advance(now_us);
    carry_out(scene, change, now_us, done);
  });
}

void Stage::carry_out(const std::string& scene, const PlayersChange& change, ClockUs as_of_us, const PlayersDone& done) {
  const auto at = documents_.find(scene);
  if (at == documents_.end() || !at->second.published) {
    return done(fail(ErrorCode::NotFound,
                     fmt::format("expected the name of a scene, found \"{}\"; scene.list names them", scene), "params.scene"));
  }
  const SceneViewPtr before = at->second.published;
  auto players = std::make_shared<Players>(*before->players);
  auto concerned = change(PlayersTurn{*before->scene, *players, as_of_us, limits_});
  if (!concerned) return done(concerned.error());
  for (const std::size_t i : *concerned) (*players)[i].drop_fades(as_of_us);
  const auto view = std::make_shared<const SceneView>(SceneView{before->scene, std::move(players), next_serial_++});
  publish(scene, view);
  // Told first: whoever subscribes after the answer hears of nothing that came before.
  if (!concerned->empty()) listener_->players_changed(view, *concerned, as_of_us);
  done(PlayersAnswer{view, *concerned, as_of_us});
  tell_starts(before, view, as_of_us);
  settle(as_of_us);  // a `once` of no length is over as it starts
  arm_timer();
}

}  // namespace tweend::stage
