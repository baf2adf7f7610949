#include "server/assets/obj_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/assets/sample_objs.hpp"

using testing::ElementsAre;

namespace tweend::assets {
namespace {

using Known = std::vector<std::optional<model::Material>>;
using model::MeshPart;

constexpr std::string_view kVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
constexpr std::string_view kTri = "f 1 2 3\n";
constexpr std::string_view kQuad = "f 1 2 3 4\n";

ObjFile file_of(std::initializer_list<std::string_view> statements) {
  std::string text(kVertices);
  for (const std::string_view statement : statements) text += statement;
  return must_read(text);
}

model::Material material(std::string name) { return {std::move(name), {1, 0, 0}, nullptr}; }

std::vector<std::string> names(const model::Surface& surface) {
  std::vector<std::string> all;
  for (const model::Material& m : surface.materials) all.push_back(m.name);
  return all;
}

TEST(MakeSurface, WithoutAKnownMaterialItIsEmpty) {
  const ObjFile file = file_of({"usemtl a\n", kTri, "usemtl b\n", kQuad});
  for (const Known& known : {Known{}, Known{std::nullopt, std::nullopt}}) {
    EXPECT_TRUE(make_surface(file, known).materials.empty());
    EXPECT_TRUE(make_surface(file, known).parts.empty());
  }
  EXPECT_TRUE(make_surface(file_of({kTri, "usemtl a\n"}), Known{material("a")}).parts.empty()) << "known, but never shown";
}

TEST(MakeSurface, PartsAreTheLongestRunsOfOneMaterial) {
  const ObjFile file =
      file_of({"usemtl b\n", kTri, kQuad, "usemtl a\n", "usemtl b\n", kTri, "usemtl a\n", kQuad, "usemtl b\n", kTri});
  const model::Surface surface = make_surface(file, Known{material("b"), material("a")});
  EXPECT_THAT(names(surface), ElementsAre("b", "a"));
  EXPECT_THAT(surface.parts, ElementsAre(MeshPart{0, 12, 0}, MeshPart{12, 6, 1}, MeshPart{18, 3, 0}));
}

TEST(MakeSurface, FacesOfUnknownMaterialsShareTheDefaultOne) {
  const ObjFile file = file_of({kTri, "usemtl gone\n", kTri, "usemtl a\n", kTri, "usemtl\n", kTri});
  const model::Surface surface = make_surface(file, Known{std::nullopt, material("a")});
  EXPECT_THAT(names(surface), ElementsAre("", "a"));
  EXPECT_EQ(surface.materials[0].base_color, model::kDefaultBaseColor);
  EXPECT_THAT(surface.parts, ElementsAre(MeshPart{0, 6, 0}, MeshPart{6, 3, 1}, MeshPart{9, 3, 0}));
}

TEST(MakeSurface, MaterialsThatNoFaceShowsAreLeftOut) {
  const ObjFile file = file_of({"usemtl a\n", "usemtl b\n", kTri});
  EXPECT_THAT(names(make_surface(file, Known{material("a"), material("b")})), ElementsAre("b"));
}

TEST(HasTexcoords, OneCornerIsEnough) {
  EXPECT_FALSE(has_texcoords(file_of({"vt 0 0\n", kTri})));
  EXPECT_TRUE(has_texcoords(file_of({"vt 0 0\n", kTri, "f 1/1 2/1 3/1\n"})));
}

}  // namespace
}  // namespace tweend::assets
