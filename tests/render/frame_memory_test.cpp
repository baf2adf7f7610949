#include "render/frame_memory.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "server/animation/affine.hpp"
#include "tests/render/support/flat.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

namespace tweend::render {
namespace {

using test::Shape;

class FrameMemoryOnGpu : public testing::Test {
 protected:
  static FrameMemory::Piece filled(FrameMemory& memory, std::size_t floats, float value) {
    const FrameMemory::Piece piece = memory.take(floats * sizeof(float));
    const std::vector<float> values(floats, value);
    std::memcpy(piece.memory.data(), values.data(), piece.memory.size());
    return piece;
  }
  test::Offscreen gpu_;
};

TEST_F(FrameMemoryOnGpu, GivesPiecesThatBeginWithATexelAndDoNotOverlap) {
  FrameMemory memory;
  memory.begin_picture();
  const auto a = filled(memory, 5, 1.0F), b = filled(memory, 3, 2.0F), c = filled(memory, 4, 3.0F);
  EXPECT_EQ(a.buffer, c.buffer);
  EXPECT_EQ(a.first_texel(), 0);
  EXPECT_EQ(b.first_texel(), 2);
  EXPECT_EQ(c.offset, 48);
  EXPECT_EQ(test::read_buffer(a.buffer, a.offset, 5), std::vector<float>(5, 1.0F));
  EXPECT_EQ(test::read_buffer(b.buffer, b.offset, 3), std::vector<float>(3, 2.0F));
  EXPECT_EQ(test::read_buffer(c.buffer, c.offset, 4), std::vector<float>(4, 3.0F));
}

TEST_F(FrameMemoryOnGpu, GrowsToWhatAPictureTakesAndNoFurther) {
  FrameMemory memory;
  const auto picture = [&](std::size_t floats) {
    memory.begin_picture();
    for (int i = 0; i < 3; ++i) {
      const auto piece = filled(memory, floats, 7.0F);
      EXPECT_EQ(test::read_buffer(piece.buffer, piece.offset, floats), std::vector<float>(floats, 7.0F));
    }
    memory.end_picture();
  };
  for (int i = 0; i < 6; ++i) picture(100'000);
  const std::size_t grown = memory.bytes();
  for (int i = 0; i < 6; ++i) picture(100'000);
  EXPECT_EQ(memory.bytes(), grown);
}

TEST_F(FrameMemoryOnGpu, NothingIsTakenAsNothing) {
  FrameMemory memory;
  memory.begin_picture();
  EXPECT_TRUE(memory.take(0).memory.empty());
  memory.end_picture();
}

/// The square of a skin with one entry, moved sideways.
TEST_F(FrameMemoryOnGpu, PicturesInFlightKeepWhatTheyWereGiven) {
  Shape shape = test::square(0.1F);
  shape.influences = 1;
  shape.entries.assign(4, 0);
  constexpr Size kSize{90, 10};
  constexpr std::size_t kPictures = 9;
  std::vector<RenderTargetPtr> targets;
  for (std::size_t i = 0; i < kPictures; ++i) {
    animation::Affine moved;
    moved.rows[0].w = -0.9F + 0.2F * static_cast<float>(i) + 0.1F;
    Picture picture = test::flat_picture(kSize);
    picture.items = {shape.item()};
    picture.items[0].palette = {&moved.rows[0].x, 12};
    targets.push_back(std::move(*RenderTarget::make(kSize, 1)));
    gpu_.renderer().draw(picture, *targets.back());
  }
  ReadbackPool pool;
  for (std::size_t i = 0; i < kPictures; ++i) {
    const PixelsPtr pixels = pool.take(kSize);
    targets[i]->read_into(pixels->buffer());
    glFinish();
    const test::Image image(pixels->view());
    for (std::size_t k = 0; k < kPictures; ++k) {
      EXPECT_EQ(image.at(9 * k + 9, 5)[0], k == i ? 255 : 0) << "picture " << i << ", place " << k;
    }
  }
}

}  // namespace
}  // namespace tweend::render
