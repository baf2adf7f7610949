#include "server/streams/clip_film.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/h264_encoder.hpp"
#include "server/streams/film_range.hpp"
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

TEST(FilmRange, EndsWithItsClipUnlessItSaysWhere) {
  EXPECT_EQ(*pictures_of({0.5, {}, 30.0}, 2.0, 45, "--"), 45U);
  EXPECT_EQ(*pictures_of({2.0, {}, 30.0}, 2.0, 45, "--"), 1U);
  EXPECT_EQ(*pictures_of({5.0, 5.1, 30.0}, 2.0, 45, "--"), 3U);
}

TEST(FilmRange, SaysWhichEndIsWrong) {
  const auto backwards = pictures_of({5.0, 1.0, 30.0}, 2.0, 45, "--");
  ASSERT_FALSE(backwards);
  EXPECT_EQ(backwards.error(),
            fail(ErrorCode::InvalidParams, "expected a time from 5 on, where the film begins, found 1", "--to"));
  const auto beyond = pictures_of({5.0, {}, 30.0}, 2.0, 45, "params.");
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().path, "params.from");
  EXPECT_NE(beyond.error().message.find("up to 2, where the clip ends, found 5"), std::string::npos) << beyond.error().message;
}

TEST(FilmRange, HasSoManyPicturesAtMost) {
  EXPECT_EQ(*pictures_of({0.0, 4.499, 10.0}, 0.0, 45, ""), 45U);
  for (const double to_s : {4.55, 5.0, 1e300}) {
    const auto none = pictures_of({0.0, to_s, 10.0}, 0.0, 45, "");
    ASSERT_FALSE(none) << to_s;
    EXPECT_EQ(none.error().code, ErrorCode::Limit);
    EXPECT_LT(none.error().message.size(), 120U) << none.error().message;
  }
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
  std::shared_ptr<FilmQueue> films = std::make_shared<FilmQueue>(s.workers, s.renderer, limits);
  std::shared_ptr<int> interest = std::make_shared<int>();
  ~Films() override {
    if (films) films->stop();
  }
  void SetUp() override {
    if (!s.renderer.device()) GTEST_SKIP() << s.renderer.device().error().message;
    if (!render::has_h264()) GTEST_SKIP() << "built without H.264";
  }
  ClipFilm film(std::size_t pictures) {
    return {s.stage.view(), 0.0, 30.0, pictures, test::kSmall, test::from_above(), steady_now_us()};
  }
  using Made = std::future<Result<MadeFilm>>;
  Made make(ClipFilm film) {
    auto promise = std::make_shared<std::promise<Result<MadeFilm>>>();
    const Status taken =
        films->make(std::move(film), interest, [promise](Result<MadeFilm> m) { promise->set_value(std::move(m)); });
    if (!taken) promise->set_value(taken.error());
    return promise->get_future();
  }
};

bool is_there(const std::future<Result<MadeFilm>>& film) {
  return film.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

TEST_F(Films, AreFilesOneAfterAnother) {
  auto first = make(film(20)), second = make(film(20)), third = make(film(3));
  const auto a = first.get(), b = second.get(), c = third.get();
  ASSERT_TRUE(a && b && c);
  EXPECT_NE(a->file.find("ftyp"), std::string::npos);
  EXPECT_EQ(a->file, b->file);
  EXPECT_LT(c->file.size(), a->file.size());
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
  auto unwanted = make(film(1'000'000));
  interest.reset();
  EXPECT_EQ(unwanted.get().error().code, ErrorCode::Unavailable);
  interest = std::make_shared<int>();
  EXPECT_TRUE(make(film(2)).get());
}

TEST_F(Films, NobodyWaitsForGiveTheirPlacesToOthers) {
  auto under_way = make(film(1'000'000));
  auto kept = std::exchange(interest, std::make_shared<int>());
  std::vector<Made> waiting;
  for (std::size_t k = 0; k < FilmQueue::kWaiting; ++k) waiting.push_back(make(film(2)));
  EXPECT_EQ(make(film(2)).get().error().code, ErrorCode::Unavailable) << "one too many";
  interest = std::move(kept);  // and nobody has that of those that wait
  auto next = make(film(2));
  for (auto& one : waiting) EXPECT_EQ(one.get().error().code, ErrorCode::Unavailable) << "while the first is under way";
  EXPECT_FALSE(is_there(under_way));
  EXPECT_FALSE(is_there(next));
  films->stop();
  EXPECT_EQ(next.get().error().code, ErrorCode::Unavailable) << "it waited";
}

TEST_F(Films, AreSoManyInMemoryAtMost) {
  std::vector<MadeFilm> held;
  for (std::size_t k = 0; k < FilmQueue::kPlaces; ++k) held.push_back(std::move(*make(film(1)).get()));
  auto next = make(film(1)), after = make(film(1));
  ClipFilm odd = film(1);
  odd.size = {33, 20};
  auto refused = make(std::move(odd));
  EXPECT_FALSE(is_there(next));
  held.pop_back();
  held.push_back(std::move(*next.get()));
  EXPECT_FALSE(is_there(after)) << "all places are taken again";
  held.erase(held.begin());
  held.push_back(std::move(*after.get()));
  EXPECT_FALSE(is_there(refused));
  held.pop_back();
  EXPECT_EQ(refused.get().error().code, ErrorCode::InvalidParams);
  EXPECT_TRUE(make(film(1)).get()) << "what is not made keeps no place";
}

TEST_F(Films, KeepTheirPlacesBeyondTheQueue) {
  const std::weak_ptr<FilmQueue> queue = films;
  auto held = make(film(1)).get();
  ASSERT_TRUE(held);
  films->stop();
  films.reset();
  s.renderer.stop();
  s.workers.stop();  // the film's maker, which ends where it ran, has let go of the queue
  EXPECT_FALSE(queue.expired());
  held->place.reset();
  EXPECT_TRUE(queue.expired());
}

TEST_F(Films, HaveSoManyBytesAtMost) {
  const auto whole = make(film(20)).get();
  ASSERT_TRUE(whole);
  limits.film_bytes = whole->file.size();
  EXPECT_TRUE(make(film(20)).get());
  for (const std::size_t most : {whole->file.size() - 1, std::size_t{100}}) {
    limits.film_bytes = most;
    const auto refused = make(film(20)).get();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::Limit);
    EXPECT_NE(refused.error().message.find(std::to_string(most) + " bytes"), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().message.find("ask for part"), std::string::npos) << refused.error().message;
  }
}

TEST_F(Films, AreGivenUpWhenTheServerStops) {
  auto under_way = make(film(1'000'000)), waiting = make(film(5));
  films->stop();
  films->stop();
  EXPECT_EQ(under_way.get().error().code, ErrorCode::Unavailable);
  EXPECT_EQ(waiting.get().error().code, ErrorCode::Unavailable);
  EXPECT_EQ(make(film(5)).get().error().code, ErrorCode::Unavailable);
}

}  // namespace
}  // namespace tweend::streams
