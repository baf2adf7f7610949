#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using test::answer;
using test::run_cli;

const std::vector<float> kOneJointAndAWeight{1, 2, -3, 0, 0, 0, 1, 1, 1, 1, 0.5F};

std::string packet() {
  protocol::PacketHeader header;
  header.stream = 4;
  header.sequence = 1;
  header.flags = 1;
  header.media_us = 250'000;
  header.revision = 9;
  return test::packet(header, kOneJointAndAWeight);
}

/// The clock is asked four times, then the stream is opened.
std::vector<test::Reaction> stream(Json params, const Json& layout) {
  std::vector<test::Reaction> script(4, test::answers("server.ping", Json::object(), {{"time_us", 5}}));
  params["kind"] = "pose";
  params["encoding"] = "f32";
  script.push_back({"stream.open", params, answer({{"stream", 4}, {"layout", layout}}) + packet(), false});
  return script;
}

const Json kLayout{
    {"joints", Json::array({Json{{"name", "hip"}, {"parent", nullptr}}})}, {"weights", {"smile"}}, {"stride", 40}};

TEST(WatchPose, PrintsALineAPacket) {
  const auto run = run_cli(stream({{"actor", "man"}, {"rate", 10}}, kLayout),
                           {"watch", "pose", "--count", "1", "--rate", "10", "--actor", "man"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("key  1 joint, 1 weight, hip at (1, 2, -3)\n"), std::string::npos) << run.out;
}

TEST(WatchPose, PrintsHeadersForPrograms) {
  const auto run = run_cli(stream(Json::object(), kLayout), {"--json", "watch", "pose", "--count", "1"});
  const Json line = Json::parse(run.out);
  EXPECT_EQ(line.at("joints"), 1);
  EXPECT_EQ(line.at("weights"), 1);
  EXPECT_EQ(line.at("bytes"), 44);
}

TEST(WatchPose, OfAnActorWithoutJointsNamesNone) {
  const auto run = run_cli(stream(Json::object(), Json::object()), {"watch", "pose", "--count", "1"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("  0 joints\n"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace tweend::cli
