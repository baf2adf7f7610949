#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "server/stage/player.hpp"

namespace tweend::stage {

// What the tests of players share.

inline constexpr ClockUs kSecond = 1'000'000;
inline constexpr PlayRange kTwoSeconds{0.0, 2.0};
inline constexpr Loop kLoops[] = {Loop::Once, Loop::Repeat, Loop::PingPong};

inline model::Clip clip_of_length(double length_s, const char* name = "clip") {
  model::Clip clip;
  clip.name = name;
  clip.settings.duration_s = length_s;
  return clip;
}

inline Player playing(Loop loop, double speed, const PlayRange& range, ClockUs from_us = 0) {
  Player player;
  player.loop = loop;
  player.speed = speed;
  if (speed < 0.0) player.seek(range, range.out_s, from_us);
  player.play(range, from_us);
  return player;
}

}  // namespace tweend::stage
