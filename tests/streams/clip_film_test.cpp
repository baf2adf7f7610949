#include "server/streams/clip_film.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/h264_encoder.hpp"
#include "tests/streams/picturing.hpp"

namespace tweend::streams {
namespace {

using test::Streaming;

TEST(FilmPictures, AreThoseOfAHalfOpenStretchAndAtLeastOne) {
  EXPECT_EQ(film_pictures(0.0, 1.0, 30.0), 30U);
  EXPECT_EQ(film_pictures(0.5, 1.0, 30.0), 15U);
  EXPECT_EQ(film_pictures(0.0, 5.0 / 3.0, 60.0), 100U);
  EXPECT_EQ(film_pictures(0.0, 0.0, 30.0), 1U);
  EXPECT_EQ(film_pictures(0.0, 0.001, 30.0), 1U);
  EXPECT_EQ(film_pictures(0.0, 10.0, 29.97), 300U);
}

TEST(ClipSource, ShowsTheClipAtTimesOfItsOwn) {
  test::RunningStage stage({test::scene_of("main", {test::square_actor("square", {{.keys = 3}})})});
  stage.start();
  ClipSource source(stage.view(), 0.5, 4.0, 8, steady_now_us());
  stage::Show show;
  for (std::size_t k = 0; k < 8; ++k) {
    ASSERT_EQ(source.next(show), FilmSource::Next::Picture);
    EXPECT_EQ(show.actors[0].time_s, std::min(2.0, 0.5 + static_cast<double>(k) / 4.0)) << "clamped to the clip";
  }
  EXPECT_EQ(source.next(show), FilmSource::Next::End);
}

struct Films : testing::Test {
  Streaming s{{test::scene_of("main", {test::square_actor("square", {{.keys = 3}})})}, 2, render::RenderOptions{}};
  Limits limits;
  FilmQueue films{s.workers, s.renderer, limits};
  std::shared_ptr<int> interest = std::make_shared<int>();
  ~Films() override { films.stop(); }
  void SetUp() override {
    if (!s.renderer.device()) GTEST_SKIP() << s.renderer.device().error().message;
    if (!render::has_h264()) GTEST_SKIP() << "built without H.264";
  }
  ClipFilm film(std::size_t pictures) {
    return {s.stage.view(), 0.0, 30.0, pictures, test::kSmall, test::from_above(), steady_now_us()};
  }
  std::future<Result<std::string>> make(ClipFilm film) {
    auto promise = std::make_shared<std::promise<Result<std::string>>>();
    films.make(std::move(film), interest, [promise](Result<std::string> file) { promise->set_value(std::move(file)); });
    return promise->get_future();
  }
};

TEST_F(Films, AreFilesOneAfterAnother) {
  auto first = make(film(20)), second = make(film(20)), third = make(film(3));
  const auto a = first.get(), b = second.get(), c = third.get();
  ASSERT_TRUE(a && b && c);
  EXPECT_NE(a->find("ftyp"), std::string::npos);
  EXPECT_EQ(*a, *b);
  EXPECT_LT(c->size(), a->size());
}

TEST_F(Films, SayWhatTheEncoderRefuses) {
  ClipFilm odd = film(3);
  odd.size = {33, 20};
  const auto refused = make(std::move(odd)).get();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::InvalidParams);
  EXPECT_TRUE(make(film(2)).get()) << "and go on";
}

TEST_F(Films, NobodyWaitsForAreNotMade) {
  auto unwanted = make(film(1'000'000'000));
  interest.reset();
  EXPECT_EQ(unwanted.get().error().code, ErrorCode::Unavailable);
  interest = std::make_shared<int>();
  EXPECT_TRUE(make(film(2)).get());
}

TEST_F(Films, NobodyWaitsForGiveTheirPlacesToOthers) {
  auto under_way = make(film(1'000'000'000));
  auto kept = std::exchange(interest, std::make_shared<int>());
  std::vector<std::future<Result<std::string>>> waiting;
  for (std::size_t k = 0; k < FilmQueue::kWaiting; ++k) waiting.push_back(make(film(2)));
  EXPECT_EQ(make(film(2)).get().error().code, ErrorCode::Limit);
  interest = std::move(kept);  // and nobody has that of those that wait
  auto next = make(film(2));
  for (auto& one : waiting) EXPECT_EQ(one.get().error().code, ErrorCode::Unavailable) << "while the first is under way";
  EXPECT_NE(under_way.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  films.stop();
  EXPECT_EQ(next.get().error().code, ErrorCode::Unavailable) << "it waited";
}

TEST_F(Films, HaveSoManyBytesAtMost) {
  const auto whole = make(film(20)).get();
  ASSERT_TRUE(whole);
  limits.film_bytes = whole->size();
  EXPECT_TRUE(make(film(20)).get());
  for (const std::size_t most : {whole->size() - 1, std::size_t{100}}) {
    limits.film_bytes = most;
    const auto refused = make(film(20)).get();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::Limit);
    EXPECT_NE(refused.error().message.find(std::to_string(most) + " bytes"), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().message.find("ask for part"), std::string::npos) << refused.error().message;
  }
}

TEST_F(Films, AreGivenUpWhenTheServerStops) {
  auto under_way = make(film(1'000'000'000)), waiting = make(film(5));
  films.stop();
  films.stop();
  EXPECT_EQ(under_way.get().error().code, ErrorCode::Unavailable);
  EXPECT_EQ(waiting.get().error().code, ErrorCode::Unavailable);
  EXPECT_EQ(make(film(5)).get().error().code, ErrorCode::Unavailable);
}

}  // namespace
}  // namespace tweend::streams
