#include "server/assets/asset_library.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "tests/assets/must.hpp"
#include "tests/assets/sample_images.hpp"
#include "tests/assets/sample_objs.hpp"
#include "tests/assets/temp_folder.hpp"

using testing::AllOf;
using testing::HasSubstr;

namespace tweend::assets {
namespace {

class AssetLibraryTest : public testing::Test {
 protected:
  /// A library of these folders of the temporary one.
  [[nodiscard]] AssetLibrary library(const std::vector<std::string>& names = {"root"}, const Limits& limits = {}) const {
    std::vector<AssetRoot> roots;
    for (const std::string& name : names) {
      folder_.make_folder(name);
      roots.push_back(must(AssetRoot::open(folder_.path(name).string())));
    }
    return AssetLibrary(std::move(roots), limits);
  }
  /// "name type bytes, …" of all assets.
  static std::string listed(const AssetLibrary& library) {
    std::string text;
    for (const AssetInfo& a : must(library.list())) {
      text += fmt::format("{}{} {} {}", text.empty() ? "" : ", ", a.name, a.type, a.bytes);
    }
    return text;
  }
  static Error error_of(const AssetLibrary& library, std::string_view name) {
    const auto model = library.import(name);
    return model ? Error{} : model.error();
  }
  void write_triangle(std::string_view name) const { folder_.write(name, kTriangle); }

