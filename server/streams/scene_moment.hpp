#pragma once

#include <cstdint>
#include <memory>

#include "render/picture.hpp"
#include "server/stage/show.hpp"
#include "server/streams/frame_composer.hpp"

namespace tweend::streams {

/// A scene at a reading of the clock: what it shows, and that as it is to be drawn. The show is read on the strand, the picture
/// composed on a worker; from then on both are read by whoever has it, until it is given another moment.
struct SceneMoment {
  enum class State : std::uint8_t { Read, Composing, Composed };

  stage::SceneViewPtr view;
  ClockUs at_us = 0;
  stage::Show show;
  FrameComposer composer;     ///< the picture borrows of it
  render::Picture picture;    ///< without a size and a view
  State state = State::Read;  ///< the strand's
};
using MomentPtr = std::shared_ptr<SceneMoment>;

}  // namespace tweend::streams
