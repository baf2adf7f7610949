#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "server/assets/asset_library.hpp"
#include "server/assets/glb_writer.hpp"
#include "server/assets/obj_writer.hpp"
#include "server/model/evaluate.hpp"
#include "tests/assets/random_actors.hpp"
#include "tests/assets/temp_folder.hpp"

// What is exported is imported again, by the way that every asset takes, and shows the same.

namespace tweend::assets {
namespace {

constexpr double kNear = 1e-5;

model::Actor imported(const TempFolder& folder, const std::string& name) {
  std::vector<AssetRoot> roots;
  roots.push_back(must(AssetRoot::open(folder.path().string())));
  const AssetLibrary library(std::move(roots), Limits{});
  model::ImportedModel found = must(library.import(name));
  model::Actor actor;
  actor.name = "again";
  actor.model = found.model;
  for (model::Clip& clip : found.clips) actor.clips.push_back(std::make_shared<const model::Clip>(std::move(clip)));
  return actor;
}

model::Actor exported_and_imported(const model::Actor& actor) {
  const TempFolder folder;
  folder.write("it.glb", must(write_glb(actor, Limits{})));
  return imported(folder, "it.glb");
}

/// Corners of all triangles: vertices may come in another order.
std::vector<glm::dvec3> corners(const model::Actor& actor, const model::ClipPtr& clip, double time_s) {
  const model::Mesh& mesh = *actor.model->mesh;
  std::vector<float> positions(3 * mesh.vertex_count());
  EXPECT_TRUE(model::Evaluator().vertices(actor, model::shown_clip(clip, time_s), {positions, {}, {}}));
  std::vector<glm::dvec3> out;
  for (const std::uint32_t i : mesh.indices()) out.emplace_back(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
  return out;
}

double worst_corner(const model::Actor& a, const model::Actor& b, const model::ClipPtr& in_a, const model::ClipPtr& in_b,
                    double time_s) {
  const auto first = corners(a, in_a, time_s), second = corners(b, in_b, time_s);
  if (first.size() != second.size()) return INFINITY;
  double worst = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    worst = std::max(worst, glm::distance(first[i], second[i]) / std::max(1.0, glm::length(first[i])));
  }
  return worst;
}

double worst_joint(const model::Actor& a, const model::Actor& b, const model::ClipPtr& in_a, const model::ClipPtr& in_b,
                   double time_s) {
  model::Evaluator of_a, of_b;
  const animation::Pose& first = of_a.pose(a, model::shown_clip(in_a, time_s));
  const animation::Pose& second = of_b.pose(b, model::shown_clip(in_b, time_s));
  double worst = 0.0;
  for (std::uint32_t j = 0; j < a.model->joint_count(); ++j) {
    const auto other = b.model->skeleton->find(a.model->skeleton->joints()[j].name);
    if (!other) return INFINITY;
    const animation::JointPose x = first.joint(a.model->skeleton->place_of(j));
    const animation::JointPose y = second.joint(b.model->skeleton->place_of(*other));
    const double sign = glm::dot(x.rotation, y.rotation) < 0.0F ? -1.0 : 1.0;
    for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(double{x.rotation[c]} - sign * double{y.rotation[c]}));
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(double{x.translation[c]} - double{y.translation[c]}));
      worst = std::max(worst, std::abs(double{x.scale[c]} - double{y.scale[c]}));
    }
  }
  return worst;
}

/// Weights of the first one's morph targets, by their names.
double worst_weight(const model::Actor& a, const model::Actor& b, const model::ClipPtr& in_a, const model::ClipPtr& in_b,
                    double time_s) {
  if (!a.model->morphs || in_a->type() == model::ClipType::Vertex) return 0.0;
  model::Evaluator of_a, of_b;
  const auto first = of_a.pose(a, model::shown_clip(in_a, time_s)).weights();
  const auto second = of_b.pose(b, model::shown_clip(in_b, time_s)).weights();
  double worst = 0.0;
  for (std::size_t w = 0; w < first.size(); ++w) {
    if (a.model->morphs->targets()[w].name != b.model->morphs->targets()[w].name) return INFINITY;
    worst = std::max(worst, std::abs(double{first[w]} - double{second[w]}));
  }
  return worst;
}

