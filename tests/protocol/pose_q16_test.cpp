#include "protocol/pose_q16.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/protocol/codec_inputs.hpp"
#include "tests/support/allocations.hpp"

namespace tweend::protocol {
namespace {

/// A writer and a reader of one stream.
struct Stream {
  struct Sent {
    std::vector<std::byte> payload;
    bool key;
  };
  Sent write(const Pose& pose, bool asked = false, bool jumped = false) {
    std::vector<std::byte> out(PoseQ16Encoder::most_bytes(pose.joints.size() / 10, pose.weights.size()));
    const Encoded encoded = encoder.encode(pose.joints, pose.weights, asked, out, jumped);
    EXPECT_LE(encoded.bytes, out.size());
    out.resize(encoded.bytes);
    return {out, encoded.key};
  }
  Pose read(const Sent& sent, const Pose& like) {
    Pose out{std::vector<float>(like.joints.size(), -7.0F), std::vector<float>(like.weights.size(), -7.0F)};
    const Status status = decoder.decode(sent.payload, sent.key, out.joints, out.weights);
    EXPECT_TRUE(status) << status.error().message;
    return out;
  }
  Pose send(const Pose& pose, bool asked = false) { return read(write(pose, asked), pose); }

  PoseQ16Encoder encoder;
  PoseQ16Decoder decoder;
};

/// The angle between two rotations, by the distance of their quaternions, which is exact also where it is small.
double angle(std::span<const float, 4> a, std::span<const float, 4> b) {
  double plus = 0.0, minus = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    plus += std::pow(double{a[k]} + b[k], 2);
    minus += std::pow(double{a[k]} - b[k], 2);
  }
  return 4.0 * std::asin(std::sqrt(std::min(plus, minus)) / 2.0);
}

constexpr double kRotationError = 1.5e-4;  ///< radians, as docs/PROTOCOL.md states it

Pose tumbling(std::size_t joints, std::uint32_t seed) {
  Noise noise(seed);
  Pose pose = resting_pose(joints, 0);
  for (std::size_t j = 0; j < joints; ++j) turn(pose, j, noise);
  return pose;
}

// ----------------------------------------------------------------------------------------------------------- refusals

void expect_refused(PoseQ16Decoder& decoder, std::vector<std::byte> payload, bool key, std::string_view words) {
  std::vector<float> joints(30, -7.0F), weights(2, -7.0F);
  const Status status = decoder.decode(payload, key, joints, weights);
  ASSERT_FALSE(status) << words;
  EXPECT_EQ(status.error().code, ErrorCode::Parse);
  EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
  EXPECT_TRUE(std::ranges::all_of(joints, [](float x) { return x == -7.0F; }));
  EXPECT_TRUE(std::ranges::all_of(weights, [](float x) { return x == -7.0F; }));
}

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> out;
  for (const int value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

TEST(PoseQ16, RefusesADeltaWithoutItsKey) {
  PoseQ16Decoder decoder;
  expect_refused(decoder, bytes({0}), false, "a key of 3 joints and 2 weights first");
  std::vector<float> joints(20);
  ASSERT_TRUE(decoder.decode(bytes({0}), true, joints, {}));
  expect_refused(decoder, bytes({0}), false, "a key of 3 joints and 2 weights first");
}

TEST(PoseQ16, RefusesBytesThatAreNoPose) {
  PoseQ16Decoder decoder;
  expect_refused(decoder, {}, true, "a byte or more");
  expect_refused(decoder, bytes({16}), true, "sections below 16, found 16");
  expect_refused(decoder, bytes({0, 1}), true, "the end");
  expect_refused(decoder, bytes({1}), true, "expected 1 bytes of section 0");
  expect_refused(decoder, bytes({1, 8}), true, "bits beyond");
  expect_refused(decoder, bytes({2, 1, 0, 0, 0, 0, 0}), true, "expected 6 bytes of section 1");
  expect_refused(decoder, bytes({2, 1, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0x7F}), true, "expected a rotation");
  expect_refused(decoder, bytes({2, 1, 0, 0x40, 0, 0x40, 0, 0xC0}), true, "expected a rotation");
  expect_refused(decoder, bytes({8, 2, 0, 0, 0x80, 0x7F, 0}), true, "finite base");
  expect_refused(decoder, bytes({8, 2, 0, 0, 0, 0, 81}), true, "exponent from -24 to 80");
  expect_refused(decoder, bytes({8, 2, 0, 0, 0, 0, 0xE7}), true, "exponent from -24 to 80");
}

TEST(PoseQ16, RefusesAPacketCutAnywhere) {
  Stream stream;
  Noise noise(3);
  Pose pose = resting_pose(3, 2);
  stream.send(pose);
  pose.translation(1)[0] = 0.1F;
  pose.weights[1] = 0.5F;
  pose.scale(2)[1] = 1.25F;
  turn(pose, 0, noise);
  for (const bool asked : {true, false}) {
    if (!asked) pose.joints[0] += 0.01F, pose.scale(2)[0] = 1.1F, pose.weights[0] = 0.1F, turn(pose, 1, noise);
    const auto sent = stream.write(pose, asked);
    ASSERT_EQ(sent.key, asked);
    for (std::size_t size = 0; size < sent.payload.size(); ++size) {
      expect_refused(stream.decoder, {sent.payload.begin(), sent.payload.begin() + static_cast<std::ptrdiff_t>(size)}, sent.key,
                     "expected");
    }
    stream.read(sent, pose);  // nothing of all that has changed what the reader knows
  }
}

// ------------------------------------------------------------------------------------------------------------- values

TEST(PoseQ16, KeysBringAllButRotationsExactly) {
  Stream stream;
  Noise noise(1);
  Pose pose = resting_pose(67, 5);
  for (float& x : pose.joints) x = 1e4F * noise.next() * noise.next();
  for (std::size_t j = 0; j < 67; ++j) turn(pose, j, noise);
  for (float& x : pose.weights) x = noise.next();
  Pose out = stream.send(pose);
  for (std::size_t j = 0; j < 67; ++j) {
    EXPECT_LE(angle(out.rotation(j), pose.rotation(j)), kRotationError);
  }
  for (std::size_t i = 0; i < pose.joints.size(); ++i) {
    const bool is_rotation = i % 10 >= 3 && i % 10 <= 6;
    EXPECT_TRUE(is_rotation || out.joints[i] == pose.joints[i]) << i;
  }
  EXPECT_EQ(out.weights, pose.weights);
}

TEST(PoseQ16, RotationsKeepTheStatedAngleAndUnitLength) {
  Stream stream;
  double worst = 0.0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    Pose pose = tumbling(4096, seed);
    // Where all components are alike, what is left out is known worst; and where it is chance which is left out.
    for (std::size_t j = 0; j < 512; ++j) {
      Noise noise(seed + static_cast<std::uint32_t>(j));
      double square = 0.0;
      for (float& x : pose.rotation(j)) x = (noise.next() < 0 ? -0.5F : 0.5F) + 1e-4F * noise.next(), square += double{x} * x;
      for (float& x : pose.rotation(j)) x = static_cast<float>(x / std::sqrt(square));
    }
    Pose out = stream.send(pose);
    for (std::size_t j = 0; j < 4096; ++j) {
      worst = std::max(worst, angle(out.rotation(j), pose.rotation(j)));
      double square = 0.0;
      for (const float x : out.rotation(j)) square += double{x} * x;
      ASSERT_NEAR(square, 1.0, 1e-6);
    }
  }
  EXPECT_LE(worst, kRotationError);
  EXPECT_GE(worst, kRotationError / 2) << "the stated error could be smaller";
}

TEST(PoseQ16, AxesAndTheIdentityAreExact) {
  Stream stream;
  for (std::size_t axis = 0; axis < 4; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      Pose pose = resting_pose(1, 0);
      std::ranges::fill(pose.rotation(0), 0.0F);
      pose.rotation(0)[axis] = sign;
      Pose out = stream.send(pose);
      for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(out.rotation(0)[k], k == axis ? 1.0F : 0.0F);
    }
  }
}

