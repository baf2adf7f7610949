// Pictures of a character of 67 joints, four of which move each vertex, and eight morph targets that weigh something: skinned
// and morphed where it is drawn, beside the same on the processor first, uploaded and then drawn. On a software device both
// run on the processor; on a GPU the first is what it is for.

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"
#include "bench/support/sphere_scene.hpp"
#include "render/egl_context.hpp"
#include "render/readback.hpp"
#include "render/render_target.hpp"
#include "render/renderer.hpp"
#include "server/model/evaluate.hpp"
#include "server/streams/frame_composer.hpp"

namespace {

using namespace tweend;

constexpr std::uint32_t kJoints = 67;
constexpr std::size_t kTargets = 8;
constexpr render::Size kSize{640, 360};

template <class T>
T must(Result<T> result) {
  if (!result) bench::give_up(result.error().message);
  return std::move(*result);
}

/// A chain along +Y through the sphere, from -1 to 1.
model::SkeletonPtr chain() {
  std::vector<model::Joint> joints;
  for (std::uint32_t j = 0; j < kJoints; ++j) {
    model::Joint& joint = joints.emplace_back();
    joint.name = fmt::format("joint{}", j);
    joint.parent = static_cast<std::int32_t>(j) - 1;
    joint.rest.translation = {0.0F, j == 0 ? -1.0F : 2.0F / (kJoints - 1), 0.0F};
  }
  return must(model::Skeleton::make(std::move(joints)));
}

/// Each vertex follows the four joints nearest to its height.
model::SkinPtr skin_of(const std::vector<float>& positions) {
  std::vector<model::SkinEntry> entries(kJoints);
  for (std::uint32_t j = 0; j < kJoints; ++j) {
    entries[j].joint = j;
    entries[j].joint_from_mesh.rows[1].w = 1.0F - 2.0F * static_cast<float>(j) / (kJoints - 1);
  }
  std::vector<std::uint16_t> joints;
  std::vector<float> weights;
  for (std::size_t v = 0; v < positions.size() / 3; ++v) {
    const float along = (positions[3 * v + 1] + 1.0F) * 0.5F * (kJoints - 1);
    const float first = std::clamp(std::floor(along) - 1.0F, 0.0F, kJoints - 4.0F);
    for (std::uint16_t i = 0; i < 4; ++i) {
      joints.push_back(static_cast<std::uint16_t>(first + static_cast<float>(i)));
      weights.push_back(std::max(0.05F, 2.0F - std::abs(along - first - static_cast<float>(i))));
    }
  }
  return must(model::Skin::make(std::move(entries), 4, std::move(joints), std::move(weights), positions));
}

model::MorphTargetsPtr targets_of(const std::vector<float>& positions) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0.0F, 0.01F);
  std::vector<model::MorphTarget> targets(kTargets);
  for (std::size_t t = 0; t < kTargets; ++t) {
    targets[t].name = fmt::format("target{}", t);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      targets[t].positions.push_back(noise(random));
      targets[t].normals.push_back(noise(random));
    }
  }
  return must(model::MorphTargets::make(std::move(targets), positions.size() / 3));
}

/// Bends slowly one way and sways: a second, a keyframe each tenth.
model::ClipPtr swaying(std::size_t weights) {
  using animation::Property;
  auto clip = std::make_shared<model::Clip>();
  clip->name = "sway";
  for (int k = 0; k <= 10; ++k) {
    std::vector<model::KeyedValue> values;
    for (std::uint32_t j = 0; j < kJoints; ++j) {
      const float half = 0.012F * std::sin(0.6F * static_cast<float>(k) + 0.05F * static_cast<float>(j));
      values.push_back({{j, Property::Rotation}, {0.0F, 0.0F, std::sin(half), std::cos(half)}});
    }
    for (std::uint32_t w = 0; w < weights; ++w) {
      values.push_back({{w, Property::Weight}, {0.3F + 0.02F * static_cast<float>(k), 0.0F, 0.0F, 0.0F}});
    }
    clip->times_s.push_back(0.1 * k);
    model::Keyframe& key = clip->keyframes.emplace_back();
    key.id = k + 1;
    key.pose = std::make_shared<const model::PoseKey>(std::move(values));
  }
  return clip;
}

model::ActorPtr character(const bench::SphereGrid& grid, bool morphs) {
  const std::vector<float> positions = grid.positions(0.0F);
  auto model = std::make_shared<model::Model>();
  model->mesh = must(model::Mesh::make(positions.size() / 3, grid.indices()));
  model->rest = must(model::VertexKey::make(*model->mesh, positions));
  model->skeleton = chain();
  model->skin = skin_of(positions);
  if (morphs) model->morphs = targets_of(positions);
  auto actor = std::make_shared<model::Actor>();
  actor->name = "character";
  actor->model = model;
  actor->clips = {swaying(model->weight_count())};
  return actor;
}

