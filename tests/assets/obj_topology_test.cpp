#include "server/assets/obj_topology.hpp"

#include <gtest/gtest.h>

#include "tests/assets/sample_objs.hpp"

namespace tweend::assets {
namespace {

constexpr std::string_view kTwoFaces = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

std::string mismatch(std::string_view first, std::string_view other) {
  const Status same = check_same_topology(must_read(first, "s/s_000000.obj"), must_read(other, "s/s_000010.obj"));
  if (same) return "";
  EXPECT_EQ(same.error().code, ErrorCode::BadAsset);
  return same.error().message;
}

TEST(ObjTopology, OtherPositionsTexcoordsAndNormalsAreTheSameMesh) {
  EXPECT_EQ(mismatch(kTriangle, kTriangle), "");
  EXPECT_EQ(mismatch(kTriangle, "v 9 9 9\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\nf 1/1/1 2/1/1 3/1/1\n"), "");
}

TEST(ObjTopology, NamesBothVertexCounts) {
  EXPECT_EQ(mismatch(kTriangle, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"),
            "s/s_000010.obj: expected 3 vertices as in s/s_000000.obj, found 4");
}

TEST(ObjTopology, NamesBothFaceCountsAndTheLastLine) {
  EXPECT_EQ(mismatch(kTwoFaces, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\nf 1 2 3\n"),
            "s/s_000010.obj: expected 2 faces as in s/s_000000.obj, found 1 (last face at line 6)");
}

TEST(ObjTopology, NamesBothLinesOfAFaceThatDiffers) {
  EXPECT_EQ(mismatch(kTwoFaces, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n# moved down\nf 1 2 4\n"),
            "s/s_000010.obj:7: expected vertex 3 at corner 2 of the face as in s/s_000000.obj:6, found vertex 2");
  EXPECT_EQ(mismatch(kTwoFaces, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 3 4\n"),
            "s/s_000010.obj:5: expected a face of 3 corners as in s/s_000000.obj:5, found 4");
}

}  // namespace
}  // namespace tweend::assets
