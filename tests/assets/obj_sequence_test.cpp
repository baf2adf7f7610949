#include "server/assets/obj_sequence.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "tests/assets/must.hpp"
#include "tests/assets/sample_objs.hpp"

using testing::ElementsAre;
using testing::FloatNear;

namespace tweend::assets {
namespace {

/// Frames 0, 10, 20 ... of files called s_000000.obj and so on.
Result<ObjModel> build(const std::vector<std::string>& texts, const Limits& limits = {}) {
  std::vector<ObjFile> files;
  std::vector<std::int64_t> frames;
  for (const std::string& text : texts) {
    frames.push_back(static_cast<std::int64_t>(10 * files.size()));
    files.push_back(must_read(text, fmt::format("s_{}.obj", frames.back())));
  }
  return build_obj_model("s", files, frames, limits);
}

ObjModel must_build(const std::vector<std::string>& texts) { return must(build(texts)); }

std::vector<float> row(std::span<const float> rows, std::size_t index, std::size_t width = 3) {
  const auto part = rows.subspan(width * index, width);
  return {part.begin(), part.end()};
}

/// A closed pyramid whose every face has its own normal: exporters write flat shading like this.
constexpr std::string_view kPyramid = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n";

TEST(BuildObjModel, OneFileIsOneKey) {
  const ObjModel model = must_build({std::string(kTriangle)});
  EXPECT_EQ(model.source, "s");
  EXPECT_EQ(model.mesh->vertex_count(), 3U);
  EXPECT_THAT(model.mesh->indices(), ElementsAre(0, 1, 2));
  EXPECT_TRUE(model.mesh->texcoords().empty());
  ASSERT_EQ(model.keys.size(), 1U);
  EXPECT_EQ(model.keys[0].frame, 0.0);
  EXPECT_THAT(model.keys[0].vertices->positions(), ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
  EXPECT_THAT(model.keys[0].vertices->normals(), ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1));
}

TEST(BuildObjModel, FramesMayBeUneven) {
  const std::array files{must_read(kTriangle, "a"), must_read(triangle_to("0 2 0"), "b"), must_read(triangle_to("0 3 0"), "c")};
  const std::array<std::int64_t, 3> frames{-5, 7, 8};
  const ObjModel model = must(build_obj_model("s", files, frames, Limits{}));
  ASSERT_EQ(model.keys.size(), 3U);
  EXPECT_EQ(model.keys[0].frame, -5.0);
  EXPECT_EQ(model.keys[1].frame, 7.0);
  EXPECT_EQ(model.keys[2].frame, 8.0);
  EXPECT_EQ(row(model.keys[2].vertices->positions(), 2), (std::vector<float>{0, 3, 0}));
}

TEST(BuildObjModel, VerticesAreNumberedInOrderOfFirstUse) {
  const ObjModel model = must_build({"v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 5 3 2\nf 2 3 4\n"});
  EXPECT_THAT(model.mesh->indices(), ElementsAre(0, 1, 2, 2, 1, 3));
  EXPECT_THAT(model.keys[0].vertices->positions(), ElementsAre(0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 1, 0)) << "an unused v is dropped";
}

TEST(BuildObjModel, PolygonsAreFannedFromTheirFirstCorner) {
  const ObjModel model = must_build({std::string(kPyramid) + "f 1 2 3 4\nf 1 2 5\nf 5 4 3 2 1\n"});
  EXPECT_THAT(model.mesh->indices(), ElementsAre(0, 1, 2, 0, 2, 3, 0, 1, 4, 4, 3, 2, 4, 2, 1, 4, 1, 0));
}

// Frame 0 numbers its normals 1 2, frame 10 the other way round, frame 20 shares one between both faces:
// the corners of v 1 and v 3 are two vertices each, because two frames tell them apart.
TEST(BuildObjModel, NormalsMayBeNumberedAfreshInEachFrame) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const ObjModel model = must_build({head + "vn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n",
                                     head + "vn 0 1 0\nvn 0 0 -1\nf 1//2 2//2 3//2\nf 1//1 3//1 4//1\n",
                                     head + "vn 0 -1 0\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n"});
  ASSERT_EQ(model.mesh->vertex_count(), 6U);
  EXPECT_THAT(model.mesh->indices(), ElementsAre(0, 1, 2, 3, 4, 5));
  const auto normal = [&](std::size_t key, std::size_t vertex) { return row(model.keys[key].vertices->normals(), vertex); };
  for (const std::size_t vertex : {0U, 1U, 2U}) {
    EXPECT_EQ(normal(0, vertex), (std::vector<float>{0, 0, 1}));
    EXPECT_EQ(normal(1, vertex), (std::vector<float>{0, 0, -1}));
    EXPECT_EQ(normal(2, vertex), (std::vector<float>{0, -1, 0}));
  }
  for (const std::size_t vertex : {3U, 4U, 5U}) {
    EXPECT_EQ(normal(0, vertex), (std::vector<float>{1, 0, 0}));
    EXPECT_EQ(normal(1, vertex), (std::vector<float>{0, 1, 0}));
    EXPECT_EQ(normal(2, vertex), (std::vector<float>{0, -1, 0}));
  }
}

TEST(BuildObjModel, EveryCornerKeepsItsOwnAttributesInEveryFrame) {
  // Renumbered, shared and split at random; what comes out must be, corner for corner, what went in.
  const char* const faces[] = {"f 1//{} 2//{} 3//{}\n", "f 1//{} 3//{} 4//{}\n", "f 1//{} 2//{} 5//{}\n",
                               "f 2//{} 3//{} 5//{}\n"};
  unsigned seed = 1;
  std::vector<std::string> texts;
  for (int frame = 0; frame < 6; ++frame) {
    std::string text(kPyramid);
    for (int n = 1; n <= 4; ++n) text += fmt::format("vn {} {} 1\n", n, frame);
    const auto any = [&] {
      seed = seed * 1664525U + 1013904223U;
      return 1 + (seed >> 24U) % 4;
    };
    for (const char* corners : faces) text += fmt::format(fmt::runtime(corners), any(), any(), any());
    texts.push_back(text);
  }
  const ObjModel model = must_build(texts);
  for (std::size_t frame = 0; frame < texts.size(); ++frame) {
    const ObjFile file = must_read(texts[frame]);
    for (std::size_t i = 0; i < file.corners.size(); ++i) {  // all faces are triangles: corners and indices run alike
      const std::uint32_t vertex = model.mesh->indices()[i];
      const auto v = static_cast<std::size_t>(file.corners[i].v);
      const auto vn = static_cast<std::size_t>(file.corners[i].vn);
      ASSERT_EQ(row(model.keys[frame].vertices->positions(), vertex), row(file.positions, v));
      const std::vector<float> given = row(file.normals, vn);
      const float length = std::sqrt(std::inner_product(given.begin(), given.end(), given.begin(), 0.0F));
      const std::vector<float> normal = row(model.keys[frame].vertices->normals(), vertex);
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(normal[k], given[k] / length, 1e-6F);
    }
  }
}

TEST(BuildObjModel, TexcoordsComeFromTheFirstFile) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const ObjModel model = must_build({head + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\nf 1/1 2/2 3/3\nf 1/5 3/3 4/4\n",
                                     head + "vt 0.25 0.25\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n", head + "f 1 2 3\nf 1 3 4\n"});
  EXPECT_THAT(model.mesh->indices(), ElementsAre(0, 1, 2, 3, 2, 4)) << "v 1 is split by its two texture coordinates";
  EXPECT_THAT(model.mesh->texcoords(), ElementsAre(0, 0, 1, 0, 1, 1, 0.5F, 0.5F, 0, 1));
}

