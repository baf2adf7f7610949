#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <span>

#include "protocol/vertices_meshopt.hpp"
#include "protocol/vertices_q16.hpp"
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
  if (!params.contains("encoding")) params["encoding"] = "f32";
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

/// A grid of 10 × 10 vertices one metre wide that rises with `height`.
struct Grid {
  explicit Grid(float height) {
    for (int i = 0; i < kCount; ++i) {
      const auto x = static_cast<float>(i % 10) / 9.0F;
      const auto z = static_cast<float>(i / 10) / 9.0F;
      for (const float each : {x, height * x, z}) positions.push_back(each);
      for (const float each : {0.0F, 1.0F, 0.0F}) normals.push_back(each);
    }
  }
  static constexpr int kCount = 100;
  std::vector<float> positions, normals;
};

std::string encoded_packet(std::uint32_t sequence, std::uint8_t encoding, bool key, std::string payload, std::size_t bytes) {
  payload.resize(bytes);
  protocol::PacketHeader header;
  header.encoding = encoding;
  header.flags = key ? protocol::kFlagKey : 0;
  header.stream = 4;
  header.sequence = sequence;
  return test::raw_packet(header, payload);
}

const Json kGridOpened{{"stream", 4}, {"layout", {{"vertices", Grid::kCount}}}};

/// The upper corner that each line tells.
std::vector<double> heights(const std::string& out) {
  std::vector<double> found;
  const std::regex pattern(R"(100 vertices, \([^)]*\) to \([-.\d]+, ([-.\d]+), [-.\d]+\)\n)");
  for (std::sregex_iterator at(out.begin(), out.end(), pattern), end; at != end; ++at) found.push_back(std::stod((*at)[1]));
  return found;
}

TEST(Watch, ReadsQuantisedVertices) {
  const Grid grid(0.5F);
  std::string payload(protocol::vertices_q16_bytes(Grid::kCount), '\0');
  protocol::encode_vertices_q16(grid.positions, grid.normals, std::as_writable_bytes(std::span(payload)));
  const auto run = run_cli(stream({{"encoding", "q16"}}, answer(kGridOpened) + encoded_packet(1, protocol::kVerticesQ16, true,
                                                                                              payload, payload.size())),
                           {"watch", "vertices", "--encoding", "q16", "--count", "1"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  ASSERT_EQ(heights(run.out).size(), 1U) << run.out;
  EXPECT_NEAR(heights(run.out)[0], 0.5, 1e-4);
}

TEST(Watch, ReadsVerticesThatNeedTheirPredecessors) {
  protocol::VerticesMeshoptEncoder encoder;
  std::string packets;
  const std::vector<float> rises{0.5F, 0.625F, 0.75F};
  for (std::uint32_t i = 0; i < rises.size(); ++i) {
    const Grid grid(rises[i]);
    std::string payload(protocol::VerticesMeshoptEncoder::most_bytes(Grid::kCount), '\0');
    const auto encoded = encoder.encode(grid.positions, grid.normals, i == 0, std::as_writable_bytes(std::span(payload)));
    packets += encoded_packet(i, protocol::kVerticesMeshopt, encoded.key, payload, encoded.bytes);
  }
  const auto run = run_cli(stream({{"encoding", "meshopt"}}, answer(kGridOpened) + packets),
                           {"watch", "vertices", "--encoding", "meshopt", "--count", "3"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  ASSERT_EQ(heights(run.out).size(), 3U) << run.out;
  for (std::size_t i = 0; i < rises.size(); ++i) EXPECT_NEAR(heights(run.out)[i], rises[i], 1e-3);
}

TEST(Watch, WhatIsNoSuchPacketEndsItAndIsNamed) {
  const auto complaint = [](std::uint8_t encoding, const std::string& payload) {
    const auto run =
        run_cli(stream(Json::object(), answer(kGridOpened) + encoded_packet(7, encoding, true, payload, payload.size())),
                {"watch", "vertices"});
    EXPECT_EQ(run.code, ExitCode::NoServer);
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  EXPECT_EQ(complaint(protocol::kVerticesF32, "short"), "tweenctl: packet 7: expected 2400 bytes of f32, found 5\n");
  EXPECT_EQ(complaint(9, ""), "tweenctl: packet 7: expected vertices as f32, q16 or meshopt, found encoding 9\n");
  for (const auto encoding : {protocol::kVerticesQ16, protocol::kVerticesMeshopt}) {
    EXPECT_EQ(complaint(encoding, "short").rfind("tweenctl: packet 7: ", 0), 0U);
  }
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
