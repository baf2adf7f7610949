#include "server/streams/stream_key.hpp"

#include <gtest/gtest.h>

#include <variant>
#include <vector>

namespace tweend::streams {
namespace {

const StreamKey kVertices{"main", 30.0, VerticesSpec{"square"}};
const StreamKey kFrames{"main", 30.0, FramesSpec{"", FrameEncoding::Jpeg, {64, 48}, 80, {}, 0, 0}};

template <class Change>
StreamKey changed(Change change) {
  StreamKey key = kFrames;
  change(key, std::get<FramesSpec>(key.what));
  return key;
}

/// Everything but rate and camera, changed one at a time.
std::vector<StreamKey> others() {
  return {kVertices,
          changed([](StreamKey& key, FramesSpec&) { key.scene = "aside"; }),
          changed([](StreamKey&, FramesSpec& f) { f.actor = "square"; }),
          changed([](StreamKey&, FramesSpec& f) { f.encoding = FrameEncoding::Png; }),
          changed([](StreamKey&, FramesSpec& f) { f.size.width = 65; }),
          changed([](StreamKey&, FramesSpec& f) { f.size.height = 49; }),
          changed([](StreamKey&, FramesSpec& f) { f.quality = 81; })};
}

TEST(StreamKey, TellsPicturesApartThatAreNotMadeTheSameWay) {
  EXPECT_EQ(kFrames, changed([](StreamKey&, FramesSpec&) {}));
  for (const StreamKey& other : others()) EXPECT_NE(kFrames, other);
  EXPECT_NE(kFrames, changed([](StreamKey& key, FramesSpec&) { key.rate = 60.0; }));
  EXPECT_NE(kFrames, changed([](StreamKey&, FramesSpec& f) { f.camera = model::CameraRequest{}; }))
      << "an own camera that asks for nothing doesn't follow the scene's by chance";
}

TEST(SameButView, IsNotWhatDiffersInMoreThanRateAndCamera) {
  for (const StreamKey& other : others()) {
    EXPECT_FALSE(same_but_view(kFrames, other));
    EXPECT_FALSE(same_but_view(other, kFrames));
  }
  EXPECT_FALSE(same_but_view(kVertices, StreamKey{"main", 30.0, VerticesSpec{"other"}}));
}

TEST(SameButView, IsNotH264OfAnotherRateWhoseBitsArePicturesBudgets) {
  StreamKey slow = changed([](StreamKey&, FramesSpec& f) { f.encoding = FrameEncoding::H264; });
  StreamKey fast = slow;
  EXPECT_TRUE(same_but_view(slow, fast));
  fast.rate = 2 * slow.rate;
  EXPECT_FALSE(same_but_view(slow, fast));
}

TEST(SameButView, IsWhatDiffersInRateAndCameraOnly) {
  model::CameraRequest camera;
  camera.fit = true;
  const StreamKey fitted = changed([&](StreamKey& key, FramesSpec& f) {
    key.rate = 5.0;
    f.camera = camera;
  });
  EXPECT_TRUE(same_but_view(kFrames, kFrames));
  EXPECT_TRUE(same_but_view(kFrames, fitted));
  EXPECT_TRUE(same_but_view(fitted, kFrames));
  EXPECT_TRUE(same_but_view(kVertices, StreamKey{"main", 1.0, VerticesSpec{"square"}}));
}

}  // namespace
}  // namespace tweend::streams
