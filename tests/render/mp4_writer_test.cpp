#include "render/mp4_writer.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "tests/render/support/film.hpp"

namespace tweend::render {
namespace {

using test::Film;

constexpr Size kSize{96, 64};

/// A disk that is full after so many bytes.
struct SmallDisk final : FileSink {
  explicit SmallDisk(std::uint64_t room) : left(room) {}
  Status write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    if (offset + bytes.size() > left) return fail(ErrorCode::Unavailable, "no space left");
    return {};
  }
  std::uint64_t left;
};

Mp4Writer open(const Mp4Options& options, FileSink& file) {
  auto writer = Mp4Writer::open(options, file);
  EXPECT_TRUE(writer) << writer.error().message;
  return std::move(*writer);
}

void add(Mp4Writer& writer, Size size, std::size_t k) {
  std::vector<std::byte> storage;
  const auto added = writer.add(upside_down(test::moving_picture(size, k), storage));
  ASSERT_TRUE(added) << added.error().message;
}

std::string film(const Mp4Options& options, std::size_t pictures) {
  MemoryFile file;
  Mp4Writer writer = open(options, file);
  for (std::size_t k = 0; k < pictures; ++k) add(writer, options.size, k);
  EXPECT_TRUE(writer.finish());
  EXPECT_EQ(writer.pictures(), pictures);
  EXPECT_EQ(writer.bytes(), file.bytes.size());
  return file.bytes;
}

Film read(const std::string& bytes) {
  const std::string path = testing::TempDir() + "tweend_film_" + std::to_string(::getpid()) + ".mp4";
  std::ofstream(path, std::ios::binary) << bytes;
  Film film = test::decode_mp4(path);
  std::remove(path.c_str());
  return film;
}

TEST(Mp4Writer, RefusesWhatTheEncoderRefuses) {
  MemoryFile file;
  EXPECT_FALSE(Mp4Writer::open({.size = {95, 64}}, file));
  for (const double fps : {0.0, -30.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto none = Mp4Writer::open({.size = kSize, .fps = fps}, file);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::InvalidParams);
  }
  EXPECT_TRUE(file.bytes.empty());
}

TEST(Mp4Writer, RefusesRatesItCouldNotKeep) {
  MemoryFile file;
  for (const double fps : {1e9, 1e6 + 1.0, 0.9e-6, 1e-300}) {
    const auto none = Mp4Writer::open({.size = kSize, .fps = fps}, file);
    ASSERT_FALSE(none) << fps;
    EXPECT_EQ(none.error().code, ErrorCode::InvalidParams);
  }
  for (const double fps : {1e6, 1e-6}) EXPECT_TRUE(Mp4Writer::open({.size = kSize, .fps = fps}, file)) << fps;
}

TEST(Mp4Writer, RefusesMorePicturesThanItsIndexCanForetell) {
  MemoryFile file;
  // Of 24 bytes each, behind 4 KiB.
  const std::size_t most = (2'147'483'647 - 4'096) / 24;
  const auto none = Mp4Writer::open({.size = kSize, .pictures = most + 1}, file);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::Limit);
  EXPECT_EQ(Mp4Writer::kMostPictures, most);
}

TEST(Mp4Writer, RefusesAFilmWithoutPictures) {
  MemoryFile file;
  Mp4Writer writer = open({.size = kSize}, file);
  const auto finished = writer.finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().code, ErrorCode::InvalidParams);
}

TEST(Mp4Writer, ShowsEachPictureAtItsExactTime) {
  struct Rate {
    double fps;
    std::int64_t num, den;
  };
  for (const Rate& rate : {Rate{30.0, 30, 1},
                           {29.97, 2997, 100},
                           {30'000.0 / 1'001.0, 30'000, 1'001},
                           {12.5, 25, 2},
                           {0.5, 1, 2},
                           {240.0, 240, 1}}) {
    const Film found = read(film({.size = kSize, .fps = rate.fps}, 20));
    EXPECT_TRUE(found.complaints.empty()) << found.complaints.front();
    ASSERT_EQ(found.pictures.size(), 20U);
    const auto units_a_second = static_cast<std::int64_t>(std::llround(1.0 / found.time_base_s));
    for (std::int64_t k = 0; k < 20; ++k) {
      // In whole numbers: at / units == k · den / num.
      EXPECT_EQ(found.pictures[static_cast<std::size_t>(k)].at * rate.num, k * rate.den * units_a_second) << rate.fps;
    }
    EXPECT_NEAR(found.duration_s, 20.0 / rate.fps, 1e-9);
  }
}

TEST(Mp4Writer, KeepsWhatThePicturesShow) {
  const Film found = read(film({.size = kSize}, 30));
  ASSERT_EQ(found.pictures.size(), 30U);
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_GT(test::psnr_db(found.pictures[k].image, test::moving_picture(kSize, k)), 32.0) << k;
  }
}

TEST(Mp4Writer, HasAKeyEveryTwoSecondsToSeekTo) {
  const Film found = read(film({.size = kSize, .fps = 10.0}, 45));
  ASSERT_EQ(found.pictures.size(), 45U);
  for (std::size_t k = 0; k < 45; ++k) EXPECT_EQ(found.pictures[k].key, k % 20 == 0) << k;
}

TEST(Mp4Writer, PutsTheIndexFirstWhereTheNumberOfPicturesIsKnown) {
  const std::string known = film({.size = kSize, .pictures = 300}, 300);
  EXPECT_LT(known.find("moov"), known.find("mdat"));
  EXPECT_EQ(read(known).pictures.size(), 300U);
  const std::string unknown = film({.size = kSize}, 30);
  EXPECT_GT(unknown.find("moov"), unknown.find("mdat"));
}

TEST(Mp4Writer, FewerPicturesThanForetoldAreAFilmToo) {
  const Film found = read(film({.size = kSize, .pictures = 10'000}, 3));
  EXPECT_TRUE(found.complaints.empty()) << found.complaints.front();
  EXPECT_EQ(found.pictures.size(), 3U);
}

TEST(Mp4Writer, TheSamePicturesMakeTheSameFile) { EXPECT_EQ(film({.size = kSize}, 10), film({.size = kSize}, 10)); }

TEST(Mp4Writer, SaysWhatTheDiskSaid) {
  for (const std::uint64_t room : {0U, 100U, 70'000U}) {
    SmallDisk disk(room);
    auto writer = Mp4Writer::open({.size = {640, 360}}, disk);
    Status status = writer ? Status() : writer.error();
    for (std::size_t k = 0; k < 200 && status; ++k) {
      std::vector<std::byte> storage;
      status = writer->add(upside_down(test::moving_picture({640, 360}, k), storage));
    }
    if (status) status = writer->finish();
    ASSERT_FALSE(status) << room;
    EXPECT_EQ(status.error().code, ErrorCode::Unavailable);
    EXPECT_EQ(status.error().message, "no space left");
  }
}

}  // namespace
}  // namespace tweend::render
