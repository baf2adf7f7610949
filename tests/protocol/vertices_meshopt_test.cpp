#include "protocol/vertices_meshopt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/protocol/codec_inputs.hpp"
#include "tests/protocol/vertex_errors.hpp"
#include "tests/support/allocations.hpp"

namespace tweend::protocol {
namespace {

struct Stream {
  struct Sent {
    std::vector<std::byte> payload;
    bool key;
  };
  Sent write(const Vertices& in, bool asked = false) {
    std::vector<std::byte> out(VerticesMeshoptEncoder::most_bytes(in.positions.size() / 3));
    const Encoded encoded = encoder.encode(in.positions, in.normals, asked, out);
    EXPECT_LE(encoded.bytes, out.size());
    out.resize(encoded.bytes);
    if (encoded.key) extent = extent_of(out);
    return {out, encoded.key};
  }
  Vertices read(const Sent& sent, std::size_t vertices) {
    Vertices out{std::vector<float>(3 * vertices, -7.0F), std::vector<float>(3 * vertices, -7.0F)};
    const Status status = decoder.decode(sent.payload, sent.key, out.positions, out.normals);
    EXPECT_TRUE(status) << status.error().message;
    return out;
  }
  /// Writes, reads and compares; tells whether it was a key.
  bool send(const Vertices& in, bool asked = false) {
    const Sent sent = write(in, asked);
    const Vertices out = read(sent, in.positions.size() / 3);
    expect_near_positions(in.positions, out.positions, extent);
    EXPECT_LE(worst_angle(in.normals, out.normals), kShortNormalError);
    return sent.key;
  }
  VerticesMeshoptEncoder encoder;
  VerticesMeshoptDecoder decoder;
  std::array<float, 3> extent{};  ///< of the last key
};

Vertices noise_of(std::size_t vertices, Noise& noise) {
  Vertices out;
  for (std::size_t v = 0; v < vertices; ++v) {
    std::array<double, 3> n{};
    while (std::hypot(n[0], n[1], n[2]) < 0.1) n = {noise.next(), noise.next(), noise.next()};
    for (const double c : n) {
      out.positions.push_back(noise.next());
      out.normals.push_back(static_cast<float>(c / std::hypot(n[0], n[1], n[2])));
    }
  }
  return out;
}

Vertices moved(Vertices v, float x) {
  for (std::size_t i = 0; i < v.positions.size(); i += 3) v.positions[i] += x;
  return v;
}

// ----------------------------------------------------------------------------------------------------------- refusals

void expect_refused(VerticesMeshoptDecoder& decoder, std::span<const std::byte> payload, bool key, std::size_t vertices,
                    std::string_view words) {
  std::vector<float> positions(3 * vertices, -7.0F), normals(3 * vertices, -7.0F);
  const Status status = decoder.decode(payload, key, positions, normals);
  ASSERT_FALSE(status) << words;
  EXPECT_EQ(status.error().code, ErrorCode::Parse);
  EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
  EXPECT_TRUE(std::ranges::all_of(positions, [](float x) { return x == -7.0F; }));
  EXPECT_TRUE(std::ranges::all_of(normals, [](float x) { return x == -7.0F; }));
}

TEST(VerticesMeshopt, RefusesADeltaWithoutItsKey) {
  Stream stream;
  const Vertices in = wavy_sphere(20, 20, 0);
  stream.write(in);
  const auto delta = stream.write(in);
  ASSERT_FALSE(delta.key);
  expect_refused(stream.decoder, delta.payload, false, 400, "a key of 400 vertices first");
  stream.send(in, true);
  expect_refused(stream.decoder, delta.payload, false, 399, "a key of 399 vertices first");
}

TEST(VerticesMeshopt, RefusesWhatIsCutOrNoneOfIts) {
  Stream stream;
  const Vertices in = wavy_sphere(20, 20, 0);
  const auto key = stream.write(in);
  for (std::size_t size = 0; size < key.payload.size(); ++size) {
    expect_refused(stream.decoder, std::span(key.payload).first(size), true, 400, "expected");
  }
  stream.read(key, 400);
  auto delta = stream.write(wavy_sphere(20, 20, 0.1));
  ASSERT_FALSE(delta.key);
  for (std::size_t size = 0; size < delta.payload.size(); ++size) {
    expect_refused(stream.decoder, std::span(delta.payload).first(size), false, 400, "expected");
  }
  std::swap(delta.payload[0], delta.payload.back());
  delta.payload[0] = std::byte{0x90};
  expect_refused(stream.decoder, delta.payload, false, 400, "expected");
  auto by_time = key.payload;
  by_time[24] = std::byte{0x03};
  expect_refused(stream.decoder, by_time, true, 400, "foretellings below 3 in a key, found 0x03");
  auto infinite = key.payload;
  infinite[3] = std::byte{0x7F}, infinite[2] = std::byte{0x80};
  expect_refused(stream.decoder, infinite, true, 400, "finite bounds");
}

TEST(VerticesMeshopt, WhatIsRefusedChangesNothing) {
  Stream stream;
  const Vertices in = wavy_sphere(20, 20, 0);
  stream.send(in);
  stream.send(wavy_sphere(20, 20, 0.1));
  const auto delta = stream.write(wavy_sphere(20, 20, 0.2));
  expect_refused(stream.decoder, std::span(delta.payload).first(40), false, 400, "expected");
  // Nor does a key of another size, wherever it is found to be none.
  const auto other = Stream().write(wavy_sphere(20, 30, 0));
  for (const auto& [at, value] : {std::pair{std::size_t{3}, 0xFF}, {24, 0x33}, {27, 0x00}}) {
    auto none = other.payload;
    none[at] = static_cast<std::byte>(value);
    expect_refused(stream.decoder, none, true, 600, "expected");
  }
  const Vertices out = stream.read(delta, 400);
  expect_near_positions(wavy_sphere(20, 20, 0.2).positions, out.positions, stream.extent);
}

// ------------------------------------------------------------------------------------------------------------- values

TEST(VerticesMeshopt, KeepsTheStatedErrorsWithoutDrift) {
  Stream stream;
  EXPECT_TRUE(stream.send(wavy_sphere(31, 37, 0)));
  for (int i = 1; i < 400; ++i) stream.send(wavy_sphere(31, 37, i / 60.0));
}

TEST(VerticesMeshopt, BringsWhatCannotBeForetold) {
  Stream stream;
  Noise noise(1);
  for (int i = 0; i < 20; ++i) stream.send(noise_of(1000, noise), i % 7 == 0);
}

TEST(VerticesMeshopt, DirectionsKeepTheStatedAngleAllOverTheSphere) {
  Noise noise(3);
  Stream stream;
  const Vertices in = noise_of(500'000, noise);
  const double worst = worst_angle(in.normals, stream.read(stream.write(in), 500'000).normals);
  EXPECT_LE(worst, kShortNormalError);
  EXPECT_GE(worst, kShortNormalError / 2) << "the stated error could be smaller";
}

TEST(VerticesMeshopt, WhatIsTooFarAwayOrNotFiniteIsSentAsTheNearestThatIs) {
  Stream stream;
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const Vertices in = seed % 7 == 0 ? wavy_sphere(4, 10, seed) : odd_vertices(40, seed);
    const Vertices out = stream.read(stream.write(in), 40), meant = tamed(in);
    expect_near_positions(meant.positions, out.positions, stream.extent);
    EXPECT_LE(worst_angle(meant.normals, out.normals), kShortNormalError);
  }
}

TEST(VerticesMeshopt, NormalsThatAreNoneStayNoneAndComeBack) {
  Stream stream;
  Vertices in = wavy_sphere(20, 20, 0);
  stream.send(in);
  for (std::size_t i = 300; i < 900; ++i) in.normals[i] = 0.0F;
  stream.send(in);
  stream.send(wavy_sphere(20, 20, 0));
}

TEST(VerticesMeshopt, BlocksOfAnySizeComeBack) {
  Noise noise(5);
  for (const std::size_t n : {0U, 1U, 2U, 3U, 15U, 16U, 17U, 255U, 256U, 257U, 511U, 512U, 513U, 1025U}) {
    Stream stream;
    for (int i = 0; i < 4; ++i) stream.send(noise_of(n, noise));
  }
}

TEST(VerticesMeshopt, NoVerticesAreNoBytes) {
  Stream stream;
  EXPECT_EQ(stream.write({}).payload.size(), 24U);
  EXPECT_EQ(stream.write({}).payload.size(), 0U);
}

// -------------------------------------------------------------------------------------------------------------- bounds

TEST(VerticesMeshopt, BreathingNeedsNoKeyAndGrowingOne) {
  Stream stream;
  Vertices in = wavy_sphere(20, 20, 0);
  EXPECT_TRUE(stream.send(in));
  for (float& x : in.positions) x *= 1.05F;
  EXPECT_FALSE(stream.send(in));
  for (float& x : in.positions) x *= 1.3F;
  EXPECT_TRUE(stream.send(in));
}

TEST(VerticesMeshopt, RoomTakesABitAtMost) {
  Stream stream;
  const Vertices in = wavy_sphere(20, 20, 0);  // about 2 metres wide
  stream.send(in);
  for (const float extent : stream.extent) EXPECT_LE(extent, 2.4F * 1.126F);
  stream.send(moved(in, 100.0F));
  EXPECT_LE(stream.extent[0], 2.4F * 2.0F);
  EXPECT_LE(stream.extent[1], 2.4F * 1.126F);
}

TEST(VerticesMeshopt, AWalkNeedsAKeyNowAndThen) {
  Stream stream;
  int keys = 0;
  for (int i = 0; i < 120; ++i) keys += stream.send(moved(wavy_sphere(9, 9, 0), 1.5F * static_cast<float>(i) / 60.0F)) ? 1 : 0;
  EXPECT_LE(keys, 6);
}

TEST(VerticesMeshopt, AFlatMeshThatBeginsToMoveFindsItsRoom) {
  Stream stream;
  Vertices in = wavy_sphere(20, 20, 0);
  int keys = 0;
  for (int frame = 0; frame < 60; ++frame) {
    for (std::size_t i = 1; i < in.positions.size(); i += 3) {
      in.positions[i] = 0.01F * static_cast<float>(frame) * std::sin(static_cast<float>(i));
    }
    keys += stream.send(in) ? 1 : 0;
  }
  EXPECT_LE(keys, 5);
}

// ------------------------------------------------------------------------------------------------------------- readers

TEST(VerticesMeshopt, ALateReaderSeesWhatTheOthersSee) {
  Stream stream;
  for (int i = 0; i < 5; ++i) stream.send(wavy_sphere(20, 20, i / 60.0));
  Stream late;
  for (int i = 5; i < 10; ++i) {
    const auto sent = stream.write(wavy_sphere(20, 20, i / 60.0), i == 5);
    const Vertices a = stream.read(sent, 400), b = late.read(sent, 400);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.normals, b.normals);
  }
}

TEST(VerticesMeshopt, AnotherCountOfVerticesMakesAKey) {
  Stream stream;
  for (const std::size_t rings : {20U, 30U, 3U, 20U}) EXPECT_TRUE(stream.send(wavy_sphere(rings, 20, 0)));
}

// --------------------------------------------------------------------------------------------------------------- costs

TEST(VerticesMeshopt, AMovingSurfaceTakesFewBytes) {
  Stream stream;
  std::size_t bytes = 0;
  for (int i = 0; i < 12; ++i) bytes += stream.write(wavy_sphere(150, 200, i / 60.0)).payload.size();
  EXPECT_LE(static_cast<double>(bytes) / (12 * 150 * 200), 3.0);
}

TEST(VerticesMeshopt, TakesNoMemoryOnceWarm) {
  Stream stream;
  const Vertices in = wavy_sphere(30, 30, 0);
  std::vector<std::byte> out(VerticesMeshoptEncoder::most_bytes(900));
  Vertices back = in;
  const auto send = [&](bool asked) {
    const Encoded encoded = stream.encoder.encode(in.positions, in.normals, asked, out);
    ASSERT_TRUE(stream.decoder.decode(std::span(out).first(encoded.bytes), encoded.key, back.positions, back.normals));
  };
  send(true);
  const std::size_t before = test::allocations();
  for (int i = 0; i < 10; ++i) send(i % 5 == 0);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace tweend::protocol
