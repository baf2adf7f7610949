#include "server/assets/mtl_reader.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/assets/must.hpp"

using namespace std::literals;
using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

namespace tweend::assets {
namespace {

using Materials = std::vector<MtlMaterial>;

Materials must_read_mtl(std::string_view text) { return must(read_mtl(text, "test.mtl")); }

std::string error_of(std::string_view text) {
  const auto materials = read_mtl(text, "a/b.mtl");
  if (materials) return "no error";
  EXPECT_EQ(materials.error().code, ErrorCode::BadAsset);
  return materials.error().message;
}

/// What a map_Kd statement's rest names.
std::string map_of(std::string_view rest) { return must_read_mtl(fmt::format("newmtl m\nmap_Kd {}\n", rest))[0].diffuse_map; }

TEST(ReadMtl, ReadsColoursAndTextures) {
  EXPECT_THAT(
      must_read_mtl("# Blender\nnewmtl red\nNs 96\nKa 1 1 1\nKd 0.8 .1 1e-1\nillum 2\n\nnewmtl wood\nmap_Kd wood.png\n"),
      ElementsAre(MtlMaterial{"red", glm::vec3(0.8F, 0.1F, 0.1F), ""}, MtlMaterial{"wood", std::nullopt, "wood.png"}));
}

TEST(ReadMtl, AFileWithoutMaterialsHasNone) {
  for (const char* text : {"", "\n", "# Material Count: 0\n", "Ns 10\n"}) EXPECT_TRUE(must_read_mtl(text).empty()) << text;
}

TEST(ReadMtl, NamesAreTheRestOfTheirLine) {
  EXPECT_THAT(must_read_mtl("newmtl  Material #25 \r\nnewmtl \xC3\xA9t\xC3\xA9\n"),
              ElementsAre(MtlMaterial{"Material #25", {}, ""}, MtlMaterial{"\xC3\xA9t\xC3\xA9", {}, ""}));
}

TEST(ReadMtl, KeywordsMayBeOfAnyCase) {
  EXPECT_THAT(must_read_mtl("NewMtl m\nkd 1 0 0\nMAP_KD a.png\nKS 0 0 0\nBump x\n"),
              ElementsAre(MtlMaterial{"m", glm::vec3(1, 0, 0), "a.png"}));
}

TEST(ReadMtl, OneNumberIsGreyAndAnyNumberIsKept) {
  EXPECT_EQ(must_read_mtl("newmtl m\nKd 0.5\n")[0].diffuse, glm::vec3(0.5F));
  EXPECT_EQ(must_read_mtl("newmtl m\nKd -1 2 255 # bytes\n")[0].diffuse, glm::vec3(-1, 2, 255));
}

TEST(ReadMtl, TheLaterOfTwoWins) {
  EXPECT_THAT(must_read_mtl("newmtl a\nKd 1\nmap_Kd a.png\nnewmtl b\nnewmtl a\nKd 0.5\nKd 0.25\n"),
              ElementsAre(MtlMaterial{"a", glm::vec3(0.25F), ""}, MtlMaterial{"b", {}, ""}))
      << "nothing of the replaced material stays";
}

TEST(ReadMtl, SkipsWhatIsNotShown) {
  std::string text = "newmtl m\n";
  for (const auto skipped : {"Ka 0 0 0",
                             "Ks spectral file.rfl",
                             "Ke 0 0 0",
                             "Ns 10",
                             "Ni 1.45",
                             "d -halo 0.5",
                             "Tr 0",
                             "Tf 1 1 1",
                             "illum 2",
                             "sharpness 60",
                             "map_Ka a.png",
                             "map_Bump -bm 0.5 b.png",
                             "map_aat on",
                             "bump b.png",
                             "disp d.png",
                             "decal d.png",
                             "refl -type sphere r.png",
                             "norm n.png",
                             "Pr 0.5",
                             "Pm 0",
                             "Ps 0",
                             "Pc 0",
                             "Pcr 0",
                             "aniso 0",
                             "anisor 0"}) {
    text += skipped;
    text += "\n";
  }
  EXPECT_THAT(must_read_mtl(text), ElementsAre(MtlMaterial{"m", {}, ""}));
}

TEST(ReadMtl, FileNamesMayHoldBlanksAndBackslashes) {
  EXPECT_EQ(map_of("my wood  texture.png \t"), "my wood  texture.png");
  EXPECT_EQ(map_of("..\\textures\\wood.png"), "../textures/wood.png");
  EXPECT_EQ(map_of("C:\\\\tex\\a.png"), "C://tex/a.png");
  EXPECT_EQ(map_of("a#1.png"), "a#1.png");
  EXPECT_EQ(map_of("-minus.png"), "-minus.png") << "no option of MTL's";
}

TEST(ReadMtl, OptionsOfTexturesAreSkipped) {
  for (const auto options :
       {"-blendu on", "-blendv off", "-boost 1.5", "-mm 0 1", "-o 0", "-o 0 0.5", "-s 1 1 1", "-t -.1 0 0", "-texres 512",
        "-clamp on", "-bm 1", "-imfchan r", "-type sphere", "-cc off", "-s 1 1 1 -o 0 0\t-clamp on"}) {
    EXPECT_EQ(map_of(fmt::format("{} my wood.png", options)), "my wood.png") << options;
  }
  EXPECT_EQ(map_of("-s 1 1 1 1.png"), "1.png");
  EXPECT_EQ(map_of("-s 1 1 7"), "7") << "the last token is the file";
}

TEST(ReadMtl, AMapWithoutAFileSaysNothing) {
  EXPECT_EQ(map_of(""), "");
  EXPECT_EQ(map_of("-clamp on"), "");
}

TEST(ReadMtl, RefusesNumbersThatAreNotWhollyFiniteNumbers) {
  for (const auto bad : {"abc", "nan", "inf", "1e999", "0x10", "1,5", "spectral", "xyz"}) {
    EXPECT_EQ(error_of(fmt::format("newmtl m\nKd 1 {} 0\n", bad)),
              fmt::format("a/b.mtl:2: expected a finite number, found \"{}\"", bad));
  }
}

TEST(ReadMtl, RefusesOtherThanOneOrThreeNumbers) {
  EXPECT_EQ(error_of("newmtl m\nKd\n"), "a/b.mtl:2: expected 1 or 3 numbers, found 0");
  EXPECT_EQ(error_of("newmtl m\nKd 1 0\n"), "a/b.mtl:2: expected 1 or 3 numbers, found 2");
  EXPECT_EQ(error_of("newmtl m\nKd 1 0 0 0\n"), "a/b.mtl:2: expected 1 or 3 numbers, found more");
}

TEST(ReadMtl, RefusesStatementsOutsideOfAMaterial) {
  EXPECT_EQ(error_of("\nKd 1 1 1\n"), "a/b.mtl:2: expected newmtl before any statement about a material, found \"Kd\"");
  EXPECT_EQ(error_of("map_Kd x\n"), "a/b.mtl:1: expected newmtl before any statement about a material, found \"map_Kd\"");
  EXPECT_EQ(error_of("newmtl a\nnewmtl \n"), "a/b.mtl:2: expected a material's name after newmtl, found none");
}

TEST(ReadMtl, RefusesOptionsWithoutTheirArguments) {
  EXPECT_EQ(error_of("newmtl m\nmap_Kd -clamp\n"), "a/b.mtl:2: expected 1 argument(s) of -clamp, found 0");
  EXPECT_EQ(error_of("newmtl m\nmap_Kd -mm 0\n"), "a/b.mtl:2: expected 2 argument(s) of -mm, found 1");
  EXPECT_EQ(error_of("newmtl m\nmap_Kd -s a.png\n"), "a/b.mtl:2: expected a finite number after -s, found \"a.png\"");
}

TEST(ReadMtl, RefusesStatementsMtlDoesNotHave) {
  EXPECT_THAT(error_of("newmtl m\nv 0 0 0\n"), StartsWith("a/b.mtl:2: expected an MTL statement (newmtl, Kd, map_Kd"));
  EXPECT_THAT(error_of("<html>\n"), EndsWith("found \"<html>\""));
  EXPECT_THAT(error_of("\x89PNG\r\n"), EndsWith("found \"\\x89PNG\""));
  EXPECT_EQ(error_of("newmtl a\nKd\0 1\n"sv), "a/b.mtl:2: expected text, found a NUL byte: this is a binary file");
}

TEST(ReadMtl, EveryTruncationAndChangeIsReadOrRefused) {
  const std::string text =
      "\xEF\xBB\xBF# c\r\nnewmtl a b\nKd 1 0.5 \\\n 0\nmap_Kd -s 1 1 1 -mm 0 1 -clamp on tex\\a b.png\r\nnewmtl c\rKd 1\n";
  const auto check = [](std::string_view changed) {
    // A block of exactly its size, so that AddressSanitizer sees a read of one byte too many.
    const auto copy = std::make_unique<char[]>(changed.size());
    changed.copy(copy.get(), changed.size());
    const auto materials = read_mtl({copy.get(), changed.size()}, "a.mtl");
    if (!materials) {
      EXPECT_THAT(materials.error().message, StartsWith("a.mtl:"));
      return;
    }
    for (const MtlMaterial& m : *materials) EXPECT_FALSE(m.name.empty());
  };
  ASSERT_EQ(must_read_mtl(text).size(), 2U);
  for (std::size_t i = 0; i < text.size(); ++i) {
    check(text.substr(0, i));
    for (const char c : {'\0', '\n', '\r', ' ', '\\', '#', '-', '9', '\xFF'}) {
      std::string changed = text;
      changed[i] = c;
      check(changed);
    }
  }
}

}  // namespace
}  // namespace tweend::assets
