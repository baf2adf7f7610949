#include "server/assets/obj_materials.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/assets/sample_images.hpp"
#include "tests/assets/sample_objs.hpp"
#include "tests/assets/temp_folder.hpp"

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

namespace tweend::assets {
namespace {

constexpr std::string_view kMapped = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";

std::string small_png(std::uint8_t grey = 9) { return png_file({1, 1, {grey}}, {SPNG_COLOR_TYPE_GRAYSCALE}); }

class LoadObjMaterials : public testing::Test {
 protected:
  LoadObjMaterials() { folder_.make_folder("root/props"); }

  /// For an OBJ at props/a.obj: `head`, then a face that has texture coordinates.
  [[nodiscard]] Result<ObjMaterials> load(std::string_view head, std::size_t max_bytes = 1U << 20U,
                                          const Limits& limits = {}) const {
    return load_file(must_read(fmt::format("{}\n{}", head, kMapped), "props/a.obj"), max_bytes, limits);
  }
  [[nodiscard]] Result<ObjMaterials> load_file(const ObjFile& file, std::size_t max_bytes = 1U << 20U,
                                               const Limits& limits = {}) const {
    const AssetRoot root = must(AssetRoot::open(folder_.path("root").string()));
    return load_obj_materials(root, file, max_bytes, limits);
  }
  /// With m.mtl holding `mtl`, of which the face uses the material m.
  [[nodiscard]] Result<ObjMaterials> load_mtl(std::string_view mtl) const {
    folder_.write("root/props/m.mtl", mtl);
    return load("mtllib m.mtl\nusemtl m");
  }
  [[nodiscard]] model::Material must_load_m(std::string_view mtl) const {
    const ObjMaterials found = must(load_mtl(mtl));
    EXPECT_THAT(found.warnings, IsEmpty());
    return found.materials.at(0).value();
  }
  [[nodiscard]] Error error_of(const Result<ObjMaterials>& result) const { return result ? Error{} : result.error(); }