TEST(BuildObjModel, CornersWithoutTexcoordsAmongOthersHaveZero) {
  const ObjModel model = must_build({"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.5 0.5\nf 1/1 2/1 3/1\nf 1 3 4\n"});
  EXPECT_THAT(model.mesh->texcoords(), ElementsAre(0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 0, 0, 0, 0, 0, 0));
}

TEST(BuildObjModel, ComputedNormalsDoNotShowTheSeamsOfTexcoords) {
  // A ridge along v 1 and v 3, whose sides face up-left and up-right; the texture is cut along the ridge.
  const std::string head = "v 0 0 1\nv -1 0 0\nv 0 1 1\nv 1 0 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0\nvt 0.5 1\n";
  const ObjModel model = must_build({head + "f 3/1 2/2 1/3\nf 1/4 4/2 3/5\n"});
  ASSERT_EQ(model.mesh->vertex_count(), 6U);
  const auto normals = model.keys[0].vertices->normals();
  const auto ridge = model.mesh->indices();  // corners 0 and 5 are v 3, corners 2 and 3 are v 1
  for (const auto& [a, b] : {std::pair{ridge[0], ridge[5]}, std::pair{ridge[2], ridge[3]}}) {
    EXPECT_NE(a, b);
    EXPECT_EQ(row(normals, a), row(normals, b));
    EXPECT_THAT(row(normals, a), ElementsAre(FloatNear(0, 1e-6F), FloatNear(0, 1e-6F), FloatNear(1, 1e-6F)));
  }
}

TEST(BuildObjModel, NormalsMissingInSomeFilesSplitNothing) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const ObjModel model = must_build(
      {head + "f 1 2 3\nf 1 3 4\n", head + "vn 1 0 0\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n", head + "f 1 2 3\nf 1 3 4\n"});
  EXPECT_EQ(model.mesh->vertex_count(), 4U);
  EXPECT_EQ(row(model.keys[0].vertices->normals(), 0), (std::vector<float>{0, 0, 1}));
  EXPECT_EQ(row(model.keys[1].vertices->normals(), 0), (std::vector<float>{1, 0, 0}));
  EXPECT_EQ(row(model.keys[2].vertices->normals(), 0), (std::vector<float>{0, 0, 1}));
}