TEST(PoseQ16, StaysWithinHalfAStepHoweverFarFromTheOrigin) {
  Stream stream;
  Noise noise(9);
  Pose pose = resting_pose(1, 0);
  pose.translation(0)[0] = 1000.0F;
  stream.send(pose);
  for (int i = 0; i < 1000; ++i) {
    for (std::size_t k = 0; k < 3; ++k) pose.translation(0)[k] = (k == 0 ? 1000.0F : 0.0F) + 0.25F * noise.next();
    const auto sent = stream.write(pose);
    ASSERT_FALSE(sent.key);
    Pose out = stream.read(sent, pose);
    constexpr double kHalfStep = 1.0 / (1 << 18);
    constexpr double kFloatAt1000 = 1.0 / (1 << 15);  // half of what float32 can tell apart there
    EXPECT_NEAR(out.translation(0)[0], pose.translation(0)[0], kHalfStep + kFloatAt1000);
    EXPECT_NEAR(out.translation(0)[1], pose.translation(0)[1], kHalfStep);
    EXPECT_NEAR(out.translation(0)[2], pose.translation(0)[2], kHalfStep);
  }
}

TEST(PoseQ16, DoesNotDrift) {
  Stream stream;
  Noise noise(2);
  Pose pose = resting_pose(5, 2);
  stream.send(pose);
  for (std::size_t i = 0; i < 5000; ++i) {
    const std::size_t j = i % 5;
    if (i % 3 == 0) turn(pose, j, noise);
    pose.translation(j)[i % 3] = 0.2F * noise.next();
    pose.scale(j)[1] = 1.0F + 0.5F * noise.next();
    pose.weights[1] = noise.next();
    Pose out = stream.send(pose);
    for (std::size_t k = 0; k < 5; ++k) {
      ASSERT_LE(angle(out.rotation(k), pose.rotation(k)), kRotationError);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(out.translation(k)[axis], pose.translation(k)[axis], 1.0 / (1 << 18));
        ASSERT_NEAR(out.scale(k)[axis], pose.scale(k)[axis], 1.0 / (1 << 15));
      }
    }
    ASSERT_NEAR(out.weights[1], pose.weights[1], 1.0 / (1 << 15));
  }
}

