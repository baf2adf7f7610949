#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using test::answer;
using test::event;
using test::run_cli;

const std::vector<float> kTwoVertices{0, 0, 0, 1, -2, 3, 0, 1, 0, 0, 1, 0};

std::string packet(std::uint32_t sequence, std::uint8_t flags) {
  protocol::PacketHeader header;
  header.stream = 4;
  header.sequence = sequence;
  header.flags = flags;
  header.media_us = 1'250'000;
  header.server_us = 77;
  header.revision = 9;
  return test::packet(header, kTwoVertices);
}

/// The clock is asked four times, then the stream is opened.
std::vector<test::Reaction> stream(Json params, const std::string& bytes, bool closes = false) {
  std::vector<test::Reaction> script(4, test::answers("server.ping", Json::object(), {{"time_us", 5}}));
  params["kind"] = "vertices";
  params["encoding"] = "f32";
  script.push_back({"stream.open", params, bytes, closes});
  return script;
}

const Json kOpened{{"stream", 4}, {"layout", {{"vertices", 2}}}};

TEST(Watch, PrintsALineAPacket) {
  const auto run = run_cli(stream({{"actor", "box"}, {"rate", 10}}, answer(kOpened) + packet(1, 3) + packet(5, 5)),
                           {"watch", "vertices", "--count", "2", "--rate", "10", "--actor", "box"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("#1          1.250 s  age "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("key, discontinuity  2 vertices, (0, -2, 0) to (1, 0, 3)\n"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("#5 "), std::string::npos);
  EXPECT_NE(run.out.find("key, last "), std::string::npos);
}

TEST(Watch, PrintsHeadersForPrograms) {
  const auto run =
      run_cli(stream(Json::object(), packet(1, 4) + answer(kOpened)), {"--json", "watch", "vertices", "--count", "1"});
  Json header = Json::parse(run.out);
  EXPECT_TRUE(header.at("age_us").is_number_integer());
  header.erase("age_us");
  EXPECT_EQ(header, (Json{{"stream", 4},
                          {"sequence", 1},
                          {"media_us", 1'250'000},
                          {"server_us", 77},
                          {"revision", 9},
                          {"flags", Json::array({"last"})},
                          {"vertices", 2},
                          {"bytes", 48}}));
}

TEST(Watch, EndsWithTheStream) {
  const auto run =
      run_cli(stream(Json::object(), answer(kOpened) + event("scene.changed", Json::object()) +
                                         event("stream.ended", {{"stream", 3}, {"reason", "another"}}) + packet(1, 1) +
                                         event("stream.ended", {{"stream", 4}, {"reason", "the actor was removed"}})),
              {"watch", "vertices"});
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.err, "tweenctl: the stream has ended: the actor was removed\n");
  EXPECT_NE(run.out, "");
}

TEST(Watch, EndsWithTheServer) {
  const auto run = run_cli(stream(Json::object(), answer(kOpened) + packet(1, 1).substr(0, 100), true), {"watch", "vertices"});
  EXPECT_EQ(run.code, ExitCode::NoServer);
}

}  // namespace
}  // namespace tweend::cli
