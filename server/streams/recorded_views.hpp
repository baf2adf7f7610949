#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <mutex>
#include <optional>

#include "server/base/clock.hpp"
#include "server/stage/show.hpp"
#include "server/streams/film.hpp"

namespace tweend::streams {

/// From which reading on `next` is what is shown, where it took the place of `before` at `now_us`: a turn at the players counts
/// from the reading it was made for, everything else from now.
[[nodiscard]] ClockUs holds_from_us(const stage::SceneView& before, const stage::SceneView& next, ClockUs now_us) noexcept;

/// What a scene shows at start + k / fps, k = 0, 1, …: the views that were published, each with the reading from which it
/// holds. Of those between two pictures only the last is kept. A picture is known once its reading is settled: when nobody can
/// act for it any more. Any thread.
class RecordedViews final : public FilmSource {
 public:
  /// Views that may wait for their pictures: a minute of changes at every picture, and at most so many copies of the players.
  static constexpr std::size_t kMostKept = 5'000;

  /// @param fps   at least kSlowestFilm: less is taken for that
  /// @param most  pictures
  RecordedViews(stage::SceneViewPtr view, ClockUs start_us, double fps, std::size_t most);

  /// From the reading `now_us` on, or earlier where a player was turned then.
  /// @return false: kMostKept wait; nothing has changed
  [[nodiscard]] bool add(const stage::SceneViewPtr& view, ClockUs now_us);
  /// What is shown before this reading is known, and will not change.
  void settled(ClockUs until_us);
  /// No picture of a later reading. What is shown up to then is known.
  void end(ClockUs last_us);
  /// No further picture at all.
  void give_up();

  // FilmSource
  [[nodiscard]] Next next(stage::Show& out) override;

  /// How many views are kept.
  [[nodiscard]] std::size_t kept() const;

 private:
  struct Stretch {
    ClockUs from_us;
    stage::SceneViewPtr view;
  };
  [[nodiscard]] ClockUs reading(std::size_t picture) const noexcept;
  /// Whether a picture that is to come shows something of [from, to).
  [[nodiscard]] bool is_seen(ClockUs from_us, ClockUs to_us) const noexcept;

  const ClockUs start_us_;
  const double fps_;
  const std::size_t most_;
  mutable std::mutex mutex_;
  std::deque<Stretch> stretches_;  ///< in order of time; never empty
  std::size_t next_ = 0;
  ClockUs settled_us_ = std::numeric_limits<ClockUs>::min();
  std::optional<ClockUs> last_us_;
  bool given_up_ = false;
};

}  // namespace tweend::streams