// -------------------------------------------------------------------------------------------------------------- ranges

TEST(PoseQ16, AValueOutOfReachMakesAKeyAndRoom) {
  Stream stream;
  Pose pose = resting_pose(2, 1);
  stream.send(pose);
  pose.translation(1)[2] = 0.26F;  // the first reach is a quarter of a metre
  EXPECT_TRUE(stream.write(pose).key);
  for (const float z : {1.2F, -0.7F, 0.26F}) {
    pose.translation(1)[2] = z;
    EXPECT_FALSE(stream.write(pose).key) << z;
  }
  pose.weights[0] = 1.0F;
  EXPECT_FALSE(stream.write(pose).key) << "weights from 0 to 1 need none";
}

TEST(PoseQ16, AWalkNeedsFewKeys) {
  Stream stream;
  Pose pose = resting_pose(1, 0);
  int unasked = 0;
  for (int i = 0; i < 600; ++i) {
    pose.translation(0)[0] = 1.5F * static_cast<float>(i) / 60.0F;
    const bool asked = i % 60 == 0;
    unasked += stream.write(pose, asked).key && !asked ? 1 : 0;
  }
  EXPECT_LE(unasked, 2);
}

TEST(PoseQ16, StepsBecomeFinerWhereLittleMoves) {
  Stream stream;
  Noise noise(4);
  Pose pose = resting_pose(1, 0);
  double worst = 0.0;
  for (int i = 0; i < 600; ++i) {
    pose.translation(0)[1] = 1e-3F * noise.next();
    const Pose out = stream.send(pose, i % 60 == 0);
    if (i > 300) worst = std::max(worst, std::abs(double{out.joints[1]} - pose.joints[1]));
  }
  constexpr double kMoved = 2e-3;
  EXPECT_LE(worst, 4 * kMoved / 32767);
}

