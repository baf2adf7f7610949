// Files that are not what they should be: each is refused, with its name, the JSON pointer, what was expected and what was
// found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/assets/sample_gltf.hpp"

namespace tweend::assets {
namespace {

using ::testing::HasSubstr;

struct Damage {
  const char* name;
  std::function<void(GltfBuilder&)> make;
  const char* says;  ///< with the pointer
};

/// An arm that moves: skin, normals, indices, an animation, a material.
GltfBuilder whole_gltf() {
  GltfBuilder b = arm_gltf();
  b.animation<float>("turn", 2, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
  b.json["materials"] = Json::parse(R"([{"pbrMetallicRoughness":{}}])");
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  return b;
}

Json& primitive(GltfBuilder& b) { return b.json["meshes"][0]["primitives"][0]; }
Json& sampler(GltfBuilder& b) { return b.json["animations"][0]["samplers"][0]; }

class GltfRefusal : public ::testing::TestWithParam<Damage> {};

TEST_P(GltfRefusal, NamesFileAndPlace) {
  GltfBuilder b = whole_gltf();
  ASSERT_TRUE(try_read(b.glb())) << "whole until it is damaged";
  GetParam().make(b);
  const auto read = try_read(b.glb());
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::BadAsset);
  EXPECT_THAT(read.error().message, HasSubstr("\"test.glb\""));
  EXPECT_THAT(read.error().message, HasSubstr(GetParam().says));
  EXPECT_THAT(read.error().message, HasSubstr("expected "));
}

const float kNan = std::numeric_limits<float>::quiet_NaN();

const Damage kDamages[] = {
    {"NoAsset", [](auto& b) { b.json.erase("asset"); }, "expected a member \"asset\""},
    {"OldVersion", [](auto& b) { b.json["asset"]["version"] = "1.0"; }, " /asset/version: "},
    {"RequiredExtension", [](auto& b) { b.json["extensionsRequired"] = Json::array({"KHR_draco_mesh_compression"}); },
     " /extensionsRequired/0: expected no other required extension"},
    {"NodesAreNoArray", [](auto& b) { b.json["nodes"] = 3; }, " /nodes: expected an array, found 3"},
    {"NodeIsNoObject", [](auto& b) { b.json["nodes"][1] = "x"; }, " /nodes/1: expected an object, found \"x\""},
    {"NoNodes",
     [](auto& b) {
       b.json.erase("nodes");
       b.json.erase("skins");
       b.json.erase("animations");
     },
     "expected at least one of \"nodes\""},
    {"NoSuchScene",
     [](auto& b) {
       b.json["scenes"] = {{{"nodes", {0}}}};
       b.json["scene"] = 1;
     },
     " /scene: expected the index of one of 1 scenes, found 1"},
    {"EmptyScene", [](auto& b) { b.json["scenes"] = Json::parse(R"([{"nodes":[]}])"); }, " /scenes/0/nodes: "},
    {"SceneOfAChild", [](auto& b) { b.json["scenes"] = Json::parse(R"([{"nodes":[1]}])"); }, " /scenes/0/nodes/0: "},
    {"NodeTwiceInAScene", [](auto& b) { b.json["scenes"] = Json::parse(R"([{"nodes":[0,0]}])"); }, " /scenes/0/nodes/1: "},
    {"NoSuchChild", [](auto& b) { b.json["nodes"][2]["children"] = {7}; },
     " /nodes/2/children/0: expected the index of one of 3 nodes, found 7"},
    {"TwoParents", [](auto& b) { b.json["nodes"][2]["children"] = {1}; },
     " /nodes/2/children/0: expected a node without another parent"},
    {"ACycle",
     [](auto& b) {
       b.json["nodes"][0].erase("children");
       b.json["nodes"][2]["children"] = {1};
     },
     ": expected a way up to a root"},
    {"ItsOwnParent",
     [](auto& b) {
       b.json["nodes"].push_back({{"children", {3}}});
     },
     " /nodes/3: expected a way up to a root"},
    {"ShortTranslation",
     [](auto& b) {
       b.json["nodes"][2]["translation"] = {1, 2};
     },
     " /nodes/2/translation: expected an array of 3 numbers, found an array of 2"},
    {"NoRotation",
     [](auto& b) {
       b.json["nodes"][2]["rotation"] = {0, 0, 0, 0};
     },
     " /nodes/2/rotation: "},
    {"HugeScale",
     [](auto& b) {
       b.json["nodes"][2]["scale"] = {1, 1e300, 1};
     },
     " /nodes/2/scale/1: "},
    {"MatrixAndMore", [](auto& b) { b.json["nodes"][2]["matrix"] = Json::array(); },
     " /nodes/2/translation: expected none beside a matrix"},
    {"ProjectiveMatrix", [](auto& b) { b.json["nodes"][1]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     " /nodes/1/matrix: "},
    {"NoSuchMesh", [](auto& b) { b.json["nodes"][0]["mesh"] = 1; }, " /nodes/0/mesh: expected the index of one of 1 meshes"},
    {"NegativeIndex", [](auto& b) { b.json["nodes"][0]["mesh"] = -1; }, " /nodes/0/mesh: "},
    {"FractionalIndex", [](auto& b) { b.json["nodes"][0]["mesh"] = 0.5; }, " /nodes/0/mesh: "},
    {"NoPrimitives", [](auto& b) { b.json["meshes"][0]["primitives"] = Json::array(); }, " /meshes/0/primitives: "},
    {"UnknownMode", [](auto& b) { primitive(b)["mode"] = 7; },
     " /meshes/0/primitives/0/mode: expected a whole number from 0 to 6, found 7"},
    {"NoSuchAccessor", [](auto& b) { primitive(b)["attributes"]["NORMAL"] = 99; },
     " /meshes/0/primitives/0/attributes/NORMAL: "},
    {"WrongType", [](auto& b) { b.json["accessors"][0]["type"] = "VEC2"; },
     " /accessors/0/type: expected VEC3 for /meshes/0/primitives/0/attributes/POSITION, found \"VEC2\""},
    {"UnknownComponent", [](auto& b) { b.json["accessors"][0]["componentType"] = 5124; }, " /accessors/0/componentType: "},
    {"QuantizedWithoutSayingSo", [](auto& b) { b.json["accessors"][0]["componentType"] = 5122; },
     " /accessors/0: expected the componentType FLOAT for /meshes/0/primitives/0/attributes/POSITION, found SHORT"},
    {"FloatIndices",
     [](auto& b) {
       primitive(b)["indices"] = 4;
       b.json["accessors"][4]["componentType"] = 5126;
     },
     " /accessors/4: expected the componentType UNSIGNED_BYTE or"},
    {"HugeCount", [](auto& b) { b.json["accessors"][0]["count"] = 1'000'000'000; },
     " /accessors/0/count: expected at most 6 elements of 12 bytes"},
    {"WrongCount", [](auto& b) { b.json["accessors"][1]["count"] = 5; }, " /accessors/1: expected 6 elements"},
    {"NoCount", [](auto& b) { b.json["accessors"][0]["count"] = 0; }, " /accessors/0/count: "},
    {"OffsetPastTheEnd", [](auto& b) { b.json["accessors"][0]["byteOffset"] = 4'000'000'000; },
     " /accessors/0/count: expected at most 0 elements"},
    {"OddOffset", [](auto& b) { b.json["accessors"][0]["byteOffset"] = 2; },
     " /accessors/0: expected a byteOffset that is a multiple"},
    {"OddStride", [](auto& b) { b.json["bufferViews"][0]["byteStride"] = 13; }, " /bufferViews/0/byteStride: "},
    {"ShortStride", [](auto& b) { b.json["bufferViews"][0]["byteStride"] = 8; },
     " /accessors/0: expected at least the 12 bytes of an element"},
    {"ViewPastTheEnd", [](auto& b) { b.json["bufferViews"][0]["byteLength"] = 100'000; },
     " /bufferViews/0/byteLength: expected at most"},
    {"ViewFarPastTheEnd", [](auto& b) { b.json["bufferViews"][0]["byteOffset"] = 9'007'199'254'740'991; },
     " /bufferViews/0/byteOffset: "},
    {"NoSuchBuffer", [](auto& b) { b.json["bufferViews"][0]["buffer"] = 1; }, " /bufferViews/0/buffer: "},
    {"LongBuffer",
     [](auto& b) {
       b.json["buffers"] = {{{"byteLength", 1'000'000}}};
     },
     " /buffers/0/byteLength: "},
    {"ForeignUri",
     [](auto& b) {
       b.json["buffers"] = {{{"byteLength", 10}, {"uri", "https://example.com/a.bin"}}};
     },
     " /buffers/0/uri: expected a path relative to the file"},
    {"UriOutside",
     [](auto& b) {
       b.json["buffers"] = {{{"byteLength", 10}, {"uri", "..%2F../a.bin"}}};
     },
     " /buffers/0/uri: "},
    {"MissingFile",
     [](auto& b) {
       b.json["buffers"] = {{{"byteLength", 10}, {"uri", "a.bin"}}};
     },
     " /buffers/0/uri: "},
    {"IndexTooLarge",
     [](auto& b) {
       primitive(b)["indices"] = b.template accessor<std::uint16_t>("SCALAR", {0, 1, 6});
     },
     ": expected indices below the 6 vertices"},
    {"Restart",
     [](auto& b) {
       primitive(b)["indices"] = b.template accessor<std::uint8_t>("SCALAR", {0, 1, 255});
     },
     "found 255 at place 2"},
    {"HalfATriangle",
     [](auto& b) {
       primitive(b)["indices"] = b.template accessor<std::uint16_t>("SCALAR", {0, 1, 2, 3});
     },
     "/indices: expected three vertices a triangle, found 4"},
    {"NanPosition", [](auto& b) { primitive(b)["attributes"]["POSITION"] = b.accessor("VEC3", std::vector<float>(18, kNan)); },
     ": expected finite numbers, found nan in element 0"},
    {"NoSuchMaterial", [](auto& b) { primitive(b)["material"] = 1; }, " /meshes/0/primitives/0/material: "},
    {"BadFactor",
     [](auto& b) {
       b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1};
     },
     " /materials/0/pbrMetallicRoughness/baseColorFactor: "},
    {"NoSuchTexture",
     [](auto& b) {
       b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
     },
     "/baseColorTexture/index: expected the index of one of 0 textures"},
    {"NoPicture",
     [](auto& b) {
       b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
       b.json["textures"] = {{{"source", 0}}};
       b.json["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
     },
     " /images/0: expected a PNG or JPEG image"},
    {"JointOfNoSkin",
     [](auto& b) {
       b.json["skins"][0]["joints"] = {1, 9};
     },
     " /skins/0/joints/1: "},
    {"JointOutsideTheScene",
     [](auto& b) {
       b.json["nodes"].push_back(Json::object());
       b.json["scenes"] = {{{"nodes", {0}}}};
       b.json["skins"][0]["joints"] = {1, 3};
     },
     " /skins/0/joints/1: expected a node of the default scene"},
    {"JointTooLarge", [](auto& b) { b.json["skins"][0]["joints"] = {1}; },
     " /meshes/0/primitives/0: expected joints below the 1 of the skin, found 1"},
    {"FewMatrices", [](auto& b) { b.json["accessors"][5]["count"] = 1; }, " /accessors/5: expected at least 2 matrices"},
    {"SkinWithoutJoints", [](auto& b) { primitive(b)["attributes"].erase("JOINTS_0"); },
     " /meshes/0/primitives/0: expected JOINTS_0"},
    {"JointsWithoutWeights", [](auto& b) { primitive(b)["attributes"].erase("WEIGHTS_0"); }, "expected a member \"WEIGHTS_0\""},
    {"NegativeWeight",
     [](auto& b) { primitive(b)["attributes"]["WEIGHTS_0"] = b.accessor("VEC4", std::vector<float>(24, -0.5F)); },
     ": expected weights >= 0, found -0.5"},
    {"NanKey", [](auto& b) { sampler(b)["output"] = b.accessor("VEC4", std::vector<float>(8, kNan)); },
     ": expected finite numbers, found nan"},
    {"NanTime",
     [](auto& b) {
       sampler(b)["input"] = b.accessor("SCALAR", std::vector<float>{0, kNan});
     },
     ": expected finite numbers, found nan"},
    {"InfiniteTime",
     [](auto& b) {
       sampler(b)["input"] = b.accessor("SCALAR", std::vector<float>{0, std::numeric_limits<float>::infinity()});
     },
     ": expected finite numbers, found inf"},
    {"UnsortedTimes",
     [](auto& b) {
       sampler(b)["input"] = b.accessor("SCALAR", std::vector<float>{1, 0});
     },
     ": expected times >= 0, each beyond the one before; found 0 at key 1 behind 1"},
    {"EqualTimes",
     [](auto& b) {
       sampler(b)["input"] = b.accessor("SCALAR", std::vector<float>{1, 1});
     },
     "found 1 at key 1 behind 1"},
    {"NegativeTime",
     [](auto& b) {
       sampler(b)["input"] = b.accessor("SCALAR", std::vector<float>{-1, 1});
     },
     "found -1 at key 0"},
    {"FewValues", [](auto& b) { sampler(b)["interpolation"] = "CUBICSPLINE"; },
     ": expected 6 elements for /animations/0/samplers/0/output, found 2"},
    {"UnknownInterpolation", [](auto& b) { sampler(b)["interpolation"] = "BEZIER"; },
     " /animations/0/samplers/0/interpolation: expected LINEAR, STEP or CUBICSPLINE, found \"BEZIER\""},
    {"ZeroQuaternion", [](auto& b) { sampler(b)["output"] = b.accessor("VEC4", std::vector<float>(8, 0.0F)); },
     ": expected unit quaternions"},
    {"NoSuchSampler", [](auto& b) { b.json["animations"][0]["channels"][0]["sampler"] = 1; },
     " /animations/0/channels/0/sampler: "},
    {"NoSuchTarget", [](auto& b) { b.json["animations"][0]["channels"][0]["target"]["node"] = 3; },
     " /animations/0/channels/0/target/node: "},
    {"TargetTwice",
     [](auto& b) {
       Json& channels = b.json["animations"][0]["channels"];
       channels.push_back(Json(channels[0]));
     },
     " /animations/0/channels/1: "},
    {"QuantizedTranslation", [](auto& b) { b.json["animations"][0]["channels"][0]["target"]["path"] = "translation"; },
     "/type: expected VEC3"},
    {"SparseIndexTooLarge",
     [](auto& b) {
       b.json["accessors"][0]["sparse"] = {
           {"count", 1},
           {"indices", {{"bufferView", b.template view<std::uint8_t>({6})}, {"componentType", 5121}}},
           {"values", {{"bufferView", 0}}}};
     },
     " /accessors/0/sparse/indices: expected ascending indices below 6, found 6"},
    {"SparseIndicesUnsorted",
     [](auto& b) {
       b.json["accessors"][0]["sparse"] = {
           {"count", 2},
           {"indices", {{"bufferView", b.template view<std::uint8_t>({2, 2})}, {"componentType", 5121}}},
           {"values", {{"bufferView", 0}}}};
     },
     "found 2 at place 1"},
    {"SparseCountTooLarge",
     [](auto& b) {
       b.json["accessors"][0]["sparse"] = {{"count", 7}};
     },
     " /accessors/0/sparse/count: "},
    {"TargetsOfOtherLength",
     [](auto& b) {
       primitive(b)["targets"] = {{{"POSITION", 4}}};
     },
     ": expected VEC3"},
    {"WeightsOfOtherLength",
     [](auto& b) {
       primitive(b)["targets"] = {{{"POSITION", 0}}};
       b.json["meshes"][0]["weights"] = {1, 2};
     },
     " /meshes/0/weights: expected an array of 1 numbers"},
};

INSTANTIATE_TEST_SUITE_P(Damages, GltfRefusal, ::testing::ValuesIn(kDamages),
                         [](const auto& damage) { return std::string(damage.param.name); });

TEST(GltfLimits, NoMemoryIsTakenForCountsThatNothingBacks) {
  // Zeros need no bytes in the file: their count is bound by the limits alone.
  GltfBuilder b = triangle_gltf();
  b.json["accessors"][0].erase("bufferView");
  b.json["accessors"][0]["count"] = 4'000'000'000;
  const auto many = try_read(b.glb());
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().code, ErrorCode::Limit);
  EXPECT_THAT(many.error().message, HasSubstr("\"test.glb\" /accessors/0: expected at most 4000000 more vertices"));
}

TEST(GltfLimits, CountVerticesOfAllNodesTogether) {
  GltfBuilder b = triangle_gltf();
  for (int i = 0; i < 9; ++i) b.json["nodes"].push_back({{"mesh", 0}});
  Limits limits;
  limits.vertices_per_actor = 30;
  EXPECT_TRUE(try_read(b.glb(), limits));
  limits.vertices_per_actor = 29;
  EXPECT_FALSE(try_read(b.glb(), limits));
  limits = {};
  limits.triangles_per_actor = 9;
  EXPECT_FALSE(try_read(b.glb(), limits));
  limits = {};
  limits.joints_per_actor = 9;
  const auto joints = try_read(b.glb(), limits);
  ASSERT_FALSE(joints);
  EXPECT_EQ(joints.error().code, ErrorCode::Limit);
}

TEST(GltfLimits, CountKeysOfAllChannels) {
  GltfBuilder b = arm_gltf();
  b.animation<float>("a", 2, "scale", "LINEAR", {0, 1, 2}, std::vector<float>(9, 1.0F));
  b.animation<float>("b", 2, "scale", "LINEAR", {0, 1, 2}, std::vector<float>(9, 1.0F));
  Limits limits;
  limits.keyed_values = 6;
  EXPECT_TRUE(try_read(b.glb(), limits));
  limits.keyed_values = 5;
  EXPECT_FALSE(try_read(b.glb(), limits));
  limits = {};
  limits.keyframes_per_clip = 2;
  EXPECT_FALSE(try_read(b.glb(), limits));
  limits = {};
  limits.clips_per_actor = 1;
  EXPECT_FALSE(try_read(b.glb(), limits));
}

TEST(GltfLimits, EveryCutIsRefused) {
  const std::string whole = whole_gltf().glb();
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const auto read = try_read(whole.substr(0, size));
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(read.error().code, ErrorCode::BadAsset);
  }
}

TEST(GltfLimits, DeepChainsOfNodesAreWalkedWithoutRecursion) {
  GltfBuilder b;
  b.json["nodes"] = Json::array();
  for (int i = 0; i < 100'000; ++i) b.json["nodes"].push_back({{"children", {i + 1}}});
  b.json["nodes"].push_back(Json::object());
  Limits limits;
  limits.joints_per_actor = 1'000'000;
  EXPECT_EQ(must(try_read(b.glb(), limits)).model->joint_count(), 100'001U);
}

}  // namespace
}  // namespace tweend::assets