/// Not within a jump's 2 µs, nor nearer to a key than floats hold its time.
std::vector<double> times_of(const model::Clip& clip) {
  std::vector<double> times;
  for (int i = 0; i < 33; ++i) times.push_back(clip.duration_s() * (i + 0.01) / 33.0);
  std::erase_if(times, [&](double t) {
    return std::any_of(clip.times_s.begin(), clip.times_s.end(), [t](double key) { return std::abs(t - key) < 1e-5; });
  });
  return times;
}

class RoundTrips : public testing::TestWithParam<std::uint32_t> {
 protected:
  static void expect_same(const model::Actor& actor) {
    const model::Actor again = exported_and_imported(actor);
    for (const model::ClipPtr& clip : actor.clips) {
      const model::ClipPtr other = again.find_clip(clip->name);
      if (!other) continue;  // it moves nothing
      EXPECT_NEAR(other->duration_s(), clip->duration_s(), 1e-6);
      for (const double time_s : times_of(*clip)) {
        SCOPED_TRACE(clip->name + " at " + std::to_string(time_s));
        EXPECT_LE(worst_joint(actor, again, clip, other, time_s), kNear);
        EXPECT_LE(worst_weight(actor, again, clip, other, time_s), kNear);
        if (!actor.model->mesh) continue;
        EXPECT_LE(worst_corner(actor, again, clip, other, time_s), clip->type() == model::ClipType::Vertex ? 1e-4 : 2 * kNear);
      }
      if (HasFailure()) return;
    }
  }
};

TEST_P(RoundTrips, SkeletonsShowTheSame) { expect_same(RandomActors(GetParam()).actor({.mesh = false})); }
TEST_P(RoundTrips, MeshesShowTheSame) { expect_same(RandomActors(100 + GetParam()).actor({.skeleton = false})); }
TEST_P(RoundTrips, SkinnedMeshesShowTheSame) { expect_same(RandomActors(200 + GetParam()).actor({})); }
TEST_P(RoundTrips, MeshesBesideSkeletonsShowTheSame) { expect_same(RandomActors(300 + GetParam()).actor({.skin = false})); }

TEST_P(RoundTrips, ASecondTimeAddsNothing) {
  const model::Actor once = exported_and_imported(RandomActors(200 + GetParam()).actor({}));
  const model::Actor twice = exported_and_imported(once);
  EXPECT_EQ(twice.model->joint_count(), once.model->joint_count());
  EXPECT_EQ(twice.model->weight_count(), once.model->weight_count());
  EXPECT_EQ(twice.model->vertex_count(), once.model->vertex_count());
}

INSTANTIATE_TEST_SUITE_P(Seeds, RoundTrips, testing::Range(1U, 9U));

TEST(ExportedLook, ComesBack) {
  const model::Actor actor = RandomActors(7).actor({.skeleton = false});
  const model::Actor again = exported_and_imported(actor);
  const model::Surface& before = actor.model->mesh->surface();
  const model::Surface& after = again.model->mesh->surface();
  ASSERT_EQ(after.parts.size(), before.parts.size());
  for (std::size_t p = 0; p < before.parts.size(); ++p) {
    const model::Material& was = before.materials[before.parts[p].material];
    const model::Material& is = after.materials[after.parts[p].material];
    EXPECT_EQ(is.name, was.name);
    EXPECT_LE(glm::distance(is.base_color, was.base_color), 1e-6F);
    EXPECT_EQ(is.alpha, was.alpha);
    EXPECT_EQ(is.alpha_cutoff, was.alpha_cutoff);
    EXPECT_EQ(is.unlit, was.unlit);
    EXPECT_EQ(is.wrap_u, was.wrap_u);
    if (!actor.model->mesh->texcoords().empty()) {
      ASSERT_TRUE(is.base_color_texture);
      EXPECT_EQ(is.base_color_texture->rgba(), was.base_color_texture->rgba());
    }
  }
}