TEST(PoseQ16, JumpsLeaveTheStepsOfWhatMovesLittle) {
  Stream stream;
  Noise noise(14);
  Pose pose = resting_pose(1, 0);
  float from = 0.0F;
  for (int i = 0; i < 600; ++i) {
    const bool jumped = i > 0 && i % 25 == 0;  // a clip that wraps, and a second has passed seldom
    if (jumped) from = from == 0.0F ? 1024.0F : 0.0F;
    pose.translation(0)[0] = from;
    pose.translation(0)[1] = from + 0.125F + 0.1F * noise.next();
    const auto sent = stream.write(pose, i % 60 == 0, jumped);
    EXPECT_EQ(sent.key, i % 60 == 0 || jumped) << i;
    constexpr double kFloatAt1024 = 1.0 / (1 << 14);
    ASSERT_NEAR(stream.read(sent, pose).joints[1], pose.joints[1], 4 * 0.35 / 32767 + (from > 0 ? kFloatAt1024 : 0)) << i;
  }
}

/// What docs/PROTOCOL.md allows, worked out from the values and from which packets are keys.
TEST(PoseQ16, ErrorsAreWhatThePageSaysWhateverMoves) {
  Stream stream;
  Noise noise(21);
  Pose pose = resting_pose(4, 0);
  stream.send(pose);
  std::array<double, 4> most{}, far{}, base{};
  most.fill(std::ldexp(1.0, -18));
  for (int i = 1; i < 3000; ++i) {
    const bool asked = i % 40 == 0, jumped = i % 333 == 0;
    for (std::size_t j = 0; j < 4; ++j) {
      float& x = pose.translation(j)[0];
      x = jumped ? 64.0F * noise.next() : x + std::ldexp(noise.next(), -5 * static_cast<int>(j) - (i / 500 % 2) * 6);
      if (!jumped) far[j] = std::max(far[j], std::abs(x - base[j]));
    }
    PoseQ16Encoder unasked = stream.encoder;
    std::vector<std::byte> room(PoseQ16Encoder::most_bytes(4, 0));
    const bool left = !jumped && unasked.encode(pose.joints, {}, false, room).key;
    const auto sent = stream.write(pose, asked, jumped);
    ASSERT_EQ(sent.key, asked || jumped || left);
    Pose out = stream.read(sent, pose);
    for (std::size_t j = 0; j < 4; ++j) {
      const float x = pose.translation(j)[0];
      ASSERT_NEAR(out.translation(j)[0], x, sent.key ? 0.0 : most[j] + std::ldexp(std::abs(x), -24)) << i << ' ' << j;
      if (!sent.key) continue;
      if (far[j] > 0) most[j] = std::max({4 * far[j] / 32767, std::ldexp(1.0, -25), left ? most[j] : most[j] / 4});
      far[j] = 0, base[j] = x;
    }
  }
}

TEST(PoseQ16, WhatIsNotFiniteIsSentAsWhatIs) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kMost = std::numeric_limits<float>::max();
  constexpr std::array kOdd{kInfinity, -kInfinity, kNan, kMost, -kMost, 3e37F, 1e-40F, 0.1F};
  Stream stream;
  std::mt19937 random(3);
  Pose pose = resting_pose(4, 3);
  const auto near = [kMost](float value, float rest, float out) {
    const float meant = std::isnan(value) ? rest : std::clamp(value, -kMost, kMost);
    EXPECT_NEAR(out, meant, std::ldexp(1.0, 79));
  };
  for (int i = 0; i < 500; ++i) {
    const auto change = [&](float& value) { value = random() % 4 == 0 ? kOdd[random() % kOdd.size()] : value; };
    std::ranges::for_each(pose.joints, change);
    std::ranges::for_each(pose.weights, change);
    Pose out = stream.read(stream.write(pose, i % 9 == 0, i % 13 == 0), pose);
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        near(pose.translation(j)[k], 0.0F, out.translation(j)[k]);
        near(pose.scale(j)[k], 1.0F, out.scale(j)[k]);
      }
      EXPECT_EQ(std::vector(out.rotation(j).begin(), out.rotation(j).end()), (std::vector<float>{0, 0, 0, 1}));
      pose.rotation(j)[3] = 2.0F;  // never of unit length
    }
    for (std::size_t w = 0; w < 3; ++w) near(pose.weights[w], 0.0F, out.weights[w]);
  }
}

