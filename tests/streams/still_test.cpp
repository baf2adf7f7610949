#include "server/streams/still.hpp"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/streams/picturing.hpp"

namespace tweend::streams {
namespace {

using test::Decoded;
using test::kSmall;
using test::scene_of;
using test::square_actor;
using test::Streaming;

/// A long clip that spins beside a short one.
model::ScenePtr two_clips() {
  auto spinning = std::make_shared<model::Actor>(*square_actor("long", {{.keys = 4}}));
  spinning->settings = test::with_spin(1.0);
  auto beside = std::make_shared<model::Actor>(*square_actor("short", {{.keys = 2}}));
  beside->settings.transform.translation.x = 1.5F;
  return scene_of("main", {spinning, beside});
}

StillRequest request_of(Streaming& s) {
  StillRequest request;
  request.view = s.stage.view();
  request.now_us = steady_now_us();
  request.size = kSmall;
  request.camera = test::from_above();
  return request;
}

Result<Still> render(Streaming& s, StillRequest request) {
  std::promise<Result<Still>> promise;
  render_still(std::move(request), s.workers, s.renderer,
               [&promise](Result<Still> still) { promise.set_value(std::move(still)); });
  return promise.get_future().get();
}

Decoded png(Streaming& s, StillRequest request) {
  const Result<Still> still = render(s, std::move(request));
  EXPECT_TRUE(still);
  return still ? test::decode_png(still->file) : Decoded{};
}

class Stills : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    streaming_ = std::make_unique<Streaming>(std::vector{two_clips()}, 2, render::RenderOptions{});
  }
  static void TearDownTestSuite() { streaming_.reset(); }
  void SetUp() override {
    if (!s_.renderer.device()) GTEST_SKIP() << s_.renderer.device().error().message;
  }
  void TearDown() override {
    s_.stage.act([](stage::Player& player, const stage::PlayRange& range, ClockUs now_us) { player.stop(range, now_us); });
  }
  Streaming& s_ = *streaming_;

 private:
  static inline std::unique_ptr<Streaming> streaming_;
};

TEST(StillsWithoutADevice, AreRefusedWithTheReason) {
  Streaming s({two_clips()});
  const Result<Still> still = render(s, request_of(s));
  ASSERT_FALSE(still);
  EXPECT_EQ(still.error().code, ErrorCode::Unavailable);
  EXPECT_NE(still.error().message.find("--no-render"), std::string::npos);
}

TEST_F(Stills, AreRefusedWhereTheyAreTooLarge) {
  StillRequest request = request_of(s_);
  request.size = {10, 100'000};
  const Result<Still> still = render(s_, request);
  ASSERT_FALSE(still);
  EXPECT_EQ(still.error().code, ErrorCode::Limit);
  EXPECT_NE(still.error().message.find("found 10 x 100000"), std::string::npos) << still.error().message;
}

TEST_F(Stills, AreFilesOfTheirFormat) {
  StillRequest request = request_of(s_);
  const Decoded drawn = png(s_, request);
  EXPECT_EQ(drawn.size, kSmall);
  EXPECT_GT(test::covered(drawn), 50U);
  request.format = ImageFormat::Jpeg;
  request.quality = 95;
  const Result<Still> fine = render(s_, request);
  ASSERT_TRUE(fine);
  EXPECT_LT(test::mean_difference(test::decode_jpeg(fine->file), drawn), 2.0);
  request.quality = 5;
  const Result<Still> coarse = render(s_, request);
  ASSERT_TRUE(coarse);
  EXPECT_LT(coarse->file.size(), fine->file.size());
}

TEST_F(Stills, ShowATimeWithoutSpinThoughTheActorHasTurned) {
  StillRequest at = request_of(s_);
  at.time_s = 0.5;
  const Decoded before = png(s_, at);
  s_.stage.act([](stage::Player& player, const stage::PlayRange& range, ClockUs now_us) { player.play(range, now_us); });
  const stage::SceneViewPtr playing = s_.stage.view();
  StillRequest live = request_of(s_);
  live.view = playing;
  live.now_us = playing->players->front().anchor_us + 500'000;
  at.view = playing;
  at.now_us = live.now_us;
  EXPECT_EQ(test::mean_difference(png(s_, at), before), 0.0);
  const Result<Still> shown = render(s_, live);
  ASSERT_TRUE(shown);
  EXPECT_DOUBLE_EQ(shown->time_s, 0.5);
  EXPECT_GT(test::mean_difference(test::decode_png(shown->file), before), 0.1) << "live, half a second's spin is in it";
}

TEST_F(Stills, ClampTheTimeToEachActorsOwnClip) {
  StillRequest request = request_of(s_);
  std::vector<Decoded> pictures;
  for (const double time_s : {1.0, 2.0, 3.0, 100.0, -5.0, 0.0}) {
    request.time_s = time_s;
    const Result<Still> still = render(s_, request);
    ASSERT_TRUE(still);
    EXPECT_DOUBLE_EQ(still->time_s, std::clamp(time_s, 0.0, 3.0)) << "the first actor's";
    pictures.push_back(test::decode_png(still->file));
  }
  EXPECT_GT(test::mean_difference(pictures[0], pictures[1]), 0.0) << "the long clip goes on behind the short one's end";
  EXPECT_GT(test::mean_difference(pictures[1], pictures[2]), 0.0);
  EXPECT_EQ(test::mean_difference(pictures[2], pictures[3]), 0.0);
  EXPECT_EQ(test::mean_difference(pictures[4], pictures[5]), 0.0);
}

TEST_F(Stills, AreTheSameFilesWheneverTheyAreDrawn) {
  StillRequest request = request_of(s_);
  request.time_s = 1.25;
  const Result<Still> first = render(s_, request), second = render(s_, request);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->file, second->file);
}

TEST_F(Stills, OfManyAtOnceAllCome) {
  constexpr int kMany = 30;
  std::vector<std::future<Result<Still>>> futures;
  for (int i = 0; i < kMany; ++i) {
    const auto promise = std::make_shared<std::promise<Result<Still>>>();
    futures.push_back(promise->get_future());
    StillRequest request = request_of(s_);
    request.time_s = 0.1 * i;
    render_still(std::move(request), s_.workers, s_.renderer,
                 [promise](Result<Still> still) { promise->set_value(std::move(still)); });
  }
  for (int i = 0; i < kMany; ++i) {
    const Result<Still> still = futures[static_cast<std::size_t>(i)].get();
    ASSERT_TRUE(still);
    EXPECT_DOUBLE_EQ(still->time_s, 0.1 * i);
  }
}

}  // namespace
}  // namespace tweend::streams
