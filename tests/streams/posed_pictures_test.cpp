#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <vector>

#include "render/egl_context.hpp"
#include "render/readback.hpp"
#include "render/renderer.hpp"
#include "server/model/evaluate.hpp"
#include "server/streams/frame_composer.hpp"
#include "tests/streams/picturing.hpp"
#include "tests/streams/posed_actors.hpp"

// Pictures of actors with skeletons, drawn: what the GPU deforms is what the stream of vertices sends.

namespace tweend::streams {
namespace {

using test::Decoded;

constexpr render::Size kSize{160, 120};

class PosedPictures : public testing::Test {
 protected:
  void SetUp() override {
    auto context = render::EglContext::open();
    if (!context) GTEST_SKIP() << context.error().message;
    context_ = std::move(*context);
    renderer_ = std::move(*render::Renderer::make(std::size_t{16} << 20U));
  }
  Decoded draw(const render::Picture& picture) {
    const auto target = render::RenderTarget::make(picture.size, 1);
    renderer_->draw(picture, **target);
    const render::PixelsPtr pixels = pool_.take(picture.size);
    (*target)->read_into(pixels->buffer());
    glFinish();
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    return test::decoded(pixels->view());
  }
  const render::Picture& compose(const model::ActorPtr& actor, const model::Shown& shown) {
    stage::Show show;
    show.scene = test::scene_of("main", {actor});
    show.actors.resize(1);
    show.actors[0].actor = actor;
    show.actors[0].clip = shown.clips.back().clip;
    show.actors[0].shown = shown;
    model::CameraRequest camera;
    camera.fit = !actor->model->mesh;
    camera.eye = glm::vec3(0.6F, 1.0F, 2.2F);
    camera.target = glm::vec3(0.0F, 0.7F, 0.0F);
    composer_.compose(show, camera, kSize, picture_);
    return picture_;
  }
  /// The same picture, of vertices that the processor has evaluated.
  render::Picture of_vertices(const model::Actor& actor, const model::Shown& shown) {
    const std::size_t stream = 3 * actor.model->vertex_count();
    vertices_.resize(actor.model->rest->block().size());
    const std::span<float> all(vertices_);
    EXPECT_TRUE(
        model::Evaluator().vertices(actor, shown, {all.first(stream), all.subspan(stream, stream), all.subspan(2 * stream)}));
    render::Picture picture = picture_;
    render::DrawItem& item = picture.items.at(0);
    item.palette = {};
    item.morph_weights = {};
    item.vertices = all;
    return picture;
  }
  std::unique_ptr<render::EglContext> context_;
  std::unique_ptr<render::Renderer> renderer_;
  render::ReadbackPool pool_;
  FrameComposer composer_;
  render::Picture picture_;
  std::vector<float> vertices_;
};

TEST_F(PosedPictures, ShowWhatTheStreamOfVerticesSends) {
  for (const test::RibbonParts& parts : {test::RibbonParts{}, {.skinned = false}, {.morphed = false}}) {
    const model::ActorPtr actor = test::ribbon_actor("ribbon", parts);
    for (const double time_s : {0.0, 0.5, 1.0}) {
      model::Shown shown = model::shown_clip(actor->find_clip("bend"), time_s);
      shown.clips.push_back({actor->find_clip("twist"), 0.6, 0.25F});
      const Decoded posed = draw(compose(actor, shown));
      EXPECT_LT(test::mean_difference(posed, draw(of_vertices(*actor, shown))), 0.05) << "at " << time_s;
      EXPECT_GT(test::covered(posed), 500U);
    }
  }
}

TEST_F(PosedPictures, AFadeBetweenBothKindsPassesWithoutAJump) {
  const model::ActorPtr actor = test::ribbon_actor("ribbon");
  model::Shown shown = model::shown_clip(actor->find_clip("bend"), 1.0);
  const Decoded before = draw(compose(actor, shown));
  shown.clips.push_back({actor->find_clip("slide"), 1.0, 0.0F});
  EXPECT_LT(test::mean_difference(draw(compose(actor, shown)), before), 0.05) << "it has just begun";
  shown.clips[1].weight = 1.0F;
  const Decoded end = draw(compose(actor, shown));
  EXPECT_LT(test::mean_difference(end, draw(compose(actor, model::shown_clip(actor->find_clip("slide"), 1.0)))), 0.05);
  EXPECT_GT(test::mean_difference(end, before), 2.0);
}

TEST_F(PosedPictures, OneJointAloneIsSeen) {
  const auto actor = test::bones_actor("bones", {{"root", -1, {}}});
  const std::size_t seen = test::covered(draw(compose(actor, model::shown_clip(actor->clips.front(), 0.0))));
  EXPECT_GT(seen, 10U);
  EXPECT_LT(seen, kSize.width * kSize.height / 10U);
}

TEST_F(PosedPictures, BonesAreSeenThroughTheMesh) {
  const auto actor = test::ribbon_actor("ribbon");
  const model::Shown shown = model::shown_clip(actor->find_clip("bend"), 1.0);
  const Decoded bare = draw(compose(actor, shown));
  actor->settings.show_skeleton = true;
  const Decoded with = draw(compose(actor, shown));
  EXPECT_GT(test::mean_difference(bare, with), 0.3);
}

}  // namespace
}  // namespace tweend::streams
