#include "server/assets/obj_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "tests/assets/sample_objs.hpp"

using namespace std::literals;
using testing::ElementsAre;
using testing::StartsWith;

namespace tweend::assets {
namespace {

/// Line 1 to 4 of a file that takes one more statement to be whole.
constexpr std::string_view kHead = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";

std::string error_of(std::string_view text) {
  const auto file = read_obj(text, "a/b.obj", Limits{});
  if (file) return "no error";
  EXPECT_EQ(file.error().code, ErrorCode::BadAsset);
  return file.error().message;
}

TEST(ReadObj, ReadsListsAndFaces) {
  const ObjFile file = must_read(
      "mtllib x.mtl\no Thing\nv 0 0 0\nv 1.5 -2 +3\nv 1e1 .5 5.\nvt 0.25 0.75\nvn 0 0 1\nusemtl m\ns off\nf 1/1/1 2/1/1 "
      "3/1/1\n",
      "n.obj");
  EXPECT_EQ(file.name, "n.obj");
  EXPECT_THAT(file.positions, ElementsAre(0, 0, 0, 1.5F, -2, 3, 10, 0.5F, 5));
  EXPECT_THAT(file.texcoords, ElementsAre(0.25F, 0.75F));
  EXPECT_THAT(file.normals, ElementsAre(0, 0, 1));
  EXPECT_THAT(file.corners, ElementsAre(ObjCorner{0, 0, 0}, ObjCorner{1, 0, 0}, ObjCorner{2, 0, 0}));
  EXPECT_THAT(file.faces, ElementsAre(ObjFace{0, 3, 10, 0}));
  EXPECT_THAT(file.material_libraries, ElementsAre("x.mtl"));
  EXPECT_THAT(file.material_names, ElementsAre("m"));
}

TEST(ReadObj, ReadsEveryFormOfCorner) {
  const ObjFile file =
      must_read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\n");
  ASSERT_EQ(file.faces.size(), 4U);
  EXPECT_EQ(file.corners[0], (ObjCorner{0, -1, -1}));
  EXPECT_EQ(file.corners[3], (ObjCorner{0, 0, -1}));
  EXPECT_EQ(file.corners[6], (ObjCorner{0, -1, 0}));
  EXPECT_EQ(file.corners[9], (ObjCorner{0, 0, 0}));
}

TEST(ReadObj, FacesMayHaveAnyNumberOfCorners) {
  const ObjFile file = must_read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 1 2 3\nf 1 2 3 4 5\n");
  EXPECT_THAT(file.faces, ElementsAre(ObjFace{0, 4, 6}, ObjFace{4, 3, 7}, ObjFace{7, 5, 8}));
}

TEST(ReadObj, NegativeIndicesCountBackFromTheFace) {
  const ObjFile file = must_read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf -3//-1 -2//-1 -1//-1\nv 9 9 9\nf -1//1 -3//1 -2//1\n");
  EXPECT_THAT(file.corners, ElementsAre(ObjCorner{0, -1, 0}, ObjCorner{1, -1, 0}, ObjCorner{2, -1, 0}, ObjCorner{3, -1, 0},
                                        ObjCorner{1, -1, 0}, ObjCorner{2, -1, 0}));
}

TEST(ReadObj, IndicesMayPointForwards) {
  const ObjFile file = must_read("f 1/1 2/1 3/1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n");
  EXPECT_EQ(file.corners.back(), (ObjCorner{2, 0, -1}));
}

TEST(ReadObj, LineEndsCommentsAndBlanksDoNotMatter) {
  const ObjFile plain = must_read(kTriangle);
  for (const auto text :
       {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n"sv, "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r"sv,
        "\tv\t0 0\t0 # one\n  v 1 0 0#two\nv 0 1 0   \nf 1 2 3"sv, "\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"sv,
        "v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n2 \\\n3\n"sv}) {
    const ObjFile file = must_read(text);
    EXPECT_EQ(file.positions, plain.positions) << text;
    EXPECT_EQ(file.corners, plain.corners) << text;
  }
}

TEST(ReadObj, TakesWhatFollowsTheCoordinates) {
  const ObjFile file =
      must_read("v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 0.5 0.5 0.5\nvt 0.5\nvt 0.5 0.25 0\nf 1/1 2/2 3/1\n");
  EXPECT_THAT(file.positions, ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
  EXPECT_THAT(file.texcoords, ElementsAre(0.5F, 0, 0.5F, 0.25F));
}

TEST(ReadObj, SkipsWhatAPolygonMeshHasNoUseFor) {
  const std::string text =
      "o a\ng a b\ns 1\nmg 1 0.5\nusemtl m\nmtllib a b\nl 1 2 \\\n3\np 1\nvp 0 1\ncstype bezier\ndeg 3\nsurf 0 1\nend\nlod 1\n";
  EXPECT_EQ(must_read(text + std::string(kTriangle)).faces.size(), 1U);
}

TEST(ReadObj, FacesKeepTheMaterialInUse) {
  const ObjFile file = must_read(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl Material #25 \nf 1 2 3\nusemtl a\nusemtl b\nf 1 2 3\ng x\nf 1 2 3\n"
      "usemtl Material #25\nf 1 2 3\nusemtl\nf 1 2 3\n");
  EXPECT_THAT(file.material_names, ElementsAre("Material #25", "a", "b"));
  std::vector<std::int32_t> materials;
  for (const ObjFace& face : file.faces) materials.push_back(face.material);
  EXPECT_THAT(materials, ElementsAre(kNoMaterial, 0, 2, 2, 0, kNoMaterial));
}

TEST(ReadObj, KeepsEachLibraryStatementOnce) {
  const ObjFile file = must_read("mtllib a b.mtl\nmtllib\nmtllib c.mtl d.mtl\nmtllib a b.mtl\n" + std::string(kTriangle));
  EXPECT_THAT(file.material_libraries, ElementsAre("a b.mtl", "c.mtl d.mtl"));
  EXPECT_TRUE(must_read(kTriangle).material_libraries.empty());
}

TEST(ReadObj, LibrariesAreLimited) {
  std::string text;
  for (int i = 0; i < 256; ++i) text += "mtllib " + std::to_string(i) + "\n";
  EXPECT_EQ(must_read(text + std::string(kTriangle)).material_libraries.size(), 256U);
  const auto over = read_obj(text + "mtllib more\n" + std::string(kTriangle), "a.obj", Limits{});
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, ErrorCode::Limit);
  EXPECT_EQ(over.error().message, "a.obj:257: expected at most 256 material libraries, found more");
}

TEST(ReadObj, RefusesNumbersThatAreNotWhollyFiniteNumbers) {
  for (const auto bad : {"abc"sv, "nan"sv, "inf"sv, "1e999"sv, "0x10"sv, "1,5"sv, "1.0.0"sv, "--1"sv}) {
    const std::string number(bad);
    const std::string expected = "a/b.obj:5: expected a finite number, found \"" + number + "\"";
    EXPECT_EQ(error_of(std::string(kHead) + "v 0 " + number + " 0\n"), expected);
    EXPECT_EQ(error_of(std::string(kHead) + "vn 0 0 " + number + "\n"), expected);
    EXPECT_EQ(error_of(std::string(kHead) + "vt " + number + " 0\n"), expected);
    EXPECT_EQ(error_of(std::string(kHead) + "v 0 0 0 " + number + "\n"), expected);
  }
}

TEST(ReadObj, RefusesTooFewOrTooManyNumbers) {
  EXPECT_EQ(error_of("\n\nv 0 0\n"), "a/b.obj:3: expected 3 to 7 numbers, found 2");
  EXPECT_EQ(error_of("v\n"), "a/b.obj:1: expected 3 to 7 numbers, found 0");
  EXPECT_EQ(error_of("v 1 2 3 4 5 6 7 8\n"), "a/b.obj:1: expected 3 to 7 numbers, found more");
  EXPECT_EQ(error_of("vn 0 1\n"), "a/b.obj:1: expected 3 numbers, found 2");
  EXPECT_EQ(error_of("vn 0 1 0 0\n"), "a/b.obj:1: expected 3 numbers, found more");
  EXPECT_EQ(error_of("vt\n"), "a/b.obj:1: expected 1 to 3 numbers, found 0");
  EXPECT_EQ(error_of("vt 1 2 3 4\n"), "a/b.obj:1: expected 1 to 3 numbers, found more");
}

TEST(ReadObj, RefusesIndicesOutsideOfTheirLists) {
  const std::string head = std::string(kHead) + "# 5\r\n";
  EXPECT_EQ(error_of(head + "f 1 2 4\n"), "a/b.obj:6: expected the index of one of the file's 3 vertices, found 4");
  EXPECT_EQ(error_of(head + "f 1/1 2/1 3/2\n"),
            "a/b.obj:6: expected the index of one of the file's 1 texture coordinates, found 2");
  EXPECT_EQ(error_of(head + "f 1//1 2//1 3//1\n"), "a/b.obj:6: expected the index of one of the file's 0 normals, found 1");
  EXPECT_EQ(error_of(head + "f 1 2 -4\n"), "a/b.obj:6: expected one of the 3 vertices so far, found \"-4\"");
  EXPECT_EQ(error_of(head + "f 1 2 99999999999\n"),
            "a/b.obj:6: expected the index of one of the file's 3 vertices, found \"99999999999\"");
  for (const auto bad : {"0"sv, "-0"sv, "+1"sv, "1.0"sv, "x"sv, "99999999999999999999"sv}) {
    EXPECT_EQ(error_of(head + "f 1 2 " + std::string(bad) + "\n"),
              "a/b.obj:6: expected an index from 1, or from -1 down, found \"" + std::string(bad) + "\"");
  }
}

TEST(ReadObj, RefusesMalformedCorners) {
  for (const auto bad : {"3/"sv, "3//"sv, "3/1/"sv, "/1"sv, "//1"sv, "/"sv, "3/1/1/1"sv, "3///1"sv}) {
    EXPECT_EQ(error_of(std::string(kHead) + "f 1 2 " + std::string(bad) + "\n"),
              "a/b.obj:5: expected a corner v, v/vt, v//vn or v/vt/vn, found \"" + std::string(bad) + "\"");
  }
}

TEST(ReadObj, RefusesFacesWhoseCornersDiffer) {
  EXPECT_EQ(error_of(std::string(kHead) + "f 1 2/1 3\n"),
            "a/b.obj:5: expected all corners of the face to have the same parts of v/vt/vn, found \"2/1\"");
  EXPECT_EQ(error_of(std::string(kHead) + "vn 0 0 1\nf 1//1 2/1/1 3//1\n"),
            "a/b.obj:6: expected all corners of the face to have the same parts of v/vt/vn, found \"2/1/1\"");
}

TEST(ReadObj, RefusesFacesOfLessThanThreeCorners) {
  EXPECT_EQ(error_of(std::string(kHead) + "f 1 2\n"), "a/b.obj:5: expected a face of at least 3 corners, found 2");
  EXPECT_EQ(error_of(std::string(kHead) + "f\n"), "a/b.obj:5: expected a face of at least 3 corners, found 0");
}

TEST(ReadObj, RefusesStatementsObjDoesNotHave) {
  EXPECT_THAT(error_of(std::string(kHead) + "face 1 2 3\n"), StartsWith("a/b.obj:5: expected an OBJ statement"));
  EXPECT_THAT(error_of("V 0 0 0\n"), testing::EndsWith("found \"V\""));
  EXPECT_THAT(error_of("<html>\n"), testing::EndsWith("found \"<html>\""));
}

TEST(ReadObj, RefusesBinaryNoise) {
  EXPECT_EQ(error_of("v 0 0 0\nv 1 \0 0\n"sv), "a/b.obj:2: expected text, found a NUL byte: this is a binary file");
  EXPECT_THAT(error_of("\x89PNG\r\n"), testing::EndsWith("found \"\\x89PNG\""));
}

TEST(ReadObj, RefusesFilesWithoutAMesh) {
  EXPECT_EQ(error_of(""), "a/b.obj: expected at least one vertex (v x y z), found none");
  EXPECT_EQ(error_of("# nothing\n"), "a/b.obj: expected at least one vertex (v x y z), found none");
  EXPECT_EQ(error_of(kHead), "a/b.obj: expected at least one face (f a b c), found none");
}

TEST(ReadObj, VerticesAreLimited) {
  Limits limits;
  limits.vertices_per_actor = 3;
  EXPECT_TRUE(read_obj(kTriangle, "a.obj", limits));
  limits.vertices_per_actor = 2;
  const auto over = read_obj(kTriangle, "a.obj", limits);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, ErrorCode::Limit);
  EXPECT_EQ(over.error().message, "a.obj:3: expected at most 2 vertices, found more");
}

TEST(ReadObj, EveryTruncationIsReadOrRefusedButNeverMore) {
  const std::string text =
      "\xEF\xBB\xBF# c\r\nv 0 0 0\nv 1.5e0 -0 0 \\\n 1\nv 0 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/1/1 \\\r\n 3/1/1\nf -3//-1 -2//-1 "
      "-1//-1\n";
  ASSERT_TRUE(read_obj(text, "a.obj", Limits{}));
  for (std::size_t bytes = 0; bytes < text.size(); ++bytes) {
    const std::string cut = text.substr(0, bytes);  // an allocation of its own: reading past it is caught by the sanitizer
    const auto file = read_obj(cut, "a.obj", Limits{});
    if (file) {
      EXPECT_FALSE(file->faces.empty());
    } else {
      EXPECT_THAT(file.error().message, StartsWith("a.obj"));
    }
  }
}

TEST(ReadObj, EveryChangedByteIsReadOrRefused) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf -3 -2 -1\n";
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const char c : {'\0', '\n', '\r', ' ', '\\', '#', '/', '-', '9', 'e', '\xFF'}) {
      std::string changed = text;
      changed[i] = c;
      const auto file = read_obj(changed, "a.obj", Limits{});
      if (file) continue;
      EXPECT_THAT(file.error().message, StartsWith("a.obj:"));
    }
  }
}

}  // namespace
}  // namespace tweend::assets