  TempFolder folder_;
};

TEST_F(LoadObjMaterials, WithoutNamesThereIsNothing) {
  const ObjMaterials found = must(load(""));
  EXPECT_THAT(found.materials, IsEmpty());
  EXPECT_THAT(found.warnings, IsEmpty());
}

TEST_F(LoadObjMaterials, FindsColoursAndTextures) {
  folder_.write("root/props/tex/wood 1.png", small_png());
  const model::Material m = must_load_m("newmtl m\nKd 0.25 0.5 1\nmap_Kd tex\\wood 1.png\n");
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.base_color, glm::vec3(0.25F, 0.5F, 1.0F));
  ASSERT_TRUE(m.base_color_texture);
  EXPECT_THAT(m.base_color_texture->rgba(), ElementsAre(9, 9, 9, 255));
}

TEST_F(LoadObjMaterials, ColoursAreClamped) {
  EXPECT_EQ(must_load_m("newmtl m\nKd -1 0.5 255\n").base_color, glm::vec3(0.0F, 0.5F, 1.0F));
}

TEST_F(LoadObjMaterials, WithoutKdATextureIsShownAsItIsAndNothingIsTheDefault) {
  folder_.write("root/props/t.png", small_png());
  EXPECT_EQ(must_load_m("newmtl m\nmap_Kd t.png\n").base_color, glm::vec3(1.0F));
  EXPECT_EQ(must_load_m("newmtl m\nKs 1 1 1\n").base_color, model::kDefaultBaseColor);
}

TEST_F(LoadObjMaterials, AStatementNamesOneLibraryWithBlanksOrSeveral) {
  folder_.write("root/props/a b.mtl", "newmtl whole\nKd 1\n");
  folder_.write("root/props/a", "newmtl a\nKd 1\n");
  folder_.write("root/props/b.mtl", "newmtl b\nKd 1\n");
  folder_.write("root/c.mtl", "newmtl c\nKd 1\n");
  const auto known = [&](std::string_view mtllib) {
    const ObjMaterials found = must(
        load(fmt::format("{}\nusemtl whole\n{}\nusemtl a\n{}\nusemtl b\n{}\nusemtl c\n", mtllib, kMapped, kMapped, kMapped)));
    std::string names;
    for (const auto& m : found.materials) names += m ? m->name + " " : "";
    return names;
  };
  EXPECT_EQ(known("mtllib a b.mtl"), "whole ");
  EXPECT_EQ(known("mtllib a  b.mtl"), "a b ");
  EXPECT_EQ(known("mtllib b.mtl ../c.mtl # twice"), "b c ");
  EXPECT_EQ(known("mtllib b.mtl\nmtllib ..\\c.mtl"), "b c ");
}

TEST_F(LoadObjMaterials, TheLaterLibraryWins) {
  folder_.write("root/props/1.mtl", "newmtl m\nKd 0.25\n");
  folder_.write("root/props/2.mtl", "newmtl m\nKd 0.5\n");
  EXPECT_EQ(must(load("mtllib 1.mtl 2.mtl\nusemtl m")).materials[0]->base_color, glm::vec3(0.5F));
  EXPECT_EQ(must(load("mtllib 2.mtl\nmtllib 1.mtl\nusemtl m")).materials[0]->base_color, glm::vec3(0.25F));
}

TEST_F(LoadObjMaterials, ATextureIsReadOnceForAllItsMaterials) {
  const std::string png = small_png();
  const std::string mtl = "newmtl a\nmap_Kd t.png\nnewmtl b\nmap_Kd ./x/../t.png\nnewmtl c\nmap_Kd ..\\props\\t.png\n";
  folder_.write("root/props/t.png", png);
  folder_.write("root/props/m.mtl", mtl);
  const std::string head = fmt::format("mtllib m.mtl\nmtllib ./m.mtl\nusemtl a\n{0}usemtl b\n{0}usemtl c\n", kMapped);
  const ObjMaterials found = must(load(head, mtl.size() + png.size()));
  EXPECT_EQ(found.materials[0]->base_color_texture, found.materials[1]->base_color_texture);
  EXPECT_EQ(found.materials[0]->base_color_texture, found.materials[2]->base_color_texture);
}

TEST_F(LoadObjMaterials, MissingLibrariesArePassedOverWithALine) {
  const ObjMaterials found = must(load("mtllib barb_000000.mtl\nmtllib a.mtl b.mtl\nusemtl m"));
  ASSERT_EQ(found.materials.size(), 1U);
  EXPECT_FALSE(found.materials[0]) << "of the material nothing more is said";
  EXPECT_THAT(found.warnings,
              ElementsAre("props/a.obj: expected the material library \"barb_000000.mtl\", found none: faces of "
                          "its materials show the default one",
                          HasSubstr("\"a.mtl\""), HasSubstr("\"b.mtl\"")));
}

TEST_F(LoadObjMaterials, UnknownMaterialsArePassedOverWithALine) {
  const std::string expected =
      "props/a.obj: expected the material \"m\" in a library, found none: its faces show the default one";
  EXPECT_THAT(must(load_mtl("newmtl other\nKd 1\n")).warnings, ElementsAre(expected));
  EXPECT_THAT(must(load("usemtl m")).warnings, ElementsAre(expected));
}

TEST_F(LoadObjMaterials, MissingTexturesArePassedOverWithALine) {
  folder_.make_folder("root/props/folder");
  for (const char* name : {"gone.png", "folder", ".", "gone/t.png"}) {
    const ObjMaterials found = must(load_mtl(fmt::format("newmtl m\nKd 0.5\nmap_Kd {}\n", name)));
    EXPECT_EQ(found.materials[0]->base_color, glm::vec3(0.5F));
    EXPECT_FALSE(found.materials[0]->base_color_texture);
    EXPECT_THAT(found.warnings,
                ElementsAre(fmt::format(
                    "props/a.obj: expected the texture \"{}\" of material \"m\", found none: it is not shown", name)));
  }
  EXPECT_EQ(must(load_mtl("newmtl m\nmap_Kd gone.png\n")).materials[0]->base_color, model::kDefaultBaseColor);
}

TEST_F(LoadObjMaterials, NothingOutsideOfTheFolderIsRead) {
  folder_.write("secret.mtl", "newmtl m\nKd 1\n");
  folder_.write("secret.png", small_png());
  folder_.link("root/props/link.mtl", "../../secret.mtl");
  folder_.link("root/props/link.png", "../../secret.png");
  folder_.link("root/props/out", "../..");
  const std::string absolute = folder_.path("secret").string();
  for (const std::string& name : {std::string("../../secret"), std::string("link"), std::string("out/secret"), absolute,
                                  std::string("../props/../../secret")}) {
    const ObjMaterials library = must(load(fmt::format("mtllib {}.mtl\nusemtl m", name)));
    EXPECT_FALSE(library.materials[0]) << name;
    EXPECT_EQ(library.warnings.size(), 1U) << name;
    const ObjMaterials texture = must(load_mtl(fmt::format("newmtl m\nKd 1\nmap_Kd {}.png\n", name)));
    EXPECT_FALSE(texture.materials[0]->base_color_texture) << name;
    EXPECT_EQ(texture.warnings.size(), 1U) << name;
  }
}

TEST_F(LoadObjMaterials, LinksThatStayAreFollowed) {
  folder_.write("root/shared/t.png", small_png());
  folder_.link("root/props/t.png", "../shared/t.png");
  EXPECT_TRUE(must_load_m("newmtl m\nmap_Kd t.png\n").base_color_texture);
}

TEST_F(LoadObjMaterials, WithoutTexcoordsTheColourStaysAndTheTextureIsNotEvenRead) {
  folder_.write("root/props/t.png", "corrupt");
  folder_.write("root/props/m.mtl", "newmtl m\nKd 0.5\nmap_Kd t.png\n");
  const ObjFile file = must_read(fmt::format("mtllib m.mtl\nusemtl m\n{}", kTriangle), "props/a.obj");
  const ObjMaterials found = must(load_file(file));
  EXPECT_EQ(found.materials[0]->base_color, glm::vec3(0.5F));
  EXPECT_FALSE(found.materials[0]->base_color_texture);
  EXPECT_THAT(found.warnings, ElementsAre(StartsWith("props/a.obj: expected texture coordinates for the texture \"t.png\"")));
}

TEST_F(LoadObjMaterials, TexturesOfMaterialsThatNoFaceUsesAreNotRead) {
  folder_.write("root/props/t.png", "corrupt");
  EXPECT_TRUE(load_mtl("newmtl m\nKd 1\nnewmtl n\nmap_Kd t.png\n"));
}

TEST_F(LoadObjMaterials, MalformedFilesAreRefused) {
  EXPECT_EQ(error_of(load_mtl("newmtl m\nKd red\n")).code, ErrorCode::BadAsset);
  EXPECT_EQ(error_of(load_mtl("newmtl m\nKd red\n")).message, "props/m.mtl:2: expected a finite number, found \"red\"");
  folder_.write("root/props/t.png", small_png().substr(0, 40));
  const Error texture = error_of(load_mtl("newmtl m\nmap_Kd t.png\n"));
  EXPECT_EQ(texture.code, ErrorCode::BadAsset);
  EXPECT_THAT(texture.message, StartsWith("props/t.png: expected a whole PNG image, found: "));
}

TEST_F(LoadObjMaterials, BytesAreLimitedTogether) {
  const std::string mtl = "newmtl m\nmap_Kd t.png\n";
  const std::string png = small_png();
  folder_.write("root/props/m.mtl", mtl);
  folder_.write("root/props/t.png", png);
  EXPECT_TRUE(load("mtllib m.mtl\nusemtl m", mtl.size() + png.size()));
  EXPECT_EQ(error_of(load("mtllib m.mtl\nusemtl m", mtl.size() + png.size() - 1)).code, ErrorCode::Limit);
  EXPECT_EQ(error_of(load("mtllib m.mtl\nusemtl m", mtl.size() - 1)).code, ErrorCode::Limit);
}

TEST_F(LoadObjMaterials, PixelsAreLimitedEachAndTogether) {
  std::string mtl;
  std::string head = "mtllib m.mtl\n";
  for (int i = 0; i < 17; ++i) {
    folder_.write(fmt::format("root/props/{}.png", i), png_file({2, 1, std::vector<std::uint8_t>(8)}));
    mtl += fmt::format("newmtl {0}\nmap_Kd {0}.png\n", i);
    head += fmt::format("usemtl {}\n{}", i, i < 16 ? kMapped : "");
  }
  folder_.write("root/props/m.mtl", mtl);
  Limits limits;
  limits.texture_pixels = 1;
  EXPECT_EQ(error_of(load(head, 1U << 20U, limits)).message, "props/0.png: expected at most 1 pixels, found 2 x 1 = 2");
  limits.texture_pixels = 2;
  const Error together = error_of(load(head, 1U << 20U, limits));
  EXPECT_EQ(together.code, ErrorCode::Limit);
  EXPECT_EQ(together.message, "props/a.obj: expected textures of at most 16 x 2 pixels together, found more");
  folder_.write("root/props/16.png", png_file({1, 1, std::vector<std::uint8_t>(4)}));
  folder_.write("root/props/15.png", png_file({1, 1, std::vector<std::uint8_t>(4)}));
  EXPECT_TRUE(load(head, 1U << 20U, limits));
}

TEST_F(LoadObjMaterials, NamesOfLibrariesAndWarningsAreLimited) {
  std::string mtllib = "mtllib";
  for (int i = 0; i < 255; ++i) mtllib += fmt::format(" {}.mtl", i);
  const ObjMaterials found = must(load(mtllib));
  ASSERT_EQ(found.warnings.size(), 17U);
  EXPECT_EQ(found.warnings.back(), "props/a.obj: and 239 more like these");
  EXPECT_EQ(error_of(load(mtllib + " more")).code, ErrorCode::Limit);
}

TEST_F(LoadObjMaterials, WarningsAreOneLineWhateverTheNamesHold) {
  const ObjMaterials found = must(load("mtllib \x1B[31m\xC3\xA9.mtl"));
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("\"\\x1b[31m\\xc3\\xa9.mtl\"")));
}

}  // namespace
}  // namespace tweend::assets
