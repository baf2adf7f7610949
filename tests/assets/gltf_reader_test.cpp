#include "server/assets/gltf_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "server/animation/affine.hpp"
#include "tests/assets/sample_gltf.hpp"

namespace tweend::assets {
namespace {

using animation::Interpolation;
using animation::Property;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pointwise;

std::vector<std::string> joint_names(const model::ImportedModel& m) {
  std::vector<std::string> names;
  for (const model::Joint& joint : m.model->skeleton->joints()) names.push_back(joint.name);
  return names;
}
std::vector<float> positions(const model::ImportedModel& m) {
  const auto p = m.model->rest->positions();
  return {p.begin(), p.end()};
}

TEST(GltfReader, ReadsATriangle) {
  const model::ImportedModel m = must_read(triangle_gltf());
  EXPECT_EQ(m.source, "test.glb");
  EXPECT_EQ(m.model->vertex_count(), 3U);
  EXPECT_EQ(m.model->mesh->triangle_count(), 1U);
  EXPECT_THAT(joint_names(m), ElementsAre("tri"));
  EXPECT_THAT(positions(m), ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
  EXPECT_THAT(m.model->rest->normals(), ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1));
  EXPECT_THAT(m.warnings, IsEmpty());
  ASSERT_EQ(m.clips.size(), 1U);
  EXPECT_EQ(m.clips[0].name, "default");
  EXPECT_TRUE(m.clips[0].keyframes.empty());
}

TEST(GltfReader, ReadsBothFormsAlike) {
  GltfBuilder b = arm_gltf();
  b.animation<float>("turn", 2, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
  const model::ImportedModel binary = must_read(b);
  const model::ImportedModel text = must(try_read(b.gltf()));
  EXPECT_EQ(binary.model->mesh->hash(), text.model->mesh->hash());
  EXPECT_EQ(binary.model->rest->hash(), text.model->rest->hash());
  EXPECT_EQ(binary.model->skin->hash(), text.model->skin->hash());
  EXPECT_EQ(binary.clips[0].keyframes[1].pose->hash(), text.clips[0].keyframes[1].pose->hash());
}

TEST(GltfReader, JointsAreAllNodesOfTheSceneDepthFirst) {
  GltfBuilder b;
  b.json["nodes"] = Json::parse(R"([{"name":"c"},{"name":"a","children":[3,0]},{"name":"other"},
                                    {"children":[4]},{"name":"a"},{"name":"camera","camera":0}])");
  b.json["scenes"] = Json::parse(R"([{"nodes":[2]},{"nodes":[1,5]}])");
  b.json["scene"] = 1;
  const model::ImportedModel m = must_read(b);
  EXPECT_THAT(joint_names(m), ElementsAre("a", "node_3", "a_2", "c", "camera"));
  std::vector<int> parents;
  for (const model::Joint& joint : m.model->skeleton->joints()) parents.push_back(joint.parent);
  EXPECT_THAT(parents, ElementsAre(-1, 0, 1, 0, -1));
  EXPECT_EQ(m.model->mesh, nullptr);
  b.json.erase("scene");
  EXPECT_THAT(joint_names(must_read(b)), ElementsAre("other"));
  b.json.erase("scenes");
  EXPECT_THAT(joint_names(must_read(b)), ElementsAre("a", "node_3", "a_2", "c", "other", "camera"));
}

TEST(GltfReader, TakesMatricesApart) {
  // translate(1 2 3) · rotate 90° about z · scale(2 3 4), by hand: columns (0 2 0), (-3 0 0), (0 0 4).
  GltfBuilder b;
  b.json["nodes"] = Json::parse(R"([{"matrix":[0,2,0,0, -3,0,0,0, 0,0,4,0, 1,2,3,1]},
      {"matrix":[-2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]},
      {"matrix":[1,0,0,0, 0,0,0,0, 0,0,1,0, 0,0,0,1]},
      {"matrix":[1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1]}])");
  const model::ImportedModel m = must_read(b);
  const animation::JointPose& first = m.model->skeleton->joints()[0].rest;
  EXPECT_EQ(first.translation, glm::vec3(1, 2, 3));
  EXPECT_EQ(first.scale, glm::vec3(2, 3, 4));
  EXPECT_NEAR(std::abs(first.rotation.z), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(first.rotation.z, first.rotation.w, 1e-6);
  EXPECT_EQ(m.model->skeleton->joints()[1].rest.scale, glm::vec3(-2, 1, 1)) << "a mirror image";
  EXPECT_EQ(m.model->skeleton->joints()[2].rest.scale, glm::vec3(1, 0, 1)) << "flat";
  EXPECT_NEAR(m.model->skeleton->joints()[2].rest.rotation.w, 1.0, 1e-6);
  ASSERT_EQ(m.warnings.size(), 1U);
  EXPECT_THAT(m.warnings[0], HasSubstr("\"test.glb\" /nodes/3/matrix: "));
}

TEST(GltfReader, SkinsFollowTheirJoints) {
  const model::ImportedModel m = must_read(arm_gltf());
  ASSERT_NE(m.model->skin, nullptr);
  const model::Skin& skin = *m.model->skin;
  ASSERT_EQ(skin.entries().size(), 2U);
  EXPECT_EQ(skin.entries()[0].joint, 1U);
  EXPECT_EQ(skin.entries()[1].joint, 2U);
  EXPECT_EQ(animation::to_mat4(skin.entries()[1].joint_from_mesh)[3], glm::vec4(0, -1, 0, 1));
  EXPECT_EQ(skin.per_vertex(), 4U);
  EXPECT_THAT(skin.influences().weights.subspan(8, 8), ElementsAre(0.5F, 0.5F, 0, 0, 0.5F, 0.5F, 0, 0));
}

TEST(GltfReader, MeshesWithoutASkinFollowTheirNode) {
  GltfBuilder b = triangle_gltf();
  b.json["nodes"] = Json::parse(R"([{"children":[1,2]},{"mesh":0},{"mesh":0,"skin":0}])");
  const std::size_t joints = b.accessor<std::uint16_t>("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
  const std::size_t weights = b.accessor<std::uint8_t>("VEC4", {255, 0, 0, 0, 255, 0, 0, 0, 51, 204, 0, 0}, true);
  Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = joints;
  attributes["WEIGHTS_0"] = weights;
  b.json["skins"] = Json::parse(R"([{"joints":[2,0]}])");
  const model::ImportedModel m = must_read(b);
  EXPECT_EQ(m.model->vertex_count(), 6U) << "both nodes show it";
  const model::Skin& skin = *m.model->skin;
  ASSERT_EQ(skin.entries().size(), 3U);
  EXPECT_EQ(skin.entries()[0].joint, 1U) << "the node itself";
  EXPECT_EQ(skin.entries()[1].joint, 2U);
  EXPECT_EQ(skin.entries()[2].joint, 0U);
  EXPECT_EQ(skin.entries()[0].joint_from_mesh, animation::Affine{});
  const auto influences = skin.influences();
  EXPECT_EQ(influences.entries[0], 0U);
  EXPECT_EQ(influences.weights[0], 1.0F);
  EXPECT_EQ(influences.entries[4 * 5 + 1], 2U);
  EXPECT_THAT(influences.weights.subspan(20, 4), Pointwise(FloatNear(1e-6F), {0.2F, 0.8F, 0.0F, 0.0F}));
}

TEST(GltfReader, TakesEightInfluences) {
  GltfBuilder b = arm_gltf();
  Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_1"] = b.accessor("VEC4", std::vector<std::uint8_t>(24, 1));
  attributes["WEIGHTS_1"] = b.accessor("VEC4", std::vector<float>(24, 0.25F));
  const model::ImportedModel m = must_read(b);
  EXPECT_EQ(m.model->skin->per_vertex(), 8U);
  // 1 of the shoulder and four quarters of the elbow, scaled to sum 1.
  EXPECT_THAT(m.model->skin->influences().weights.first(8), ElementsAre(0.5F, 0, 0, 0, 0.125F, 0.125F, 0.125F, 0.125F));
}

TEST(GltfReader, ReadsMorphTargetsAndTheirNames) {
  GltfBuilder b = triangle_gltf();
  const std::size_t up = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  b.json["meshes"][0]["primitives"][0]["targets"] = Json::array({Json{{"POSITION", up}}, Json{{"POSITION", up}}});
  b.json["meshes"][0]["weights"] = {0.25, 0.5};
  b.json["meshes"][0]["extras"]["targetNames"] = Json::array({"smile"});
  b.json["nodes"] = Json::parse(R"([{"mesh":0},{"mesh":0,"weights":[1,0]}])");
  b.animation<std::uint8_t>("talk", 1, "weights", "LINEAR", {0, 1}, {0, 255, 51, 0}, true);
  const model::ImportedModel m = must_read(b);
  const model::MorphTargets& morphs = *m.model->morphs;
  std::vector<std::string> names;
  for (const auto& target : morphs.targets()) names.push_back(target.name);
  EXPECT_THAT(names, ElementsAre("smile", "target_1", "smile_2", "target_1_2"));
  EXPECT_THAT(morphs.default_weights(), ElementsAre(0.25F, 0.5F, 1.0F, 0.0F));
  EXPECT_EQ(morphs.targets()[2].first_vertex, 3U);
  EXPECT_EQ(morphs.targets()[2].positions.size(), 9U);
  // A weight is a channel of its own, numbered among all of the actor.
  const auto values = m.clips[0].keyframes[1].pose->values();
  ASSERT_EQ(values.size(), 2U);
  EXPECT_EQ(values[0].channel, (animation::Channel{2, Property::Weight}));
  EXPECT_FLOAT_EQ(values[0].value.x, 0.2F);
  EXPECT_EQ(m.clips[0].keyframes[0].pose->values()[1].value.x, 1.0F);
}

TEST(GltfReader, ClipsKeepTheirTracksTimesAndModes) {
  GltfBuilder b = arm_gltf();
  b.animation<float>("bend", 2, "rotation", "LINEAR", {0, 1, 3}, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 2});
  b.animation<float>("", 1, "translation", "CUBICSPLINE", {0.5, 2},
                     {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18});
  b.animation<std::int16_t>("bend", 2, "rotation", "STEP", {0}, {0, 0, 32767, 0}, true);
  const model::ImportedModel m = must_read(b);
  ASSERT_EQ(m.clips.size(), 3U);
  EXPECT_EQ(m.clips[1].name, "animation_1");
  EXPECT_EQ(m.clips[2].name, "bend_2");
  EXPECT_THAT(m.clips[0].times_s, ElementsAre(0.0, 1.0, 3.0));
  EXPECT_EQ(m.clips[0].duration_s(), 3.0);
  EXPECT_EQ(m.clips[0].keyframes[2].pose->values()[0].value, glm::vec4(0, 0, 0, 1)) << "unit length";
  EXPECT_THAT(*m.clips[0].channel_modes, ElementsAre(model::ChannelMode{{2, Property::Rotation}, Interpolation::Linear}));
  const model::PoseKey& cubic = *m.clips[1].keyframes[1].pose;
  EXPECT_EQ(cubic.values()[0].value, glm::vec4(13, 14, 15, 0));
  EXPECT_EQ(cubic.tangents()[0].in, glm::vec4(10, 11, 12, 0));
  EXPECT_EQ(cubic.tangents()[0].out, glm::vec4(16, 17, 18, 0));
  EXPECT_EQ(m.clips[2].keyframes[0].pose->values()[0].value, glm::vec4(0, 0, 1, 0));
}

TEST(GltfReader, PassesOverWhatItCannotMove) {
  GltfBuilder b = triangle_gltf();
  b.json["nodes"].push_back({{"name", "elsewhere"}});
  b.json["scenes"] = Json::parse(R"([{"nodes":[0]}])");
  b.animation<float>("one", 1, "scale", "LINEAR", {0}, {1, 1, 1});
  b.animation<float>("two", 0, "pointer", "LINEAR", {0}, {1, 1, 1});
  b.animation<float>("three", 0, "weights", "LINEAR", {0}, {1});
  b.animation<float>("four", 0, "scale", "LINEAR", {0}, {1, 1, 1});
  b.json["animations"][3]["channels"][0]["target"].erase("node");
  const model::ImportedModel m = must_read(b);
  for (const model::Clip& clip : m.clips) EXPECT_TRUE(clip.keyframes.empty()) << clip.name;
  EXPECT_EQ(m.warnings.size(), 2U);
}

}  // namespace
}  // namespace tweend::assets
