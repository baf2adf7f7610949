#include "server/streams/frame_composer.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tests/streams/picturing.hpp"
#include "tests/support/allocations.hpp"

namespace tweend::streams {
namespace {

using test::scene_of;
using test::square_actor;

constexpr render::Size kWide{200, 100};

std::shared_ptr<model::Actor> changed(const model::ActorPtr& actor) { return std::make_shared<model::Actor>(*actor); }

model::ActorPtr with_mode(const model::ActorPtr& actor, animation::Interpolation mode) {
  const auto next = changed(actor);
  next->settings.interpolation = mode;
  return next;
}

/// What a scene shows with each actor's first clip at one time.
stage::Show show_of(std::vector<model::ActorPtr> actors, double time_s) {
  stage::Show show;
  const model::ScenePtr scene = scene_of("main", std::move(actors));
  show.scene = scene;
  for (const model::ActorPtr& actor : scene->actors) {
    const model::ClipPtr& clip = actor->clips.front();
    show.actors.push_back({actor, clip, time_s, model::shown_clip(clip, time_s), 0.0, false, false, 0});
  }
  return show;
}

render::Picture composed(const stage::Show& show, const std::optional<model::CameraRequest>& camera = {},
                         render::Size size = kWide) {
  render::Picture picture;
  FrameComposer().compose(show, camera, size, picture);
  return picture;
}

render::ResourceId id_of(const model::ContentHash& hash) { return {hash.high, hash.low}; }

render::View view_of(const model::Camera& camera, float aspect) {
  return {model::view_from_world(camera), model::clip_from_view(camera, aspect), camera.eye, 0.0F};
}

void expect_view(const render::View& got, const model::Camera& camera, float aspect) {
  const render::View want = view_of(camera, aspect);
  EXPECT_EQ(got.view_from_world, want.view_from_world);
  EXPECT_EQ(got.clip_from_view, want.clip_from_view);
  EXPECT_EQ(got.eye, want.eye);
}

TEST(FrameComposer, BlendsTheKeyframesThatTheDocumentSays) {
  const model::ActorPtr actor = square_actor("square", {{.keys = 5}});
  for (const auto mode :
       {animation::Interpolation::Step, animation::Interpolation::Linear, animation::Interpolation::CatmullRom}) {
    const model::ActorPtr moded = with_mode(actor, mode);
    const model::Clip& clip = *moded->clips.front();
    for (const double time_s : {0.0, 0.3, 1.0, 1.5, 2.75, 4.0}) {
      const render::Picture picture = composed(show_of({moded}, time_s));
      ASSERT_EQ(picture.items.size(), 1U);
      const render::DrawItem& item = picture.items[0];
      const animation::KeyBlend want = model::blend_at(*moded, clip, time_s);
      ASSERT_EQ(item.key_count, want.count);
      EXPECT_EQ(item.weight, want.weight);
      EXPECT_EQ(item.nearest, want.nearest);
      EXPECT_EQ(item.keys_expected, 5U);
      for (std::uint32_t i = 0; i < want.count; ++i) {
        const model::VertexKey& key = *clip.keyframes[want.key[i]].vertices;
        EXPECT_EQ(item.key[i].id, id_of(key.hash()));
        EXPECT_EQ(item.key[i].block.data(), key.block().data()) << "no vertex is copied";
        EXPECT_EQ(item.key[i].block.size(), key.block().size());
      }
    }
  }
}

TEST(FrameComposer, ShowsTheRestShapeOfAnEmptyClip) {
  const model::ActorPtr actor = square_actor("square", {{.keys = 0}});
  const render::Picture picture = composed(show_of({actor}, 0.0));
  ASSERT_EQ(picture.items.size(), 1U);
  EXPECT_EQ(picture.items[0].key_count, 1U);
  EXPECT_EQ(picture.items[0].weight[0], 1.0F);
  EXPECT_EQ(picture.items[0].key[0].block.data(), actor->model->rest->block().data());
}

TEST(FrameComposer, LeavesOutWhatIsHidden) {
  const auto hidden = changed(square_actor("hidden"));
  hidden->settings = test::with_visible(false);
  const model::ActorPtr shown = square_actor("shown");
  const render::Picture picture = composed(show_of({hidden, shown, hidden}, 0.0));
  ASSERT_EQ(picture.items.size(), 1U);
  EXPECT_EQ(picture.items[0].key[0].block.data(), shown->clips.front()->keyframes.front().vertices->block().data());
  EXPECT_TRUE(composed(show_of({hidden}, 0.0)).items.empty());
}

TEST(FrameComposer, PutsAnActorWhereItStandsTurnedByItsSpin) {
  const auto actor = changed(square_actor("square"));
  actor->settings.transform.translation = {1.0F, 2.0F, 3.0F};
  actor->settings.transform.scale = glm::vec3(2.0F);
  stage::Show show = show_of({actor}, 0.0);
  show.actors[0].spin_angle_rad = 1.25;
  EXPECT_EQ(composed(show).items[0].world_from_model, model::world_from_model(actor->settings.transform, 1.25));
}

TEST(FrameComposer, TakesLightBackgroundAndGridFromTheScene) {
  stage::Show show = show_of({square_actor("square")}, 0.0);
  model::Scene scene = *show.scene;
  scene.settings.light = {{1, 2, 3}, 0.1F, 0.2F, 0.3F, 4.0F};
  scene.settings.background = {0.5F, 0.6F, 0.7F};
  scene.settings.grid = true;
  show.scene = std::make_shared<const model::Scene>(scene);
  const render::Picture picture = composed(show);
  EXPECT_EQ(picture.size, kWide);
  EXPECT_EQ(picture.light.position, glm::vec3(1, 2, 3));
  EXPECT_EQ(picture.light.ambient, 0.1F);
  EXPECT_EQ(picture.light.diffuse, 0.2F);
  EXPECT_EQ(picture.light.specular, 0.3F);
  EXPECT_EQ(picture.light.shininess, 4.0F);
  EXPECT_EQ(picture.background, glm::vec3(0.5F, 0.6F, 0.7F));
  EXPECT_TRUE(picture.grid);
}

TEST(FrameComposer, TellsOfAMeshOnlyOnce) {
  FrameComposer composer;
  render::Picture picture;
  const model::ActorPtr a = square_actor("a"), b = square_actor("b");
  composer.compose(show_of({a, b}, 0.0), {}, kWide, picture);
  const render::MeshSourcePtr of_a = picture.items[0].mesh, of_b = picture.items[1].mesh;
  EXPECT_NE(of_a, of_b);
  EXPECT_EQ(of_a->id, of_b->id) << "of one content";
  composer.compose(show_of({a, b}, 1.5), {}, kWide, picture);
  EXPECT_EQ(picture.items[0].mesh, of_a);
  EXPECT_EQ(picture.items[1].mesh, of_b);

  composer.compose(show_of({b}, 1.5), {}, kWide, picture);
  ASSERT_EQ(picture.items.size(), 1U);
  EXPECT_EQ(picture.items[0].mesh->owner, b->model) << "another mesh in the place of the first";
  const std::weak_ptr<const render::MeshSource> let_go = of_a;
  EXPECT_EQ(let_go.use_count(), 1) << "only this test holds what is not shown any more";
}

TEST(FrameComposer, TellsOfAMeshAllThatItIs) {
  const model::ActorPtr actor = square_actor("square");
  const render::Picture picture = composed(show_of({actor}, 0.0));
  const render::MeshSource& source = *picture.items[0].mesh;
  EXPECT_EQ(source.vertex_count, 4U);
  EXPECT_EQ(source.indices.data(), actor->model->mesh->indices().data());
  EXPECT_TRUE(source.texcoords.empty());
  ASSERT_EQ(source.parts.size(), 1U) << "without parts: all of it, of a plain material";
  EXPECT_EQ(source.parts[0].index_count, 6U);
  ASSERT_EQ(source.materials.size(), 1U);
  EXPECT_EQ(source.materials[0].base_color, model::Material{}.base_color);
  EXPECT_EQ(source.owner, actor->model);
}

TEST(FrameComposer, LooksThroughTheScenesCameraWithoutAnOwnOne) {
  const stage::Show show = show_of({square_actor("square")}, 0.0);
  expect_view(composed(show).view, show.scene->settings.camera, 2.0F);
  expect_view(composed(show, {}, {100, 200}).view, show.scene->settings.camera, 0.5F);
}

TEST(FrameComposer, PlacesAnOwnCameraOverTheScenes) {
  const stage::Show show = show_of({square_actor("square")}, 0.0);
  model::CameraRequest own;
  own.eye = glm::vec3(4, 5, 6);
  model::Camera want = show.scene->settings.camera;
  want.eye = *own.eye;
  const render::Picture picture = composed(show, own);
  expect_view(picture.view, want, 2.0F);
  EXPECT_EQ(picture.view.focus_m, glm::length(want.eye - want.target));
}

TEST(FrameComposer, FitsAnOwnCameraToThePicturesShape) {
  const stage::Show show = show_of({square_actor("square")}, 0.0);
  model::CameraRequest own;
  own.fit = true;
  const auto visible = model::visible_bounds(*show.scene);
  ASSERT_TRUE(visible);
  for (const render::Size size : {render::Size{300, 100}, render::Size{100, 300}}) {
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    expect_view(composed(show, own, size).view, model::fit(show.scene->settings.camera, *visible, aspect), aspect);
  }
}

TEST(FrameComposer, FallsBackToTheScenesCameraWhereAnOwnOneCanShowNothing) {
  const stage::Show show = show_of({square_actor("square")}, 0.0);
  model::CameraRequest own;
  own.eye = show.scene->settings.camera.target;
  expect_view(composed(show, own).view, show.scene->settings.camera, 2.0F);
  own = {};
  own.up = glm::vec3(0.0F);
  expect_view(composed(show, own).view, show.scene->settings.camera, 2.0F);
}

TEST(FrameComposer, AllocatesNothingOnceWarm) {
  FrameComposer composer;
  render::Picture picture;
  std::vector<stage::Show> shows;
  const std::vector<model::ActorPtr> actors{square_actor("a", {{.keys = 5}}), square_actor("b", {{.keys = 0}}),
                                            with_mode(square_actor("c"), animation::Interpolation::CatmullRom)};
  for (const double time_s : {0.0, 0.5, 1.0, 1.7}) shows.push_back(show_of(actors, time_s));
  model::CameraRequest own;
  own.orbit = {1.0F, 0.5F, {}, {}};
  own.fit = true;
  const std::optional<model::CameraRequest> camera = own;
  composer.compose(shows[0], camera, kWide, picture);
  const std::size_t before = test::allocations();
  for (const stage::Show& show : shows) composer.compose(show, camera, kWide, picture);
  EXPECT_EQ(test::allocations() - before, 0U);
}

}  // namespace
}  // namespace tweend::streams
