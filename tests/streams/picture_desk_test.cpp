#include "server/streams/picture_desk.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tests/streams/picturing.hpp"

namespace tweend::streams {
namespace {

using test::from_above;
using test::scene_of;
using test::square_actor;
using test::Streaming;

/// Notes what it was told.
class NotingUser final : public PictureUser {
 public:
  void drawn(const Result<render::PixelsPtr>& pixels) override {
    done.set_value(pixels);
    if (then) then();
  }
  Result<render::PixelsPtr> wait() {
    auto future = done.get_future();
    EXPECT_EQ(future.wait_for(test::kPatience), std::future_status::ready);
    return future.get();
  }
  std::promise<Result<render::PixelsPtr>> done;
  std::function<void()> then;  ///< on the strand
};

class Desk : public testing::Test {
 protected:
  void SetUp() override {
    if (!s_.renderer.device()) GTEST_SKIP() << s_.renderer.device().error().message;
  }
  void TearDown() override { s_.settle(); }  // the strand may still be at the end of telling somebody
  template <class Act>
  void on_strand(Act act) {
    s_.stage->post(act);
    s_.settle();
  }
  std::shared_ptr<NotingUser> order(const MomentPtr& moment, render::Size size,
                                    const std::optional<model::CameraRequest>& camera = {}) {
    auto user = std::make_shared<NotingUser>();
    desk_.draw(moment, camera, size, 0, user);
    return user;
  }

  Streaming s_{
      {scene_of("main", {square_actor("square")}), scene_of("aside", {square_actor("square")})}, 2, render::RenderOptions{}};
  PictureDesk desk_{s_.stage->strand(), s_.workers, s_.renderer};
};

TEST_F(Desk, ReadsAMomentOnceForAllThatHaveIt) {
  on_strand([this] {
    const stage::SceneViewPtr view = s_.stage.view();
    const MomentPtr first = desk_.moment(view, 1'000);
    EXPECT_EQ(desk_.moment(view, 1'000), first);
    EXPECT_NE(desk_.moment(view, 2'000), first) << "another reading";
    EXPECT_NE(desk_.moment(s_.stage.view("aside"), 1'000), first) << "another scene";
    EXPECT_EQ(first->show.at_us, 1'000);
    EXPECT_EQ(first->show.scene, view->scene);
  });
}

TEST_F(Desk, UsesTheMemoryOfMomentsThatNobodyHas) {
  on_strand([this] {
    const stage::SceneViewPtr view = s_.stage.view();
    const SceneMoment* const first = desk_.moment(view, 1'000).get();
    EXPECT_EQ(desk_.moment(view, 2'000).get(), first);
  });
}

TEST_F(Desk, DrawsAPictureOnceForAllWhoLookTheSameWay) {
  std::vector<std::shared_ptr<NotingUser>> users;
  on_strand([&] {
    const MomentPtr moment = desk_.moment(s_.stage.view(), 1'000);
    users = {order(moment, {64, 48}), order(moment, {64, 48}), order(moment, {32, 24}), order(moment, {64, 48}, from_above())};
  });
  std::vector<render::PixelsPtr> pixels;
  for (const auto& user : users) {
    const auto drawn = user->wait();
    ASSERT_TRUE(drawn) << drawn.error().message;
    pixels.push_back(*drawn);
  }
  EXPECT_EQ(pixels[0], pixels[1]);
  EXPECT_NE(pixels[0], pixels[2]);
  EXPECT_NE(pixels[0], pixels[3]);
  EXPECT_EQ(pixels[2]->view().size, (render::Size{32, 24}));
  EXPECT_EQ(pixels[3]->view().size, (render::Size{64, 48}));
  // What is shared is what each would have been given alone.
  const auto alone = test::picture_of(s_, test::seen_by(test::frames_of("main"), from_above()), s_.stage.view(), 1'000);
  EXPECT_EQ(test::mean_difference(test::decoded(pixels[3]->view()), alone), 0.0);
  pixels.clear();
  users.clear();
}

// Whose picture can't be made ends its stream, and with that the desk is trimmed.
TEST_F(Desk, TellsAllWhoWaitAsItStopsThoughTheyHaveItTrimmedMeanwhile) {
  std::vector<std::shared_ptr<NotingUser>> users;
  on_strand([&] {
    const MomentPtr moment = desk_.moment(s_.stage.view(), 1'000);
    for (const std::uint32_t width : {64U, 32U, 16U, 8U}) {
      users.push_back(order(moment, {width, 24}));
      users.back()->then = [this] { desk_.trim(); };
    }
    desk_.stop();  // before the moment is composed: that is told on the strand
  });
  EXPECT_TRUE(users[0]->wait()) << "it was on its way";
  for (std::size_t i = 1; i < users.size(); ++i) EXPECT_FALSE(users[i]->wait()) << i;
}

TEST_F(Desk, LetsGoOfWhatNobodyUses) {
  std::weak_ptr<SceneMoment> kept, dropped;
  MomentPtr held;
  on_strand([&] {
    held = desk_.moment(s_.stage.view(), 1'000);
    kept = held;
    dropped = desk_.moment(s_.stage.view(), 2'000);
    desk_.trim();
  });
  EXPECT_FALSE(kept.expired());
  EXPECT_TRUE(dropped.expired());
  on_strand([&] { held.reset(); });
}

}  // namespace
}  // namespace tweend::streams
