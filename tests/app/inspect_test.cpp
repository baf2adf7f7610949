#include "server/app/inspect.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/app/asset_report.hpp"
#include "tests/assets/sample_gltf.hpp"
#include "tests/assets/temp_folder.hpp"

namespace tweend::app {
namespace {

using assets::GltfBuilder;
using ::testing::HasSubstr;

TEST(Inspect, TellsWhatAFileHolds) {
  const assets::TempFolder folder;
  GltfBuilder b = assets::arm_gltf();
  b.json["asset"]["generator"] = "a\x1B[2Jb";
  b.json["extensionsUsed"] = assets::Json::array({"KHR_mesh_quantization", "KHR_lights_punctual"});
  b.json["extensionsRequired"] = assets::Json::array({"KHR_mesh_quantization"});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  b.json["materials"] =
      assets::Json::parse(R"([{"name":"skin","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]},"alphaMode":"BLEND"}])");
  b.animation<float>("bend", 2, "rotation", "LINEAR", {0, 1, 2}, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1});
  folder.write("a.glb", b.glb());
  const auto text = inspect_asset({folder.path("a.glb").string(), {}});
  ASSERT_TRUE(text) << text.error().message;
  for (const char* line :
       {"glTF 2.0, written by a?[2Jb\n", "3 nodes, 1 mesh, 1 skin, 1 animation, 1 material",
        "extension KHR_mesh_quantization, required\n", "extension KHR_lights_punctual\n",
        "Skeleton: 3 joints, 3 deep\n  bar\n    shoulder\n      elbow\n", "6 vertices, 4 triangles",
        "skin: 4 triangles, #ff0000", "2 matrices, 4 influences a vertex",
        "bend: 2.000 s, 3 keyframes, 3 keys; 1 rotation (linear)\n", "Warnings: 1\n", "/materials/0/alphaMode"}) {
    EXPECT_THAT(*text, HasSubstr(line));
  }
}

TEST(Inspect, TellsWhatIsWrong) {
  const assets::TempFolder folder;
  GltfBuilder b = assets::arm_gltf();
  b.json["accessors"][0]["count"] = 7;
  folder.write("a.glb", b.glb());
  const auto text = inspect_asset({folder.path("a.glb").string(), {}});
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().message, HasSubstr("\"a.glb\" /accessors/0/count: expected at most 6 elements"));
  EXPECT_FALSE(inspect_asset({folder.path("none.glb").string(), {}}));
}

TEST(Inspect, KeepsControlCharactersFromTheTerminal) {
  EXPECT_EQ(printable("plain Ä €"), "plain Ä €");
  EXPECT_EQ(printable("a\x1B[31m\n\x7F"), "a?[31m??");
  EXPECT_EQ(printable("a\xC2\x9B"
                      "31m"),
            "a?31m");
}

}  // namespace
}  // namespace tweend::app
