#include "server/streams/stream_meter.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "tests/streams/streaming.hpp"

namespace tweend::streams {
namespace {

using test::scene_of;
using test::square_actor;
using test::Streaming;

const StreamKey kSquare = test::vertices_of("main", "square", 100.0);

/// The value of a stream's figure by its labels; -1 where there is none.
std::int64_t figure(const Streaming& s, const std::string& name, const StreamKey& key) {
  for (const auto& reading : s.hub.meters().read()) {
    if (reading.name == "tweend_stream_" + name + "{" + labels_of(key) + "}") return reading.value;
  }
  return -1;
}

TEST(StreamMeter, TellStreamsApartByTheirParametersAlone) {
  Streaming s({scene_of("main", {square_actor("square")})});
  const StreamKey slower = test::vertices_of("main", "square", 50.0);
  s.subscribe(kSquare, 1);
  s.sink->wait_for(1, 1);
  s.subscribe(kSquare, 2);
  s.settle();
  EXPECT_EQ(figure(s, "readers", kSquare), 2);
  EXPECT_EQ(figure(s, "readers", slower), -1);
  s.unsubscribe(kSquare, 1);
  s.stage->post([&] { s.hub.retune(kSquare, slower, {s.sink, 2}); });  // the producer goes along
  s.sink->wait_for(2, 2);
  s.settle();
  EXPECT_EQ(s.stage.metrics.producers.load(), 1);
  EXPECT_EQ(figure(s, "readers", slower), 1);
  EXPECT_EQ(figure(s, "produced_total", slower), 1);
  s.unsubscribe(slower, 2);
  s.subscribe(kSquare, 3);  // under the same name as before
  s.sink->wait_for(3, 1);
  s.settle();
  EXPECT_EQ(figure(s, "readers", kSquare), 1);
  s.unsubscribe(kSquare, 3);
  s.settle();
}

TEST(StreamMeter, CountViewersWithCamerasOfTheirOwnTogether) {
  StreamMeters meters;
  StreamKey key{"main", 30.0, FramesSpec{}};
  const auto first = meters.meter(labels_of(key));
  std::get<FramesSpec>(key.what).camera = model::CameraRequest{};
  EXPECT_EQ(meters.meter(labels_of(key)), first);
  std::get<FramesSpec>(key.what).quality = 20;
  EXPECT_NE(meters.meter(labels_of(key)), first);
}

}  // namespace
}  // namespace tweend::streams