TEST(ExportedLook, OfAMeshWithoutMaterialIsTheDefaultOne) {
  const model::Actor again = exported_and_imported(RandomActors(7).actor({.skeleton = false, .parts = false}));
  ASSERT_EQ(again.model->mesh->surface().materials.size(), 1U);
  EXPECT_LE(glm::distance(again.model->mesh->surface().materials[0].base_color, model::kDefaultBaseColor), 1e-6F);
}

TEST(ExportedSequence, ShowsTheSameAtItsKeyframes) {
  for (std::uint32_t seed = 1; seed < 9; ++seed) {
    const model::Actor actor = RandomActors(seed).actor({});
    for (const model::ClipPtr& clip : actor.clips) {
      SCOPED_TRACE(std::to_string(seed) + " " + clip->name);
      const TempFolder folder;
      folder.make_folder("out");
      for (const NewFile& file : must(write_obj_sequence(actor, clip, "seq", Limits{}))) {
        folder.write("out/" + file.name, file.bytes);
      }
      const model::Actor again = imported(folder, "out");
      const model::Clip& other = *again.clips.front();
      ASSERT_EQ(other.times_s.size(), clip->times_s.size());
      for (std::size_t k = 0; k < other.times_s.size(); ++k) {
        EXPECT_NEAR(other.times_s[k], clip->times_s[k], 0.5 / 24.0 + 1e-9) << "the nearest frame";
        const auto shown = corners(actor, clip, clip->times_s[k]), read = corners(again, again.clips.front(), other.times_s[k]);
        EXPECT_EQ(read, shown) << "numbers are written with all their digits";
      }
    }
  }
}

TEST(ExportedSequence, BringsItsMaterials) {
  const model::Actor actor = RandomActors(7).actor({.skeleton = false});
  const TempFolder folder;
  folder.make_folder("out");
  for (const NewFile& file : must(write_obj_sequence(actor, actor.clips.back(), "seq", Limits{}))) {
    folder.write("out/" + file.name, file.bytes);
  }
  const model::Actor read = imported(folder, "out");
  const model::Surface& surface = read.model->mesh->surface();
  ASSERT_EQ(surface.parts.size(), 3U);
  EXPECT_EQ(surface.materials[0].base_color, actor.model->mesh->surface().materials[0].base_color);
  EXPECT_EQ(surface.materials[0].name, "red_\"__\"");
  if (!actor.model->mesh->texcoords().empty()) {
    EXPECT_EQ(surface.materials[0].base_color_texture->rgba(),
              actor.model->mesh->surface().materials[0].base_color_texture->rgba());
  }
}

TEST(ExportedSequence, NeedsAMeshAndAFrameForEachKeyframe) {
  const model::Actor skeleton = RandomActors(1).actor({.mesh = false});
  const auto refused = write_obj_sequence(skeleton, skeleton.clips.front(), "a", Limits{});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::InvalidParams);
  model::Actor actor = RandomActors(1).actor({.skeleton = false});
  auto clip = std::make_shared<model::Clip>();
  clip->times_s = {0.5, 0.51};
  clip->keyframes.assign(2, {0, {}, {}, actor.model->rest, nullptr});
  const auto crowded = write_obj_sequence(actor, clip, "a", Limits{});
  ASSERT_FALSE(crowded);
  EXPECT_NE(crowded.error().message.find("frame 12"), std::string::npos) << crowded.error().message;
  const auto large = write_obj_sequence(actor, actor.clips.front(), "a", Limits{.asset_bytes = 100});
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, ErrorCode::Limit);
}

TEST(ExportedGlb, IsRefusedWhereItIsTooLargeOrFlattened) {
  const model::Actor actor = RandomActors(201).actor({});
  const auto large = write_glb(actor, Limits{.asset_bytes = 5'000});
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, ErrorCode::Limit);

  model::Model flat = *actor.model;
  std::vector<model::Joint> joints = flat.skeleton->joints();
  for (model::Joint& joint : joints) joint.rest.scale = glm::vec3(1.0F, 0.0F, 1.0F);
  flat.skeleton = must(model::Skeleton::make(joints));
  model::Actor flattened = actor;
  flattened.model = std::make_shared<const model::Model>(flat);
  const auto refused = write_glb(flattened, Limits{});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::InvalidParams);
  EXPECT_NE(refused.error().message.find("obj_sequence"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace tweend::assets