TEST(BuildObjModel, ZeroNormalsAreComputedAndOthersMadeUnit) {
  const ObjModel model = must_build({"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn 0 5 0\nf 1//1 2//2 3//1\n"});
  EXPECT_THAT(model.keys[0].vertices->normals(), ElementsAre(0, 0, 1, 0, 1, 0, 0, 0, 1));
}

TEST(BuildObjModel, RefusesFilesThatShowAnotherMesh) {
  const auto model = build({std::string(kTriangle), triangle_to("0 2 0"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n"});
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::BadAsset);
  EXPECT_EQ(model.error().message, "s_20.obj:4: expected vertex 2 at corner 2 of the face as in s_0.obj:4, found vertex 3");
}

TEST(BuildObjModel, VerticesAreLimitedAfterTheyWereSplit) {
  Limits limits;
  const std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n";
  limits.vertices_per_actor = 6;
  EXPECT_TRUE(build({text}, limits));
  limits.vertices_per_actor = 5;
  const auto over = build({text}, limits);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, ErrorCode::Limit);
  EXPECT_THAT(over.error().message, testing::HasSubstr("at most 5 vertices, found 6"));
}

TEST(BuildObjModel, KeyframesAreLimited) {
  Limits limits;
  limits.keyframes_per_clip = 1;
  const auto over = build({std::string(kTriangle), std::string(kTriangle)}, limits);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, ErrorCode::Limit);
}

TEST(BuildObjModel, RefusesFramesThatDoNotFitTheFiles) {
  const std::array files{must_read(kTriangle), must_read(kTriangle)};
  const auto code = [&](std::vector<std::int64_t> frames) {
    const auto model = build_obj_model("s", files, frames, Limits{});
    return model ? std::optional<ErrorCode>() : model.error().code;
  };
  EXPECT_EQ(code({0, 1}), std::nullopt);
  EXPECT_EQ(code({0}), ErrorCode::Internal);
  EXPECT_EQ(code({1, 1}), ErrorCode::Internal);
  EXPECT_EQ(code({1, 0}), ErrorCode::Internal);
  EXPECT_FALSE(build_obj_model("s", {}, {}, Limits{}));
}

TEST(BuildObjModel, MaterialsAreThoseOfTheFirstFile) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const std::array files{must_read(head + "usemtl a\nf 1 2 3 4\nusemtl b\nf 1 2 3\n", "1"),
                         must_read(head + "usemtl c\nf 1 2 3 4\nf 1 2 3\n", "2")};
  const std::array<std::int64_t, 2> frames{0, 1};
  const std::array<std::optional<model::Material>, 2> materials{model::Material{"a", {1, 0, 0}, nullptr}, std::nullopt};
  const ObjModel model = must(build_obj_model("s", files, frames, Limits{}, materials));
  const model::Surface& surface = model.mesh->surface();
  ASSERT_EQ(surface.materials.size(), 2U);
  EXPECT_EQ(surface.materials[0].name, "a");
  EXPECT_EQ(surface.materials[1].name, "") << "b is not known";
  EXPECT_THAT(surface.parts, ElementsAre(model::MeshPart{0, 6, 0}, model::MeshPart{6, 3, 1}));
  EXPECT_TRUE(must(build_obj_model("s", files, frames, Limits{})).mesh->surface().parts.empty());
}

TEST(BuildObjModel, TheSameFilesMakeTheSameContent) {
  const ObjModel a = must_build({std::string(kTriangle), triangle_to("0 2 0")});
  const ObjModel b = must_build({std::string(kTriangle), triangle_to("0 2 0")});
  EXPECT_EQ(a.mesh->hash(), b.mesh->hash());
  EXPECT_EQ(a.keys[1].vertices->hash(), b.keys[1].vertices->hash());
  EXPECT_NE(a.keys[0].vertices->hash(), a.keys[1].vertices->hash());
}

TEST(ParseSequenceName, TakesPrefixAndNumberApart) {
  EXPECT_EQ(parse_sequence_name("skeletal_000010.obj"), (SequenceMember{"skeletal", 10}));
  EXPECT_EQ(parse_sequence_name("a_b_1.OBJ"), (SequenceMember{"a_b", 1}));
  EXPECT_EQ(parse_sequence_name("a_9007199254740992.obj"), (SequenceMember{"a", 9007199254740992}));
  EXPECT_EQ(parse_sequence_name("__0.obj"), (SequenceMember{"_", 0}));
}

TEST(ParseSequenceName, OtherNamesAreNoMembers) {
  for (const char* name : {"", ".obj", "a.obj", "a_.obj", "_1.obj", "a_1", "a_1.mtl", "a_x1.obj", "a_1x.obj", "a_-1.obj",
                           "a_1.0.obj", "a1.obj", "a_9007199254740993.obj", "a_99999999999999999999.obj", "a_1.obj.bak"}) {
    EXPECT_EQ(parse_sequence_name(name), std::nullopt) << name;
  }
}

}  // namespace
}  // namespace tweend::assets