TEST(PoseQ16, ValuesAtTheEndsOfFloatAreKeysAndExact) {
  Stream stream;
  Pose pose = resting_pose(1, 0);
  for (const float x : {std::numeric_limits<float>::max(), -std::numeric_limits<float>::max(),
                        std::numeric_limits<float>::denorm_min(), 0.0F}) {
    pose.translation(0)[0] = x;
    const auto sent = stream.write(pose);
    EXPECT_NEAR(stream.read(sent, pose).joints[0], x, std::ldexp(1.0, 79)) << x;
    EXPECT_EQ(stream.send(pose, true).joints[0], x);
  }
}

// --------------------------------------------------------------------------------------------------------------- sizes

TEST(PoseQ16, AnUnchangedPoseIsOneByte) {
  Stream stream;
  const Pose pose = tumbling(67, 8);
  const Pose first = stream.send(pose);
  const auto again = stream.write(pose);
  EXPECT_FALSE(again.key);
  EXPECT_EQ(again.payload.size(), 1U);
  EXPECT_EQ(stream.read(again, pose).joints, first.joints);
  EXPECT_EQ(stream.write(resting_pose(0, 0)).payload.size(), 1U);
}

TEST(PoseQ16, OnlyJointsThatChangeTravel) {
  Stream stream;
  Noise noise(6);
  Pose pose = resting_pose(67, 0);
  EXPECT_EQ(stream.write(pose, true).payload.size(), 1U) << "at rest, a key says nothing more than that";
  for (std::size_t moving = 1; moving <= 67; moving += 11) {
    for (std::size_t j = 0; j < moving; ++j) turn(pose, j, noise);
    EXPECT_EQ(stream.write(pose).payload.size(), 1 + 9 + 6 * moving);
  }
  pose.translation(40)[1] = 0.1F;
  EXPECT_EQ(stream.write(pose).payload.size(), 1 + 9 + 6U);
}

// ------------------------------------------------------------------------------------------------------------- readers

TEST(PoseQ16, ALateReaderSeesWhatTheOthersSee) {
  Stream stream;
  Noise noise(7);
  Pose pose = resting_pose(9, 1);
  stream.send(pose);
  for (int i = 0; i < 50; ++i) {
    turn(pose, static_cast<std::size_t>(i) % 9, noise);
    pose.translation(2)[1] = 0.1F * noise.next();
    stream.send(pose);
  }
  const auto key = stream.write(pose, true);
  Stream late;
  EXPECT_EQ(late.read(key, pose).joints, stream.read(key, pose).joints);
  pose.translation(2)[0] = 0.05F;
  const auto after = stream.write(pose);
  EXPECT_EQ(late.read(after, pose).joints, stream.read(after, pose).joints);
}

TEST(PoseQ16, AnotherCountOfJointsMakesAKey) {
  Stream stream;
  for (const std::size_t joints : {3U, 5U, 0U, 4U}) {
    const Pose pose = tumbling(joints, 1);
    const auto sent = stream.write(pose);
    EXPECT_TRUE(sent.key);
    stream.read(sent, pose);
  }
  Pose morphs = resting_pose(0, 4);
  EXPECT_TRUE(stream.write(morphs).key);
}

TEST(PoseQ16, TakesNoMemoryOnceWarm) {
  Stream stream;
  Noise noise(12);
  Pose pose = resting_pose(30, 4);
  Pose back = pose;
  std::vector<std::byte> out(PoseQ16Encoder::most_bytes(30, 4));
  const auto send = [&](bool asked) {
    const Encoded encoded = stream.encoder.encode(pose.joints, pose.weights, asked, out);
    ASSERT_TRUE(stream.decoder.decode(std::span(out).first(encoded.bytes), encoded.key, back.joints, back.weights));
  };
  send(true);
  const std::size_t before = test::allocations();
  for (int i = 0; i < 10; ++i) {
    turn(pose, 3, noise);
    pose.translation(2)[0] = static_cast<float>(i);
    send(i % 5 == 0);
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace tweend::protocol
