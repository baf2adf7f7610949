#include "server/streams/recorded_views.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "tests/support/scenes.hpp"

namespace tweend::streams {
namespace {

using Next = FilmSource::Next;
using stage::SceneView;
using stage::SceneViewPtr;

constexpr ClockUs kStartUs = 1'000'000'000;
constexpr ClockUs kLate = kStartUs + 1'000'000'000;

/// A scene with one actor, told apart by the serial; `players` turned at `anchor_us`.
SceneViewPtr view_of(const model::ScenePtr& scene, std::uint64_t serial, ClockUs anchor_us) {
  auto players = std::make_shared<stage::Players>(1);
  (*players)[0].actor = "square";
  (*players)[0].clip = "default";
  (*players)[0].playing = true;
  (*players)[0].anchor_us = anchor_us;
  return std::make_shared<SceneView>(SceneView{scene, std::move(players), serial});
}
model::ScenePtr scene() { return test::scene_of("main", {test::square_actor("square")}); }

ClockUs at(std::size_t picture, double fps) { return kStartUs + std::llround(static_cast<double>(picture) * 1e6 / fps); }

TEST(RecordedViews, ShowEachPictureAtItsExactReading) {
  for (const double fps : {30.0, 29.97, 240.0, 0.5, 1e6 / 3.0}) {
    const SceneViewPtr view = view_of(scene(), 1, kStartUs);
    RecordedViews views(view, kStartUs, fps, 100);
    views.settled(kLate);
    stage::Show show;
    for (std::size_t k = 0; k < 100; ++k) {
      ASSERT_EQ(views.next(show), Next::Picture) << k;
      EXPECT_EQ(show.at_us, at(k, fps));
    }
    EXPECT_EQ(views.next(show), Next::End) << "there are no more than were allowed";
  }
}

TEST(RecordedViews, WaitUntilWhatIsShownIsKnown) {
  RecordedViews views(view_of(scene(), 1, kStartUs), kStartUs, 10.0, 100);
  stage::Show show;
  EXPECT_EQ(views.next(show), Next::Later);
  views.settled(kStartUs);
  EXPECT_EQ(views.next(show), Next::Later) << "somebody may act for this very reading";
  views.settled(kStartUs + 1);
  EXPECT_EQ(views.next(show), Next::Picture);
  EXPECT_EQ(views.next(show), Next::Later);
}

TEST(RecordedViews, TakeNoMoreThanSoManyThatWait) {
  const model::ScenePtr document = scene();
  RecordedViews views(view_of(document, 0, kStartUs), kStartUs, 1'000.0, 100'000);
  const auto at_us = [](std::size_t k) { return kStartUs + 1'000 * static_cast<ClockUs>(k); };
  for (std::size_t k = 1; k < RecordedViews::kMostKept; ++k) ASSERT_TRUE(views.add(view_of(document, k, at_us(k)), at_us(k)));
  EXPECT_FALSE(views.add(view_of(document, 1, at_us(RecordedViews::kMostKept)), at_us(RecordedViews::kMostKept)));
  EXPECT_EQ(views.kept(), RecordedViews::kMostKept);
  views.settled(at_us(3));
  stage::Show show;
  for (int i = 0; i < 3; ++i) ASSERT_EQ(views.next(show), Next::Picture);
  EXPECT_TRUE(views.add(view_of(document, 1, at_us(RecordedViews::kMostKept)), at_us(RecordedViews::kMostKept)));
}

TEST(RecordedViews, EndWithTheLastReadingThatIsNotLater) {
  RecordedViews views(view_of(scene(), 1, kStartUs), kStartUs, 10.0, 100);
  views.end(kStartUs + 200'000);
  views.end(kStartUs + 900'000);  // it has ended already
  stage::Show show;
  for (std::size_t k = 0; k <= 2; ++k) EXPECT_EQ(views.next(show), Next::Picture) << k;
  EXPECT_EQ(views.next(show), Next::End);
}

TEST(RecordedViews, GivenUpEndAtOnce) {
  RecordedViews views(view_of(scene(), 1, kStartUs), kStartUs, 10.0, 100);
  views.give_up();
  stage::Show show;
  EXPECT_EQ(views.next(show), Next::End);
}

TEST(RecordedViews, ATurnOfThePlayersCountsFromItsReadingAndAnEditFromNow) {
  const model::ScenePtr first = scene(), second = scene();
  const SceneViewPtr before = view_of(first, 1, 100);
  EXPECT_EQ(holds_from_us(*before, *view_of(first, 2, 400), 500), 400);
  EXPECT_EQ(holds_from_us(*before, *view_of(second, 2, 400), 500), 500);
  EXPECT_EQ(holds_from_us(*before, *view_of(first, 2, 100), 500), 500) << "nothing of a player's has changed";
  EXPECT_EQ(holds_from_us(*before, *view_of(first, 2, 900), 500), 500) << "never later than now";
  auto live = std::make_shared<stage::Players>(*before->players);
  (*live)[0].jumps = 7;
  EXPECT_EQ(holds_from_us(*before, SceneView{first, live, 2}, 500), 500) << "changed without a new anchor";
}

TEST(RecordedViews, ShowTheNewestViewThatHolds) {
  std::mt19937 random(3);
  const model::ScenePtr document = scene();
  for (int round = 0; round < 50; ++round) {
    const double fps = std::uniform_real_distribution(5.0, 60.0)(random);
    std::vector<std::pair<ClockUs, SceneViewPtr>> all{{0, view_of(document, 0, kStartUs)}};
    RecordedViews views(all[0].second, kStartUs, fps, 1'000);
    ClockUs now_us = kStartUs;
    for (std::uint64_t serial = 1; serial < 200; ++serial) {
      now_us += std::uniform_int_distribution<ClockUs>(1, 20'000)(random);
      all.emplace_back(now_us, view_of(document, serial, now_us));
      ASSERT_TRUE(views.add(all.back().second, now_us + 500));
    }
    views.end(now_us);
    stage::Show show;
    for (std::size_t k = 0; at(k, fps) <= now_us; ++k) {
      ASSERT_EQ(views.next(show), Next::Picture);
      const auto newest = std::find_if(all.rbegin(), all.rend(), [&](const auto& v) { return v.first <= at(k, fps); });
      const stage::Show want = stage::show_at(*newest->second, at(k, fps));
      ASSERT_EQ(show.actors[0].time_s, want.actors[0].time_s) << k;
    }
    ASSERT_EQ(views.next(show), Next::End);
  }
}

TEST(RecordedViews, TakeARateThatIsNoneForTheSlowest) {
  const model::ScenePtr document = scene();
  for (const double fps : {1e-13, 0.0, -1.0, kSlowestFilm}) {
    RecordedViews views(view_of(document, 0, kStartUs), kStartUs, fps, 100);
    for (ClockUs k = 1; k <= 3; ++k) {
      ASSERT_TRUE(views.add(view_of(document, static_cast<std::uint64_t>(k), kStartUs + 900 * k), kStartUs + 900 * k));
    }
    views.end(kStartUs + 2'000'000'000);
    stage::Show show;
    for (const ClockUs after_us : {0, 1'000'000'000, 2'000'000'000}) {
      ASSERT_EQ(views.next(show), Next::Picture);
      EXPECT_EQ(show.at_us, kStartUs + after_us);
    }
    EXPECT_EQ(views.next(show), Next::End);
  }
}

TEST(RecordedViews, KeepNoMoreThanThePicturesTake) {
  const model::ScenePtr document = scene();
  RecordedViews views(view_of(document, 0, kStartUs), kStartUs, 10.0, 1'000);
  for (ClockUs k = 1; k <= 10'000; ++k) {
    ASSERT_TRUE(views.add(view_of(document, static_cast<std::uint64_t>(k), kStartUs + 100 * k), kStartUs + 100 * k));
  }
  // A second of it: eleven readings, and what holds now.
  EXPECT_LE(views.kept(), 12U);
}

}  // namespace
}  // namespace tweend::streams
