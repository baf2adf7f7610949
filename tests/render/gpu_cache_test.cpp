#include "render/gpu_cache.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

namespace tweend::render {
namespace {

using test::Shape;

const std::vector<std::uint8_t> kTexels(std::size_t{4} * 16 * 16, 200);

Shape textured_square(ResourceId texture) {
  Shape shape = test::square(1.0F);
  shape.materials = {{glm::vec3(1.0F), TextureSource{texture, {16, 16}, kTexels}}};
  return shape;
}

class GpuCacheOnGpu : public testing::Test {
 protected:
  static std::size_t bytes_of(const Shape& shape) {
    GpuCache cache(std::size_t{1} << 20U);
    return show(cache, shape).bytes();
  }
  static GpuMesh& show(GpuCache& cache, const Shape& shape) {
    FrameMemory memory;
    cache.begin_picture();
    const DrawItem item = shape.item();
    GpuMesh& mesh = cache.mesh(*item.mesh);
    mesh.bind(item, memory);
    return mesh;
  }
  test::Offscreen gpu_;
};

TEST_F(GpuCacheOnGpu, SharesMeshesByContent) {
  GpuCache cache(std::size_t{1} << 20U);
  const Shape shape = test::square(1.0F);
  GpuMesh& mesh = show(cache, shape);
  Shape same = test::square(1.0F);  // other memory, the same name
  same.name = shape.name;
  EXPECT_EQ(&show(cache, same), &mesh);
  EXPECT_EQ(cache.mesh_count(), 1U);
  EXPECT_EQ(cache.key_uploads(), 1U);
  EXPECT_NE(&show(cache, test::square(1.0F)), &mesh);
  EXPECT_EQ(cache.mesh_count(), 2U);
}

TEST_F(GpuCacheOnGpu, SharesTexturesByContentBetweenMeshes) {
  GpuCache cache(std::size_t{1} << 20U);
  const auto texture = [&](const Shape& shape) { return show(cache, shape).ranges()[0].texture; };
  const auto first = texture(textured_square({1, 1}));
  ASSERT_TRUE(first);
  EXPECT_EQ(texture(textured_square({1, 1})), first);
  EXPECT_NE(texture(textured_square({1, 2})), first);
  EXPECT_FALSE(texture(test::square(1.0F)));
}

TEST_F(GpuCacheOnGpu, LetsGoOfWhatWasShownLongestAgoBeyondItsBudget) {
  std::vector<Shape> shapes;
  for (int i = 0; i < 4; ++i) shapes.push_back(textured_square({2, static_cast<std::uint64_t>(i)}));
  const std::size_t each = bytes_of(shapes[0]);
  ASSERT_GT(each, 0U);
  GpuCache cache(3 * each);
  for (const Shape& shape : shapes) static_cast<void>(show(cache, shape));
  EXPECT_EQ(cache.mesh_count(), 4U) << "one picture may need more";
  cache.begin_picture();
  EXPECT_EQ(cache.mesh_count(), 3U);
  const std::uint64_t uploads = cache.key_uploads();
  for (std::size_t i = 1; i < 4; ++i) static_cast<void>(show(cache, shapes[i]));
  EXPECT_EQ(cache.key_uploads(), uploads) << "the first was the one that went";
  static_cast<void>(show(cache, shapes[0]));
  EXPECT_EQ(cache.mesh_count(), 4U);
}

TEST_F(GpuCacheOnGpu, KeepsWhatTheLastPictureShowedHoweverSmallItsBudget) {
  GpuCache cache(1);
  FrameMemory memory;
  const Shape a = test::square(1.0F), b = test::square(2.0F);
  for (int picture = 0; picture < 3; ++picture) {
    cache.begin_picture();
    for (const Shape* shape : {&a, &b}) cache.mesh(*shape->source()).bind(shape->item(), memory);
  }
  EXPECT_EQ(cache.key_uploads(), 2U) << "a scene beyond the budget is not uploaded anew for each picture";
  static_cast<void>(show(cache, a));
  cache.begin_picture();
  EXPECT_EQ(cache.mesh_count(), 1U);
}

TEST_F(GpuCacheOnGpu, ATextureGoesWithTheLastMeshThatShowsIt) {
  GpuCache cache(1);
  std::weak_ptr<const GlTexture> texture = show(cache, textured_square({3, 3})).ranges()[0].texture;
  static_cast<void>(show(cache, textured_square({3, 3})));
  EXPECT_FALSE(texture.expired());
  for (int i = 0; i < 3; ++i) static_cast<void>(show(cache, test::square(1.0F)));
  EXPECT_TRUE(texture.expired());
}

TEST_F(GpuCacheOnGpu, UploadsAnewWhatItHasForgotten) {
  GpuCache cache(std::size_t{1} << 20U);
  const Shape shape = textured_square({5, 5});
  std::weak_ptr<const GlTexture> texture = show(cache, shape).ranges()[0].texture;
  cache.forget();
  EXPECT_EQ(cache.mesh_count(), 0U);
  EXPECT_TRUE(texture.expired());
  static_cast<void>(show(cache, shape));
  EXPECT_EQ(cache.key_uploads(), 1U);
}

TEST_F(GpuCacheOnGpu, WhatWasLetGoIsDrawnTheSameAfterwards) {
  test::Offscreen small(1);
  Picture picture;
  picture.size = {32, 32};
  picture.light.ambient = 1.0F;
  std::vector<std::uint8_t> texels = kTexels;
  for (std::size_t i = 0; i < texels.size(); i += 3) texels[i] = static_cast<std::uint8_t>(i);
  Shape shape = textured_square({4, 4});
  shape.materials[0].base_color_texture->rgba = texels;
  const auto draw = [&](const Shape& shown) {
    picture.items = {shown.item()};
    return small.draw(picture);
  };
  const test::Image first = draw(shape);
  for (int i = 0; i < 3; ++i) static_cast<void>(draw(test::square(0.5F)));
  EXPECT_EQ(small.renderer().cache().mesh_count(), 2U);
  EXPECT_EQ(draw(shape), first);
}

}  // namespace
}  // namespace tweend::render
