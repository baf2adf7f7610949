// glTF files as assets: listed, with files of their own beside them, kept inside the folder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/assets/asset_library.hpp"
#include "tests/assets/sample_gltf.hpp"
#include "tests/assets/sample_images.hpp"
#include "tests/assets/temp_folder.hpp"

namespace tweend::assets {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

AssetLibrary library_of(const TempFolder& folder, const Limits& limits = {}) {
  std::vector<AssetRoot> roots;
  roots.push_back(must(AssetRoot::open(folder.path("assets").string())));
  return {std::move(roots), limits};
}

TEST(GltfAssets, AreListedWithTheirType) {
  const TempFolder folder;
  folder.write("assets/a.glb", triangle_gltf().glb());
  folder.write("assets/deep/B.GLTF", triangle_gltf().gltf());
  folder.write("assets/deep/b.bin", "1234");
  std::vector<std::string> lines;
  for (const AssetInfo& info : must(library_of(folder).list())) {
    lines.push_back(info.name + " " + info.type);
    EXPECT_GT(info.bytes, 100U);
  }
  EXPECT_THAT(lines, ElementsAre("a.glb glb", "deep/B.GLTF gltf"));
}

TEST(GltfAssets, ReadFilesBesideThem) {
  const TempFolder folder;
  GltfBuilder b = triangle_gltf();
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  b.json["materials"] = Json::parse(R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])");
  b.json["textures"] = Json::parse(R"([{"source":0}])");
  b.json["images"] = Json::parse(R"([{"uri":"../my%20pictures/red.png"}])");
  folder.write("assets/models/a.gltf", b.gltf("data.bin"));
  folder.write("assets/models/data.bin", b.bin);
  folder.write("assets/my pictures/red.png", png_file({1, 1, {255, 0, 0, 255}}));
  const model::ImportedModel m = must(library_of(folder).import("models/a.gltf"));
  EXPECT_EQ(m.source, "models/a.gltf");
  ASSERT_NE(m.model->mesh->surface().materials[0].base_color_texture, nullptr);
  EXPECT_EQ(m.model->mesh->surface().materials[0].base_color_texture->rgba(), (std::vector<std::uint8_t>{255, 0, 0, 255}));
}

TEST(GltfAssets, StayInsideTheFolder) {
  const TempFolder folder;
  const GltfBuilder b = triangle_gltf();
  folder.write("outside.bin", b.bin);
  folder.write("assets/up.gltf", b.gltf("../outside.bin"));
  folder.write("assets/escaped.gltf", b.gltf("%2E%2E/outside.bin"));
  folder.write("assets/absolute.gltf", b.gltf((folder.path() / "outside.bin").string()));
  folder.write("assets/linked.gltf", b.gltf("link.bin"));
  folder.link("assets/link.bin", folder.path() / "outside.bin");
  for (const char* name : {"up.gltf", "escaped.gltf", "absolute.gltf", "linked.gltf"}) {
    const auto imported = library_of(folder).import(name);
    ASSERT_FALSE(imported) << name;
    EXPECT_EQ(imported.error().code, ErrorCode::BadAsset) << name;
    EXPECT_THAT(imported.error().message, HasSubstr("\"" + std::string(name) + "\" /buffers/0/uri: ")) << name;
  }
}

TEST(GltfAssets, CountTheBytesOfAllTheirFiles) {
  const TempFolder folder;
  const GltfBuilder b = triangle_gltf();
  const std::string text = b.gltf("a.bin");
  folder.write("assets/a.gltf", text);
  folder.write("assets/a.bin", b.bin);
  Limits limits;
  limits.asset_bytes = text.size() + b.bin.size();
  EXPECT_TRUE(library_of(folder, limits).import("a.gltf"));
  limits.asset_bytes -= 1;
  const auto imported = library_of(folder, limits).import("a.gltf");
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.error().code, ErrorCode::Limit);
}

TEST(GltfAssets, TellHowFarTheyAre) {
  const TempFolder folder;
  GltfBuilder b = arm_gltf();
  b.animation<float>("a", 2, "scale", "LINEAR", {0}, {1, 1, 1});
  folder.write("assets/a.glb", b.glb());
  std::vector<double> told;
  const auto imported = library_of(folder).import("a.glb", {24.0, [&](double fraction) { told.push_back(fraction); }});
  ASSERT_TRUE(imported);
  EXPECT_EQ(told.front(), 0.0);
  EXPECT_EQ(told.back(), 1.0);
  EXPECT_GE(told.size(), 4U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
}

TEST(GltfAssets, GoThroughTheModelBlob) {
  const TempFolder folder;
  folder.write("assets/a.glb", arm_gltf().glb());
  const AssetLibrary library = library_of(folder);
  const model::ModelBlob blob = must(library.import_blob("a.glb"));
  const model::ImportedModel read = must(model::read_model_blob(blob.bytes));
  EXPECT_EQ(read.model->skin->hash(), must(library.import("a.glb")).model->skin->hash());
  EXPECT_EQ(read.model->skin->hash(), must_read(arm_gltf()).model->skin->hash());
}

}  // namespace
}  // namespace tweend::assets
