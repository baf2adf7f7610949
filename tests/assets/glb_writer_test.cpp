#include "server/assets/glb_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "server/model/evaluate.hpp"
#include "tests/assets/glb_reading.hpp"
#include "tests/assets/random_actors.hpp"

namespace tweend::assets {
namespace {

using Kind = RandomActors::Kind;

/// The folder, without the files that an earlier run has left there.
std::filesystem::path emptied(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) left.push_back(entry.path());
  for (const auto& file : left) {
    if (file.extension() == ".glb") std::filesystem::remove(file);
  }
  return folder;
}

/// Where the test is told to, exported files are kept for a validator to look at.
void keep(const std::string& name, const std::string& file) {
  const char* told = std::getenv("TWEEND_GLB_DIR");
  if (told == nullptr) return;
  static const std::filesystem::path folder = emptied(told);
  std::ofstream out(folder / (name + ".glb"), std::ios::binary);
  EXPECT_TRUE(out << file << std::flush) << name;
}

/// Times all over the clip, and beside its keys. A float of the file holds a time to 6e-8 of it, and a jump takes 2 µs: nothing
/// is asked nearer to a key than this.
std::vector<double> times_of(const model::Clip& clip) {
  constexpr double kBeside = 1e-5;
  std::vector<double> times;
  for (int i = 0; i < 40; ++i) times.push_back(clip.duration_s() * i / 40.0);
  std::erase_if(times, [&](double t) {
    return t > 0.0 && std::ranges::any_of(clip.times_s, [t](double key) { return std::abs(t - key) < kBeside; });
  });
  for (const double t : clip.times_s) {
    if (t + kBeside < clip.duration_s()) times.push_back(t + kBeside);
    if (t > kBeside) times.push_back(t - kBeside);
  }
  return times;
}

const GlbReading::Json* playing(const GlbReading& glb, const model::Clip& clip) { return glb.animation(clip.name); }

testing::AssertionResult all_near(const GlbReading::Row& found, const std::vector<double>& expected, double tolerance,
                                  bool rotation) {
  double cosine = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) cosine += found.at(i) * expected[i];
  const double sign = rotation && cosine < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!(std::abs(found[i] - sign * expected[i]) <= tolerance)) {
      return testing::AssertionFailure() << testing::PrintToString(found) << " is not " << testing::PrintToString(expected);
    }
  }
  return testing::AssertionSuccess();
}

constexpr double kNear = 1e-5;

void expect_same_pose(const model::Actor& actor, const GlbReading& glb, const model::ClipPtr& clip, double time_s) {
  model::Evaluator evaluator;
  const animation::Pose& pose = evaluator.pose(actor, model::shown_clip(clip, time_s));
  const std::string where = clip->name + " at " + std::to_string(time_s);
  for (std::uint32_t j = 0; j < actor.model->joint_count(); ++j) {
    const animation::JointPose p = pose.joint(actor.model->skeleton->place_of(j));
    const std::size_t node = glb.node(actor.model->skeleton->joints()[j].name);
    const auto value = [&](const char* path) { return glb.value(node, path, playing(glb, *clip), time_s); };
    EXPECT_TRUE(all_near(value("translation"), {p.translation.x, p.translation.y, p.translation.z}, kNear, false)) << where;
    EXPECT_TRUE(all_near(value("rotation"), {p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w}, kNear, true)) << where;
    EXPECT_TRUE(all_near(value("scale"), {p.scale.x, p.scale.y, p.scale.z}, kNear, false)) << where;
  }
}

/// @param tolerance  metres, relative where it is far out; of an eased vertex clip it is a ten-thousandth of the mesh
void expect_same_corners(const model::Actor& actor, const GlbReading& glb, const model::ClipPtr& clip, double time_s,
                         double tolerance) {
  const model::Mesh& mesh = *actor.model->mesh;
  std::vector<float> positions(3 * mesh.vertex_count()), normals(positions.size());
  ASSERT_TRUE(model::Evaluator().vertices(actor, model::shown_clip(clip, time_s), {positions, normals, {}}));
  const std::vector<GlbReading::Vertex> found = glb.corners(playing(glb, *clip), time_s);
  ASSERT_EQ(found.size(), mesh.indices().size());
  const auto at = [](const std::vector<float>& values, std::size_t v) {
    return glm::dvec3(values[3 * v], values[3 * v + 1], values[3 * v + 2]);
  };
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::uint32_t v = mesh.indices()[i];
    const glm::dvec3 shown = at(positions, v);
    ASSERT_LE(glm::distance(found[i].position, shown), tolerance * std::max(1.0, glm::length(shown)))
        << clip->name << " at " << time_s;
  }
}

bool baked(const model::Clip& clip) {
  return clip.settings.closed || std::any_of(clip.keyframes.begin(), clip.keyframes.end(), [](const model::Keyframe& k) {
           return k.interpolation.has_value() || k.easing.has_value();
         });
}

void expect_same(const model::Actor& actor, const std::string& name) {
  SCOPED_TRACE(name);
  const std::string file = must(write_glb(actor, Limits{}));
  keep(name, file);
  const GlbReading glb(file);
  for (const model::ClipPtr& clip : actor.clips) {
    const auto* animation = playing(glb, *clip);
    if (animation != nullptr) {
      EXPECT_NEAR(glb.duration(*animation), clip->duration_s(), 1e-6) << clip->name;
    }
    for (const double time_s : times_of(*clip)) {
      expect_same_pose(actor, glb, clip, time_s);
      if (actor.model->mesh == nullptr) continue;
      const bool of_vertices = clip->type() == model::ClipType::Vertex;
      expect_same_corners(actor, glb, clip, time_s, of_vertices && baked(*clip) ? 1e-4 : 2 * kNear);
    }
    if (testing::Test::HasFailure()) return;
  }
}

class RandomExports : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RandomExports, SkeletonsSampleTheSame) {
  expect_same(RandomActors(GetParam()).actor({.mesh = false}), "skeleton" + std::to_string(GetParam()));
}

TEST_P(RandomExports, MeshesSampleTheSame) {
  expect_same(RandomActors(100 + GetParam()).actor({.skeleton = false}), "mesh" + std::to_string(GetParam()));
}

TEST_P(RandomExports, SkinnedMeshesSampleTheSame) {
  expect_same(RandomActors(200 + GetParam()).actor({.parts = GetParam() % 2 == 0}), "skinned" + std::to_string(GetParam()));
}

TEST_P(RandomExports, MeshesBesideSkeletonsSampleTheSame) {
  expect_same(RandomActors(300 + GetParam()).actor({.skin = false, .morphs = false}), "beside" + std::to_string(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomExports, testing::Range(1U, 13U));

}  // namespace
}  // namespace tweend::assets
