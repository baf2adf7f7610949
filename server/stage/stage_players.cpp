#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "server/stage/stage.hpp"

// Players over the published documents, and the one timer that tells when a `once` has run out.

namespace tweend::stage {

std::shared_ptr<const Players> Stage::players_for(const model::Scene& next, const SceneViewPtr& before, ClockUs now_us) {
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
    end_players(now_us);
    const auto at = documents_.find(scene);
    if (at == documents_.end() || !at->second.published) {
      return done(fail(ErrorCode::NotFound,
                       fmt::format("expected the name of a scene, found \"{}\"; scene.list names them", scene),
                       "params.scene"));
    }
    const SceneViewPtr before = at->second.published;
    auto players = std::make_shared<Players>(*before->players);
    auto concerned = change(PlayersTurn{*before->scene, *players, now_us});
    if (!concerned) return done(concerned.error());
    const auto view = std::make_shared<const SceneView>(SceneView{before->scene, std::move(players), next_serial_++});
    publish(scene, view);
    done(PlayersAnswer{view, *concerned, now_us});
    if (!concerned->empty()) listener_->players_changed(view, *concerned, now_us);
    end_players(now_us);  // a `once` of no length is over as it starts
    arm_end_timer();
  });
}

void Stage::end_players(ClockUs now_us) {
  for (auto& [name, document] : documents_) {
    const SceneViewPtr before = document.published;
    if (!before) continue;
    std::vector<std::size_t> ended;
    for (std::size_t i = 0; i < before->players->size(); ++i) {
      const Player& player = (*before->players)[i];
      const auto end = player.end_us(player.range_of(*clip_of(*before->scene->actors[i], player)));
      if (end && *end <= now_us) ended.push_back(i);
    }
    if (ended.empty()) continue;
    auto players = std::make_shared<Players>(*before->players);
    for (const std::size_t i : ended) {
      Player& player = (*players)[i];
      player.rebase(player.range_of(*clip_of(*before->scene->actors[i], player)), now_us);
    }
    const auto view = std::make_shared<const SceneView>(SceneView{before->scene, std::move(players), next_serial_++});
    publish(name, view);
    listener_->players_changed(view, ended, now_us);
    for (const std::size_t i : ended) listener_->player_ended(view, i);
  }
}

void Stage::arm_end_timer() {
  std::optional<ClockUs> first;
  for (const auto& [name, document] : documents_) {
    if (!document.published) continue;
    const SceneView& view = *document.published;
    for (std::size_t i = 0; i < view.players->size(); ++i) {
      const Player& player = (*view.players)[i];
      const auto end = player.end_us(player.range_of(*clip_of(*view.scene->actors[i], player)));
      if (end && (!first || *end < *first)) first = end;
    }
  }
  if (!first) {
    end_timer_.cancel();
    return;
  }
  end_timer_.expires_at(instant(*first));
  end_timer_.async_wait([this](const boost::system::error_code& error) {
    if (error) return;  // armed anew
    end_players(steady_now_us());
    arm_end_timer();
  });
}

}  // namespace tweend::stage
