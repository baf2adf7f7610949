#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/base/clock.hpp"
#include "server/model/actor.hpp"
#include "server/stage/motion.hpp"

namespace tweend::stage {

/// A clip of a queue.
struct QueueEntry {
  std::string clip;
  Loop loop = Loop::Once;   ///< what one repeat is: there, or there and back; and how it goes on while it fades out
  std::int64_t repeat = 1;  ///< >= 1
  double fade_s = 0.0;      ///< clock seconds in which it takes over from the one before
};

/// The clips that follow the one a player is on.
struct Queue {
  std::shared_ptr<const std::vector<QueueEntry>> entries;
  std::size_t next = 0;            ///< of `entries`; their number: the last one is playing
  Loop loop_after = Loop::Repeat;  ///< the player's own loop, in force again when the queue is over
  bool operator==(const Queue&) const = default;
};

/// What a player showed before, on its way out: it goes on by its own law while the next clip replaces it.
struct Fade {
  Motion from;
  ClockUs start_us = 0;
  double length_s = 0.0;  ///< clock seconds, > 0
  /// How far the next clip has replaced it, 0 to 1.
  [[nodiscard]] double progress(ClockUs at_us) const noexcept;
  bool operator==(const Fade&) const = default;
};

/// A layer whose weight is on its way to the one that the actor's layer has, or to 0.
struct LayerFade {
  std::string layer;
  std::optional<model::Layer> ghost;  ///< the layer that was taken away; empty: the actor's own of that name
  float from_weight = 0.0F;
  ClockUs start_us = 0;
  double length_s = 0.0;
  [[nodiscard]] double progress(ClockUs at_us) const noexcept;
  bool operator==(const LayerFade&) const = default;
};

/// The transport of one actor: a motion, what follows it and what still fades. A value; reading it is a pure function.
///
/// A player with a queue reads right at any clock reading, whether or not the stage has moved it on: see reached().
struct Player : Motion {
  std::string actor;
  std::optional<Queue> queue;
  std::vector<Fade> fades;             ///< oldest first
  std::vector<LayerFade> layer_fades;  ///< oldest first
  model::PoseKeyPtr live;              ///< a live pose over what the clips show; null: none
  std::uint64_t jumps = 0;             ///< seeks, stops, clip changes: breaks in what is shown
  std::uint64_t starts = 0;            ///< times that playing began, or began anew from elsewhere

  bool operator==(const Player&) const = default;

  // Each of these takes effect at the reading `now_us`; media time is continuous where nothing says otherwise.

  /// A time outside the range is clamped for `once` and wrapped for the others; `out` itself can be sought. Ends the queue.
  void seek(const PlayRange& r, double time_s, ClockUs now_us) noexcept;
  /// Starts again where a `once` has nothing left to play in the direction of its speed. A queue goes on.
  void play(const PlayRange& r, ClockUs now_us) noexcept;
  void pause(const PlayRange& r, ClockUs now_us) noexcept;
  /// Pauses at the range's start; spin is 0 again. Ends the queue.
  void stop(const PlayRange& r, ClockUs now_us) noexcept;
  /// Another clip of the actor, from its range's start (backwards: its end); the range is the whole clip again. Ends the queue.
  void change_clip(const model::Clip& next, ClockUs now_us) noexcept;
  void set_speed(const PlayRange& r, double new_speed, ClockUs now_us) noexcept;
  /// Ends the queue.
  void set_loop(const PlayRange& r, Loop new_loop, ClockUs now_us) noexcept;
  /// Ends the queue.
  /// @param next  empty: the whole clip
  void set_range(const model::Clip& c, std::optional<PlayRange> next, ClockUs now_us) noexcept;

  // player_queue.cpp

  /// Plays these one after another. Precondition: there is one, and the actor has their clips.
  void start_queue(const model::Actor& a, std::vector<QueueEntry> entries, ClockUs now_us);
  /// The clip plays on alone, under the player's own loop.
  void leave_queue(const PlayRange& r, ClockUs now_us) noexcept;
  /// Precondition: end_us() is `seam_us`. The next clip of the queue starts there, exactly where this one ends; after the last
  /// one, or without a queue, it stays at its end.
  /// @return whether there was a next one
  bool move_on(const model::Actor& a, ClockUs seam_us);
  /// Whether the player as it is would not do for a reading: its queue has moved on by then.
  [[nodiscard]] bool moves_on_by(const model::Actor& a, ClockUs at_us) const noexcept;

  // player_fade.cpp

  /// From what `before` shows at `now_us` to what this shows.
  void fade_from(const Player& before, double length_s, ClockUs now_us);
  /// The layer `was` has become `is` (null: it is not there): its weight goes from what it was to what it is to be.
  /// @param length_s  0: at once
  void fade_layer(const std::string& layer, const model::Layer* was, const model::Layer* is, double length_s, ClockUs now_us);
  /// The weight of one of the actor's layers.
  [[nodiscard]] float weight_of(const model::Layer& layer, ClockUs at_us) const noexcept;
  /// Forgets what is over.
  void drop_fades(ClockUs now_us) noexcept;
  /// The actor has been edited under the player.
  void follow_fades(const model::Actor& before, const model::Actor& after, ClockUs now_us);

 private:
  void jump() noexcept;
  void enter(const model::Actor& a, const QueueEntry& entry, ClockUs seam_us, double carry_s);
};

/// The clip a motion is on; an actor always has one.
[[nodiscard]] model::ClipPtr clip_of(const model::Actor& actor, const Motion& motion) noexcept;

/// The player as a reading finds it, moved on through its queue.
[[nodiscard]] Player reached(const model::Actor& actor, Player player, ClockUs at_us);

/// The time of the n-th keyframe after (n > 0) or before (n < 0) `time_s` within the range; past the last one it stays there
/// (`once`) or goes on around. Empty where the range has no keyframe.
[[nodiscard]] std::optional<double> step_keyframes(std::span<const double> times_s, const PlayRange& r, Loop loop,
                                                   double time_s, std::int64_t n) noexcept;

}  // namespace tweend::stage
