#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/base/clock.hpp"
#include "server/base/limits.hpp"
#include "server/streams/film.hpp"

namespace tweend::streams {

/// How many pictures a film has that shows from `from_s` to before `to_s`: picture k shows from_s + k / fps. At least one.
[[nodiscard]] std::size_t film_pictures(double from_s, double to_s, double fps) noexcept;

/// Every actor's current clip at times of its own, whatever the players do: as a single picture of a `time_s`.
class ClipSource final : public FilmSource {
 public:
  ClipSource(stage::SceneViewPtr view, double from_s, double fps, std::size_t pictures, ClockUs now_us)
      : view_(std::move(view)), from_s_(from_s), fps_(fps), pictures_(pictures), now_us_(now_us) {}
  [[nodiscard]] Next next(stage::Show& out) override;
  /// No further picture. Any thread.
  void cancel() noexcept { cancelled_ = true; }

 private:
  const stage::SceneViewPtr view_;
  const double from_s_;
  const double fps_;
  const std::size_t pictures_;
  const ClockUs now_us_;
  std::size_t next_ = 0;
  std::atomic<bool> cancelled_ = false;
};

struct ClipFilm {
  stage::SceneViewPtr view;
  double from_s = 0.0;
  double fps = 30.0;
  std::size_t pictures = 1;
  render::Size size;
  std::optional<model::CameraRequest> camera;  ///< empty: the scene's
  ClockUs now_us = 0;
};

/// A film that is made, and what it holds of its queue: its place, for as long as somebody keeps it.
struct MadeFilm {
  std::string file;
  std::shared_ptr<const void> place;
};

/// Films of clips as MP4 files in memory, one at a time: whoever asks for many takes nothing from streams and recordings. Each
/// has a place from its first picture until its last reader lets go of it, so that slow readers hold a bounded memory; where
/// all are taken, the next one waits. Any thread. Held by a shared_ptr: places may outlive all but the queue itself, once
/// stopped.
class FilmQueue : public std::enable_shared_from_this<FilmQueue> {
 public:
  /// How many may wait; the next one is refused.
  static constexpr std::size_t kWaiting = 64;
  /// How many there are in memory, the one under way among them.
  static constexpr std::size_t kPlaces = 4;
  using Done = std::function<void(Result<MadeFilm>)>;

  /// All outlive stop().
  /// @param limits  film_bytes
  FilmQueue(WorkerPool& workers, render::RenderThread& renderer, const Limits& limits)
      : workers_(workers), renderer_(renderer), limits_(limits) {}

  /// @param wanted  once it is gone, so is the interest in the film: under way it ends with its next picture, waiting it
  ///                gives its turn to another
  /// @param done    once, on any thread: the film; Limit where it gets too long, what the writer refuses, Unavailable where the
  ///                interest is gone or the server stops
  /// @return Unavailable where too many wait; `done` is not called then
  [[nodiscard]] Status make(ClipFilm film, std::weak_ptr<const void> wanted, Done done);
  /// Gives up what waits and what is under way; returns when nothing is. Again does nothing. One thread only.
  void stop();

 private:
  struct Order {
    ClipFilm film;
    std::weak_ptr<const void> wanted;
    Done done;
  };
  class Place;
  /// The next film that waits, if it may.
  void begin_next();
  void begin(Order order);
  void ended();
  /// Takes out of those that wait what nobody waits for any more.
  void drop_unwanted();

  WorkerPool& workers_;
  render::RenderThread& renderer_;
  const Limits& limits_;
  std::mutex mutex_;
  std::condition_variable idle_;
  std::deque<Order> waiting_;
  std::size_t places_taken_ = 0;
  bool under_way_ = false;
  bool stopping_ = false;
  std::shared_ptr<ClipSource> source_;  ///< of the one under way
};

}  // namespace tweend::streams
