// Exit codes 1 and 3, and the line that says why.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

const Json kError{
    {"code", -32602},
    {"message", "a parameter is not valid"},
    {"data", {{"kind", "invalid_params"}, {"path", "params.time"}, {"message", "expected a number, found \"x\""}}}};

test::Outcome refused(std::vector<std::string> arguments, const Json& error) {
  return test::run_cli({{"playback.seek", {{"time", 1}}, test::refusal(error)}}, std::move(arguments));
}

TEST(Failure, ARefusalIsOneLine) {
  const auto run = refused({"seek", "1"}, kError);
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "tweenctl: playback.seek refused (invalid_params, params.time): expected a number, found \"x\"\n");
}

TEST(Failure, ARefusalWithoutAPathNamesOnlyTheKind) {
  Json error = kError;
  error["data"].erase("path");
  EXPECT_EQ(refused({"seek", "1"}, error).err,
            "tweenctl: playback.seek refused (invalid_params): expected a number, found \"x\"\n");
}

TEST(Failure, ARefusalMayBeBare) {
  EXPECT_EQ(refused({"seek", "1"}, {{"code", -32000}, {"message", "no\nway"}}).err,
            "tweenctl: playback.seek refused (-32000): no way\n");
}

TEST(Failure, JsonPrintsTheErrorToo) {
  const auto run = refused({"--json", "seek", "1"}, kError);
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.out, kError.dump() + "\n");
  EXPECT_NE(run.err, "");
}

TEST(Failure, AnEventMayComeBeforeTheRefusal) {
  const auto run = test::run_cli(
      {{"playback.pause", Json::object(), test::event("scene.changed", Json::object()) + test::refusal(kError)}}, {"pause"});
  EXPECT_EQ(run.code, ExitCode::Refused);
}

TEST(Failure, NobodyListening) {
  const test::DeafPort port;
  const auto run = test::run_alone({"--server", port.address(), "status"});
  EXPECT_EQ(run.code, ExitCode::NoServer);
  EXPECT_EQ(run.err, "tweenctl: no server at " + port.address() + " (Connection refused); is `tweend serve` running there?\n");
}

TEST(Failure, TheConnectionIsLostBeforeTheAnswer) {
  for (const char* bytes : {"", R"({"jsonrpc":"2.0","id":$ID,"res)"}) {
    const auto run = test::run_cli({{"playback.get", Json::object(), bytes, true}}, {"status"});
    EXPECT_EQ(run.code, ExitCode::NoServer);
    EXPECT_EQ(run.err, "tweenctl: no answer to playback.get: the connection was closed\n");
  }
}

TEST(Failure, TheServerNeverAnswers) {
  const auto run = test::run_cli({{"playback.get", Json::object(), ""}}, {"status", "--timeout", "0.3"});
  EXPECT_EQ(run.code, ExitCode::NoServer);
  EXPECT_EQ(run.err, "tweenctl: no answer to playback.get in time: nothing arrived in time\n");
}

TEST(Failure, ARecordingMayTakeItsTimeToEnd) {
  // Who asked later, and waits as long, has given up before this one is answered.
  const auto other_gives_up = [] {
    const auto other = test::run_cli({{"playback.get", Json::object(), ""}}, {"status", "--timeout", "0.1"});
    EXPECT_EQ(other.code, ExitCode::NoServer);
  };
  const Json saved{{"name", "a.mp4"}, {"frames", 90}, {"bytes", 1200}};
  const auto run = test::run_cli({{"record.stop", {{"record", 3}}, test::answer(saved), false, other_gives_up}},
                                 {"record", "stop", "3", "--timeout", "0.1"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_EQ(run.out, "a.mp4 saved: 90 pictures, 1200 bytes\n");
}

TEST(Failure, AnAnswerOfAnotherShape) {
  const auto run = test::run_cli({test::answers("playback.get", Json::object(), {{"players", 3}, {"x", 1}})}, {"status"});
  EXPECT_EQ(run.code, ExitCode::NoServer);
  EXPECT_EQ(run.err.rfind("tweenctl: the server's answer is not what this program expects", 0), 0U) << run.err;
}

}  // namespace
}  // namespace tweend::cli
