#include <algorithm>
#include <cmath>
#include <utility>

#include "server/model/shown.hpp"
#include "server/stage/player.hpp"

// What fades goes by the clock alone: pausing the player holds neither the fade nor what fades out.

namespace tweend::stage {
namespace {

double progress_of(ClockUs start_us, double length_s, ClockUs at_us) noexcept {
  return std::clamp(seconds_between(start_us, at_us) / length_s, 0.0, 1.0);
}

}  // namespace

double Fade::progress(ClockUs at_us) const noexcept { return progress_of(start_us, length_s, at_us); }
double LayerFade::progress(ClockUs at_us) const noexcept { return progress_of(start_us, length_s, at_us); }

void Player::fade_from(const Player& before, double length_s, ClockUs now_us) {
  fades = before.fades;
  drop_fades(now_us);
  jumps = before.jumps;
  if (fades.size() >= model::kMostFades) {
    fades.erase(fades.begin());
    ++jumps;  // the oldest is cut short
  }
  fades.push_back({before, now_us, length_s});
}

float Player::weight_of(const model::Layer& layer, ClockUs at_us) const noexcept {
  for (const LayerFade& fade : layer_fades) {
    if (fade.ghost || fade.layer != layer.name) continue;
    return std::lerp(fade.from_weight, layer.weight, static_cast<float>(fade.progress(at_us)));
  }
  return layer.weight;
}

void Player::fade_layer(const std::string& layer, const model::Layer* was, const model::Layer* is, double length_s,
                        ClockUs now_us) {
  const float weight = was != nullptr ? weight_of(*was, now_us) : 0.0F;
  drop_fades(now_us);
  std::erase_if(layer_fades, [&layer](const LayerFade& f) { return !f.ghost && f.layer == layer; });
  if (length_s <= 0.0) return;
  const bool same = was != nullptr && is != nullptr && was->clip == is->clip && was->additive == is->additive &&
                    (was->joints == is->joints || (was->joints && is->joints && *was->joints == *is->joints));
  if (!same && was != nullptr && weight > 0.0F) {
    constexpr std::size_t kMostGhosts = model::kMostLayers / 2;
    const auto is_ghost = [](const LayerFade& f) { return f.ghost.has_value(); };
    if (static_cast<std::size_t>(std::count_if(layer_fades.begin(), layer_fades.end(), is_ghost)) >= kMostGhosts) {
      layer_fades.erase(std::find_if(layer_fades.begin(), layer_fades.end(), is_ghost));
    }
    layer_fades.push_back({layer, *was, weight, now_us, length_s});
  }
  if (is != nullptr) layer_fades.push_back({layer, std::nullopt, same ? weight : 0.0F, now_us, length_s});
}

void Player::drop_fades(ClockUs now_us) noexcept {
  // What a later clip has replaced wholly hides all that came before it.
  const auto over = std::find_if(fades.rbegin(), fades.rend(), [now_us](const Fade& f) { return f.progress(now_us) >= 1.0; });
  fades.erase(fades.begin(), over.base());
  std::erase_if(layer_fades, [now_us](const LayerFade& f) { return f.progress(now_us) >= 1.0; });
}

void Player::follow_fades(const model::Actor& before, const model::Actor& after, ClockUs now_us) {
  drop_fades(now_us);
  // With a clip that is gone, what it had replaced so far is gone as well.
  const auto lost = std::find_if(fades.rbegin(), fades.rend(), [&](const Fade& f) { return !after.find_clip(f.from.clip); });
  fades.erase(fades.begin(), lost.base());
  for (Fade& fade : fades) {
    fade.from.follow(fade.from.range_of(*clip_of(before, fade.from)), fade.from.range_of(*clip_of(after, fade.from)), now_us);
  }
  std::erase_if(layer_fades, [&after](const LayerFade& f) {
    const auto named = std::find_if(after.layers.begin(), after.layers.end(), [&](const auto& l) { return l.name == f.layer; });
    return f.ghost ? !after.find_clip(f.ghost->clip) : named == after.layers.end();
  });
}

}  // namespace tweend::stage
