#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <regex>
#include <span>

#include "protocol/pose_q16.hpp"
#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using test::answer;
using test::run_cli;

const std::vector<float> kOneJointAndAWeight{1, 2, -3, 0, 0, 0, 1, 1, 1, 1, 0.5F};

std::string packet(const std::vector<float>& floats = kOneJointAndAWeight) {
  protocol::PacketHeader header;
  header.kind = protocol::PacketKind::Pose;
  header.stream = 4;
  header.sequence = 1;
  header.flags = 1;
  header.media_us = 250'000;
  header.revision = 9;
  return test::packet(header, floats);
}

/// The clock is asked four times, then the stream is opened.
std::vector<test::Reaction> stream(Json params, const Json& layout, const std::string& packets = packet()) {
  std::vector<test::Reaction> script(4, test::answers("server.ping", Json::object(), {{"time_us", 5}}));
  params["kind"] = "pose";
  if (!params.contains("encoding")) params["encoding"] = "f32";
  script.push_back({"stream.open", params, answer({{"stream", 4}, {"layout", layout}}) + packets, false});
  return script;
}

const Json kLayout{
    {"joints", Json::array({Json{{"name", "hip"}, {"parent", nullptr}}})}, {"weights", {"smile"}}, {"stride", 40}};

TEST(WatchPose, PrintsALineAPacket) {
  const auto run = run_cli(stream({{"actor", "man"}, {"rate", 10}}, kLayout),
                           {"watch", "pose", "--count", "1", "--rate", "10", "--actor", "man"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("  1 joint, 1 weight, hip at (1, 2, -3)\n"), std::string::npos) << run.out;
}

TEST(WatchPose, PrintsHeadersForPrograms) {
  const auto run = run_cli(stream(Json::object(), kLayout), {"--json", "watch", "pose", "--count", "1"});
  const Json line = Json::parse(run.out);
  EXPECT_EQ(line.at("joints"), 1);
  EXPECT_EQ(line.at("weights"), 1);
  EXPECT_EQ(line.at("bytes"), 44);
}

TEST(WatchPose, OfAnActorWithoutJointsNamesNone) {
  const auto run = run_cli(stream(Json::object(), Json::object(), packet({})), {"watch", "pose", "--count", "1"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("  0 joints\n"), std::string::npos) << run.out;
}

TEST(WatchPose, OfAnotherSizeThanWasToldIsNone) {
  const auto run = run_cli(stream(Json::object(), kLayout, packet({1, 2, 3})), {"watch", "pose"});
  EXPECT_EQ(run.code, ExitCode::NoServer);
  EXPECT_EQ(run.err, "tweenctl: packet 1: expected 44 bytes of f32, found 12\n");
}

TEST(WatchPose, ReadsWhatIsLeftOutFromThePacketBefore) {
  protocol::PoseQ16Encoder encoder;
  const auto encode = [&](std::uint32_t sequence, float x, bool key) {
    std::vector<float> joint{x, 2, -3, 0, 0, 0, 1, 1, 1, 1};
    std::string payload(protocol::PoseQ16Encoder::most_bytes(1, 1), '\0');
    const std::array weights{0.5F};
    const auto encoded = encoder.encode(joint, weights, key, std::as_writable_bytes(std::span(payload)));
    payload.resize(encoded.bytes);
    protocol::PacketHeader header;
    header.kind = protocol::PacketKind::Pose;
    header.encoding = protocol::kPoseQ16;
    header.flags = encoded.key ? protocol::kFlagKey : 0;
    header.stream = 4;
    header.sequence = sequence;
    return test::raw_packet(header, payload);
  };
  constexpr std::array kX{1.0F, 1.5F, 1.5F};
  std::string packets;
  for (std::uint32_t i = 0; i < kX.size(); ++i) packets += encode(i, kX[i], i == 0);
  const Json params{{"encoding", "q16"}, {"delivery", "every"}};
  const auto run =
      run_cli(stream(params, kLayout, packets), {"watch", "pose", "--count", "3", "--encoding", "q16", "--delivery", "every"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  const std::regex pattern(R"(hip at \(([-.\d]+), ([-.\d]+), ([-.\d]+)\)\n)");
  std::vector<std::array<double, 3>> found;
  for (std::sregex_iterator at(run.out.begin(), run.out.end(), pattern), end; at != end; ++at) {
    found.push_back({std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3])});
  }
  ASSERT_EQ(found.size(), 3U) << run.out;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i][0], kX[i], 1e-3);
    EXPECT_NEAR(found[i][1], 2.0, 1e-3);
    EXPECT_NEAR(found[i][2], -3.0, 1e-3);
  }
}

}  // namespace
}  // namespace tweend::cli
