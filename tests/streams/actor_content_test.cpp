#include "server/streams/actor_content.hpp"

#include <gtest/gtest.h>

#include "tests/streams/posed_actors.hpp"
#include "tests/streams/streaming.hpp"

namespace tweend::streams {
namespace {

// Packets that wait are counted by their lengths: what an encoder might have written is no room of its packet.
TEST(ActorContent, TakesTheMemoryOfItsBytesAlone) {
  test::Streaming s({test::scene_of("main", {test::ribbon_actor("ribbon")})});
  std::uint32_t stream = 1;
  const auto expect_exact = [&](const StreamKey& key) {
    s.subscribe(key, stream);
    const PacketPtr packet = s.sink->wait_for(stream, 1)[0];
    EXPECT_GT(packet->header.payload_bytes, 0U);
    EXPECT_EQ(packet->payload.capacity(), packet->header.payload_bytes) << stream;
    ++stream;
  };
  for (const PoseEncoding encoding : {PoseEncoding::F32, PoseEncoding::Q16}) {
    expect_exact({"main", 30.0, PoseSpec{"ribbon", encoding}});
  }
  for (const VerticesEncoding encoding : {VerticesEncoding::F32, VerticesEncoding::Q16, VerticesEncoding::Meshopt}) {
    expect_exact({"main", 30.0, VerticesSpec{"ribbon", encoding}});
  }
}

}  // namespace
}  // namespace tweend::streams
