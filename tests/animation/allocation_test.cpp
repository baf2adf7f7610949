// The whole layer runs inside the frame loop: a call that succeeds must not touch the heap.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "server/animation/blend_poses.hpp"
#include "server/animation/blend_vertices.hpp"
#include "server/animation/key_blend.hpp"
#include "server/animation/local_to_model.hpp"
#include "server/animation/morph_vertices.hpp"
#include "server/animation/skin_vertices.hpp"
#include "server/animation/vertex_normals.hpp"
#include "server/animation/vertex_tangents.hpp"
#include "tests/animation/random_tracks.hpp"
#include "tests/support/allocations.hpp"

namespace tweend::animation {
namespace {

TEST(Allocation, TheCounterCounts) {
  const std::size_t before = test::allocations();
  const std::vector<int> some(100);
  EXPECT_GT(test::allocations(), before) << some.size();
}

TEST(Allocation, SuccessTakesNoMemory) {
  constexpr std::size_t kFloats = 3 * 1001;
  const std::vector<float> stream(kFloats, 0.25F);
  const std::vector<float> texcoords(kFloats / 3 * 2, 0.5F);
  const std::vector<std::uint32_t> indices{0, 1, 2, 3, 4, 5};
  std::vector<float> positions(kFloats), normals(kFloats), tangents(kFloats);
  const std::array<VertexAttributes, 4> sources{
      VertexAttributes{stream, stream, stream}, VertexAttributes{stream, stream, stream},
      VertexAttributes{stream, stream, stream}, VertexAttributes{stream, stream, stream}};
  const std::array times_s{0.0, 1.0, 3.0, 4.0};
  const KeyTimeline timeline{times_s, 5.0, true};
  const CubicBezier easing{0.25F, 0.1F, 0.25F, 1.0F};
  bool all_succeeded = true;

  const std::size_t before = test::allocations();
  for (int quarter = 0; quarter <= 20; ++quarter) {
    const double t = quarter / 4.0;
    for (const Interpolation mode : {Interpolation::Step, Interpolation::Linear, Interpolation::CatmullRom}) {
      const KeyBlend blend = blend_keys(timeline, locate(timeline, t), mode, &easing);
      const Status status = blend_vertices(std::span(sources).first(blend.count), std::span(blend.weight).first(blend.count),
                                           blend.nearest, {positions, normals, tangents});
      all_succeeded = all_succeeded && status;
    }
  }
  all_succeeded = all_succeeded && compute_normals(stream, indices, normals);
  all_succeeded = all_succeeded && compute_tangents(stream, normals, texcoords, indices, tangents);
  EXPECT_EQ(test::allocations(), before);
  EXPECT_TRUE(all_succeeded);
}

TEST(Allocation, PlayingASkeletonTakesNoMemory) {
  RandomTracks random(1);
  std::vector<reference::Track> tracks;
  std::vector<TrackSource> sources;
  const std::vector<double> shared_times = random.times_s(9, 2.0, true);
  for (std::uint32_t joint = 0; joint < 40; ++joint) {
    const std::vector<double> own_times = random.times_s(5, 2.0, false);
    tracks.push_back(random.track({joint, Property::Rotation}, shared_times, {{Interpolation::Linear, {}}}));
    tracks.push_back(random.track({joint, Property::Translation}, own_times, random.modes(5)));
  }
  for (const reference::Track& track : tracks) sources.push_back(track.source());
  const TrackSet set(sources, 2.0, true);
  Pose pose, rest;
  pose.reset(40, 2);
  rest.reset(40, 2);
  const std::vector<float> mask(40, 0.5F);
  std::vector<std::int32_t> parents(40, 0);
  parents[0] = -1;
  std::vector<Affine> palette(40);
  const std::vector<std::uint16_t> entries(400, 3);
  const std::vector<float> weights(400, 0.25F);
  const std::vector<float> stream(300, 0.5F);
  std::vector<float> positions(300), normals(300);
  const std::array targets{MorphTargetView{10, 90, {std::span(stream).first(270), std::span(stream).first(270), {}}},
                           MorphTargetView{0, 100, {stream, stream, {}}}};
  bool all_succeeded = true;

  const std::size_t before = test::allocations();
  for (int i = 0; i <= 20; ++i) {
    pose.reset(40, 2);
    set.sample(i / 10.0, Interpolation::CatmullRom, pose);
    blend_poses(rest, 0.3F, mask, pose);
    add_pose(rest, rest, 0.3F, {}, pose);
    local_to_model(parents, pose, palette);
    const auto status = skin_vertices({4, entries, weights}, palette, {stream, stream, {}}, {positions, normals, {}});
    all_succeeded = all_succeeded && status;
    morph_vertices(targets, std::array{0.5F, 0.25F}, {positions, normals, {}});
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_TRUE(all_succeeded);
}

}  // namespace
}  // namespace tweend::animation