  TempFolder folder_;
};

TEST_F(AssetLibraryTest, ListsFilesAndSequencesByName) {
  folder_.write("root/z.obj", "12");
  folder_.write("root/loose_1.obj", "1");  // in the root itself: no sequence
  folder_.write("root/walk/walk_000000.obj", "123");
  folder_.write("root/walk/walk_000010.obj", "1234");
  folder_.write("root/walk/base.OBJ", "12345");
  folder_.write("root/walk/notes.txt", "x");
  folder_.write("root/props/chair/chair.obj", "1");
  folder_.write("root/.git/a.obj", "1");
  folder_.write("root/.a.obj", "1");
  folder_.write("root/model.glb", "1");
  folder_.make_folder("root/empty");
  EXPECT_EQ(
      listed(library()),
      "loose_1.obj obj 1, model.glb glb 1, props/chair/chair.obj obj 1, walk obj_sequence 7, walk/base.OBJ obj 5, z.obj obj 2");
}

TEST_F(AssetLibraryTest, ListsNothingOfNothing) {
  EXPECT_EQ(listed(library()), "");
  EXPECT_EQ(listed(AssetLibrary({}, Limits{})), "");
}

TEST_F(AssetLibraryTest, AnEarlierFolderHidesALaterOnesAsset) {
  folder_.write("one/a.obj", "1");
  folder_.write("two/a.obj", "22");
  folder_.write("two/b.obj", "22");
  EXPECT_EQ(listed(library({"one", "two"})), "a.obj obj 1, b.obj obj 2");
  EXPECT_EQ(listed(library({"two", "one"})), "a.obj obj 2, b.obj obj 2");
}

TEST_F(AssetLibraryTest, LinksDoNotMakeListingLoopOrLeave) {
  folder_.write("outside/secret.obj", "1");
  folder_.write("root/walk/walk_1.obj", "1");
  folder_.write("root/plain/a.obj", "1");
  folder_.link("root/out", "../outside");
  folder_.link("root/alias", "walk");
  folder_.link("root/plain/up", "..");
  folder_.link("root/plain/self", ".");
  folder_.link("root/twin.obj", "plain/a.obj");
  EXPECT_EQ(listed(library()), "alias obj_sequence 1, plain/a.obj obj 1, twin.obj obj 1, walk obj_sequence 1");
}

TEST_F(AssetLibraryTest, ListingEndsAtADepth) {
  std::string path = "root/";
  for (int i = 0; i < 20; ++i) {
    folder_.write(path + "a.obj", "1");
    path += "d/";
  }
  EXPECT_EQ(must(library().list()).size(), 17U);
}

TEST_F(AssetLibraryTest, ImportsAFileAtFrameZero) {
  write_triangle("root/props/Tri.OBJ");
  const model::ImportedModel imported = must(library().import("props/Tri.OBJ"));
  EXPECT_EQ(imported.source, "props/Tri.OBJ");
  ASSERT_EQ(imported.clips.size(), 1U);
  EXPECT_EQ(imported.clips[0].name, "default");
  EXPECT_EQ(imported.clips[0].times_s, std::vector<double>{0.0});
}

TEST_F(AssetLibraryTest, ImportsASequenceInOrderOfItsNumbers) {
  folder_.write("root/s/s_10.obj", triangle_to("0 10 0"));
  folder_.write("root/s/s_7.obj", triangle_to("0 7 0"));
  folder_.write("root/s/s_0100.obj", triangle_to("0 100 0"));
  folder_.write("root/s/other.obj", "not read");
  const model::ImportedModel imported = must(library().import("s", {.fps = 10.0}));
  EXPECT_EQ(imported.source, "s");
  const model::Clip& clip = imported.clips.at(0);
  EXPECT_EQ(clip.times_s, (std::vector<double>{0.7, 1.0, 10.0})) << "frames 7, 10 and 100 at 10 a second";
  ASSERT_EQ(clip.keyframes.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(clip.keyframes[i].vertices->positions()[7], (std::array{7.0F, 10.0F, 100.0F})[i]);
  }
  EXPECT_EQ(must(library().import("s")).clips[0].times_s[2], 100.0 / 24.0) << "24 frames a second unless told";
}

TEST_F(AssetLibraryTest, ImportsAMemberOfASequenceByItsPath) {
  folder_.write("root/s/s_7.obj", triangle_to("0 7 0"));
  const model::ImportedModel imported = must(library().import("s/s_7.obj"));
  EXPECT_EQ(imported.clips[0].times_s, std::vector<double>{0.0}) << "on its own it's no frame of anything";
}

TEST_F(AssetLibraryTest, ImportsWhatIsListed) {
  folder_.make_folder("one/s");  // a folder that is no sequence hides none
  folder_.write("two/s/s_1.obj", kTriangle);
  folder_.write("two/a.obj", kTriangle);
  const AssetLibrary assets = library({"one", "two"});
  ASSERT_EQ(must(assets.list()).size(), 2U);
  for (const AssetInfo& asset : must(assets.list())) EXPECT_TRUE(assets.import(asset.name)) << asset.name;
}

TEST_F(AssetLibraryTest, NamesThatAreNoAssetAreNotFound) {
  folder_.write("secret.obj", kTriangle);
  folder_.link("root/link.obj", "../secret.obj");
  folder_.link("root/passwd.obj", "/etc/passwd");
  folder_.make_folder("root/sub");
  for (const char* name :
       {"nothing", "", "..", "../secret.obj", "sub/../../secret.obj", "/etc/passwd", "link.obj", "passwd.obj"}) {
    const Error error = error_of(library(), name);
    EXPECT_EQ(error.code, ErrorCode::NotFound) << name;
    EXPECT_THAT(error.message, HasSubstr("asset.list")) << name;
  }
}

TEST_F(AssetLibraryTest, OtherFilesAndFoldersAreBadAssets) {
  folder_.write("root/a.fbx", "Kaydara");
  folder_.make_folder("root/empty");
  for (const char* name : {"a.fbx", "empty"}) {
    const Error error = error_of(library(), name);
    EXPECT_EQ(error.code, ErrorCode::BadAsset) << name;
    EXPECT_THAT(error.message, AllOf(HasSubstr("a .glb, .gltf or .obj file, or a folder of NAME_000000.obj"), HasSubstr(name)));
  }
}

TEST_F(AssetLibraryTest, ErrorsNameTheFileByItsAssetPath) {
  write_triangle("root/bad/bad_000000.obj");
  folder_.write("root/bad/bad_000010.obj", "v 0 0 0\nv 0 abc 0\n");
  EXPECT_EQ(error_of(library(), "bad").message, "bad/bad_000010.obj:2: expected a finite number, found \"abc\"");
  folder_.write("root/bad/bad_000010.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n");
  EXPECT_EQ(error_of(library(), "bad").message,
            "bad/bad_000010.obj: expected 1 faces as in bad/bad_000000.obj, found 2 (last face at line 5)");
}

TEST_F(AssetLibraryTest, SequencesMustBeOne) {
  write_triangle("root/two/a_1.obj");
  write_triangle("root/two/b_2.obj");
  EXPECT_EQ(error_of(library(), "two").code, ErrorCode::BadAsset);
  EXPECT_EQ(listed(library()), "two obj_sequence " + std::to_string(2 * kTriangle.size()));
}

TEST_F(AssetLibraryTest, BytesOfAnAssetAreLimitedTogether) {
  write_triangle("root/s/s_1.obj");
  write_triangle("root/s/s_2.obj");
  Limits limits;
  limits.asset_bytes = 2 * kTriangle.size();
  EXPECT_TRUE(library({"root"}, limits).import("s"));
  limits.asset_bytes -= 1;
  EXPECT_EQ(error_of(library({"root"}, limits), "s").code, ErrorCode::Limit);
  EXPECT_TRUE(library({"root"}, limits).import("s/s_1.obj"));
  limits.asset_bytes = kTriangle.size() - 1;
  EXPECT_EQ(error_of(library({"root"}, limits), "s/s_1.obj").code, ErrorCode::Limit);
}

TEST_F(AssetLibraryTest, FilesOfASequenceAreLimited) {
  write_triangle("root/s/s_1.obj");
  write_triangle("root/s/s_2.obj");
  Limits limits;
  limits.keyframes_per_clip = 1;
  EXPECT_EQ(error_of(library({"root"}, limits), "s").code, ErrorCode::Limit);
}

TEST_F(AssetLibraryTest, MaterialsLieBesideTheirFile) {
  folder_.write("root/props/tex/a.png", png_file({1, 1, {1, 2, 3, 4}}));
  folder_.write("root/props/a.mtl", "newmtl m\nKd 0.5\nmap_Kd tex/a.png\n");
  folder_.write("root/props/a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  const model::ImportedModel imported = must(library().import("props/a.obj"));
  EXPECT_TRUE(imported.warnings.empty());
  const model::Surface& surface = imported.model->mesh->surface();
  ASSERT_EQ(surface.materials.size(), 1U);
  EXPECT_EQ(surface.materials[0].base_color, glm::vec3(0.5F));
  ASSERT_TRUE(surface.materials[0].base_color_texture);
  EXPECT_EQ(surface.materials[0].base_color_texture->rgba(), (std::vector<std::uint8_t>{1, 2, 3, 4}));
}

TEST_F(AssetLibraryTest, ASequenceHasTheMaterialsOfItsFirstFrame) {
  const std::string triangle(kTriangle);
  folder_.write("root/s/m.mtl", "newmtl m\nKd 1 0 0\n");
  folder_.write("root/s/s_2.obj", "mtllib gone.mtl\nusemtl other\n" + triangle);
  folder_.write("root/s/s_1.obj", "mtllib m.mtl\nusemtl m\n" + triangle);
  const model::ImportedModel imported = must(library().import("s"));
  EXPECT_TRUE(imported.warnings.empty());
  ASSERT_EQ(imported.model->mesh->surface().materials.size(), 1U);
  EXPECT_EQ(imported.model->mesh->surface().materials[0].base_color, glm::vec3(1, 0, 0));
}

TEST_F(AssetLibraryTest, AbsentMaterialsAreWarnedOfAndMalformedOnesRefused) {
  folder_.write("root/a.obj", "mtllib a.mtl\nusemtl m\n" + std::string(kTriangle));
  const model::ImportedModel imported = must(library().import("a.obj"));
  EXPECT_EQ(imported.warnings.size(), 1U);
  EXPECT_TRUE(imported.model->mesh->surface().materials.empty());
  folder_.write("root/a.mtl", "newmtl m\nKd 1 1\n");
  EXPECT_EQ(error_of(library(), "a.obj").code, ErrorCode::BadAsset);
  EXPECT_EQ(error_of(library(), "a.obj").message, "a.mtl:2: expected 1 or 3 numbers, found 2");
}

TEST_F(AssetLibraryTest, SideFilesCountTowardsTheBytesOfAnAssetButAreNotListed) {
  const std::string obj = "mtllib m.mtl\nusemtl m\n" + std::string(kTriangle);
  const std::string mtl = "newmtl m\nKd 1\n";
  folder_.write("root/s/m.mtl", mtl);
  folder_.write("root/s/s_1.obj", obj);
  folder_.write("root/s/s_2.obj", obj);
  EXPECT_EQ(listed(library()), fmt::format("s obj_sequence {}", 2 * obj.size()));
  Limits limits;
  limits.asset_bytes = 2 * obj.size() + mtl.size();
  EXPECT_TRUE(library({"root"}, limits).import("s"));
  limits.asset_bytes -= 1;
  EXPECT_EQ(error_of(library({"root"}, limits), "s").code, ErrorCode::Limit);
  limits.asset_bytes = obj.size() + mtl.size();
  EXPECT_TRUE(library({"root"}, limits).import("s/s_1.obj"));
  limits.asset_bytes -= 1;
  EXPECT_EQ(error_of(library({"root"}, limits), "s/s_1.obj").code, ErrorCode::Limit);
}

TEST_F(AssetLibraryTest, AnyThreadMayAsk) {
  write_triangle("root/s/s_1.obj");
  const AssetLibrary assets = library();
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int n = 0; n < 20; ++n) {
        EXPECT_TRUE(assets.import("s"));
        EXPECT_EQ(must(assets.list()).size(), 1U);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace tweend::assets