/// One character and all it takes to draw it.
class Stage {
 public:
  explicit Stage(model::ActorPtr actor) : actor_(std::move(actor)) {
    auto scene = std::make_shared<model::Scene>();
    scene->actors = {actor_};
    show_.scene = scene;
    show_.actors.resize(1);
    show_.actors[0].actor = actor_;
    show_.actors[0].clip = actor_->clips.front();
    vertices_.resize(actor_->model->rest->block().size());
  }
  /// Evaluates, composes, draws; the pose goes to the GPU.
  void draw_posed() {
    step();
    renderer_->draw(picture_, *target_);
    glFinish();
  }
  /// The same, with vertices evaluated by the processor for each picture.
  void draw_vertices() {
    step();
    const std::span<float> all(vertices_);
    const std::size_t stream = 3 * actor_->model->vertex_count();
    const Status done = evaluator_.vertices(*actor_, show_.actors[0].shown,
                                            {all.first(stream), all.subspan(stream, stream), all.subspan(2 * stream)});
    if (!done) bench::give_up(done.error().message);
    render::DrawItem& item = picture_.items[0];
    item.palette = {};
    item.morph_weights = {};
    item.vertices = all;
    renderer_->draw(picture_, *target_);
    glFinish();
  }
  [[nodiscard]] std::vector<std::byte> pixels() {
    const render::PixelsPtr pixels = pool_.take(kSize);
    target_->read_into(pixels->buffer());
    glFinish();
    const auto bytes = pixels->view().bytes;
    return {bytes.begin(), bytes.end()};
  }
  void rewind() { steps_ = 0; }

 private:
  void step() {
    const double time_s = std::fmod(0.0123 * static_cast<double>(++steps_), 1.0);
    show_.actors[0].shown = model::shown_clip(show_.actors[0].clip, time_s);
    model::CameraRequest camera;
    camera.fit = true;
    composer_.compose(show_, camera, kSize, picture_);
  }
  const model::ActorPtr actor_;
  std::unique_ptr<render::Renderer> renderer_ = must(render::Renderer::make(std::size_t{1} << 30U));
  render::RenderTargetPtr target_ = must(render::RenderTarget::make(kSize, 1));
  render::ReadbackPool pool_;
  stage::Show show_;
  streams::FrameComposer composer_;
  model::Evaluator evaluator_;
  render::Picture picture_;
  std::vector<float> vertices_;
  std::size_t steps_ = 0;
};

/// Both ways show the same, or there is nothing to compare.
void require_same_pictures(Stage& stage, const std::string& name) {
  for (int i = 0; i < 3; ++i) {
    stage.rewind();
    for (int k = 0; k < i; ++k) stage.draw_posed();
    stage.draw_posed();
    const auto posed = stage.pixels();
    stage.rewind();
    for (int k = 0; k < i; ++k) stage.draw_posed();
    stage.draw_vertices();
    const auto by_processor = stage.pixels();
    std::size_t differ = 0, covered = 0;
    for (std::size_t k = 0; k < posed.size(); k += 4) {
      if (std::abs(std::to_integer<int>(posed[k]) - std::to_integer<int>(by_processor[k])) > 3) ++differ;
      if (std::to_integer<int>(posed[k]) > 64) ++covered;
    }
    if (differ * 1000 > posed.size() / 4) bench::give_up(fmt::format("{}: {} pixels differ", name, differ));
    if (covered * 25 < posed.size() / 4) bench::give_up(fmt::format("{}: hardly anything is shown", name));
  }
}

}  // namespace

int main() {
  const auto context = must(render::EglContext::open());
  std::printf("%s\npictures of %u x %u pixels of a character of %u joints, drawn, ms\n", context->description().c_str(),
              kSize.width, kSize.height, kJoints);
  std::printf("%-22s %9s %12s %26s\n", "", "vertices", "on the GPU", "on the processor, uploaded");
  std::vector<bench::Claim> claims;
  for (const bool morphs : {false, true}) {
    const bench::SphereGrid grid{100};
    const model::ActorPtr actor = character(grid, morphs);
    Stage stage(actor);
    const std::string name = morphs ? "skinned, 8 morphs" : "skinned";
    require_same_pictures(stage, name);
    const bench::Race race = bench::measure(
        {.items = 1.0, .rounds = 21, .batch_ns = 40e6}, [&] { stage.draw_posed(); }, [&] { stage.draw_vertices(); });
    std::printf("%-22s %9zu %12.2f %26.2f\n", name.c_str(), actor->model->vertex_count(), race.ns(0) * 1e-6, race.ns(1) * 1e-6);
    claims.push_back({fmt::format("skinned_frames/{}", morphs ? "skinned_and_morphed" : "skinned"), race.ratio(0, 1), 1.5});
  }
  return bench::report(claims) ? 0 : 1;
}
