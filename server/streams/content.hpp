#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/base/clock.hpp"
#include "server/base/result.hpp"
#include "server/stage/show.hpp"
#include "server/streams/packet.hpp"
#include "server/streams/stream_key.hpp"

namespace tweend::streams {

/// What is shown at a reading, as far as a producer has to know.
struct ContentReading {
  double time_s = 0.0;  ///< media time
  bool moving = false;  ///< it will be something else while the clock runs
  /// Changes exactly where what is shown may jump though time does not.
  std::uint64_t continuity = 0;
};

/// Told by a content what has become of the packets it was given. On the strand.
class ContentOwner {
 public:
  virtual ~ContentOwner() = default;
  /// Another packet may be begun: the one before is on its last leg.
  virtual void ready() = 0;
  /// In the order they were begun. An error: this content can't be made, and will not be later.
  virtual void made(Result<NewPacketPtr> packet) = 0;
};

/// What the packets of one producer hold, and the way they are made. Functions are called on the stage's strand; the work
/// itself is done elsewhere, in memory that is kept: that of an actor's packet allocates nothing once it has seen the longest.
/// A picture takes a few small allocations on its way from thread to thread, a PNG file its own length besides. Kept alive by
/// its owner until all that was begun is made.
class Content {
 public:
  virtual ~Content() = default;
  /// What to show from now on. @return false: it is gone from the scene, or has become something else
  [[nodiscard]] virtual bool follow(const stage::SceneViewPtr& view) = 0;
  /// Whether a new view shows the same as the one followed, at any reading.
  [[nodiscard]] virtual bool shows_the_same(const stage::SceneView& next) const noexcept = 0;
  /// No reading before this one may be shown: a playhead was set then.
  [[nodiscard]] virtual ClockUs earliest_us() const noexcept = 0;
  /// Reads the show; kept for begin().
  [[nodiscard]] virtual ContentReading read(ClockUs at_us) = 0;
  /// Starts to make a packet of what was read last: sets the header's kind and encoding, fills the payload and says so.
  /// Where the header's key flag is set it has to decode on its own; a content that can't but do so sets it.
  /// @param deadline_us  when it should be done
  virtual void begin(NewPacketPtr packet, ClockUs deadline_us) = 0;
  /// Whether a packet without the key flag needs the one before it.
  [[nodiscard]] virtual bool chained() const noexcept { return false; }
  /// Goes on with another key, which differs in what same_but_view() leaves out.
  virtual void look_from(const StreamKey&) {}
  /// Whether what is begun next is to be as good as was asked for, though the key says less (a rung of the ladder).
  virtual void refine(bool) {}
  /// Why follow() said no, for the client.
  [[nodiscard]] virtual std::string what_is_gone() const = 0;
};

}  // namespace tweend::streams
