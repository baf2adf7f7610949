// The program itself: what only a process of its own can show.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/cli/child_process.hpp"
#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

const std::string kEvent = test::event("scene.changed", {{"revision", 2}});

test::FakeServer events(const std::string& bytes) {
  return test::FakeServer({{"events.subscribe", Json::object(), test::answer(Json::object()) + bytes}});
}

TEST(Process, ExitCodesAreTheProcesses) {
  EXPECT_EQ(test::ChildProcess({TWEENCTL, "--version"}).wait(), 0);
  EXPECT_EQ(test::ChildProcess({TWEENCTL, "nonsense"}).wait(), 2);
}

TEST(Process, TheServerMayStandInTheEnvironment) {
  test::FakeServer server({test::answers("playback.get", Json::object(), {{"x", 1}})});
  test::ChildProcess child({"env", "TWEEND_SERVER=" + server.address(), TWEENCTL, "--timeout", "60", "--json", "status"});
  EXPECT_EQ(child.read_all(), "{\"x\":1}\n");
  EXPECT_EQ(child.wait(), 0);
  EXPECT_EQ(server.complaints(), "");
}

TEST(Process, AnInterruptIsNoFailure) {
  test::FakeServer server = events(kEvent);
  test::ChildProcess child(test::tweenctl(server, {"events"}));
  EXPECT_EQ(child.read_line(), "scene.changed     revision 2");  // it is waiting for the next one
  child.send_signal(SIGINT);
  EXPECT_EQ(child.wait(), 130);
}

TEST(Process, EndsQuietlyWithItsReader) {
  std::string many;
  for (int i = 0; i < 5000; ++i) many += kEvent;
  test::FakeServer server = events(many);
  test::ChildProcess child(test::tweenctl(server, {"events"}));
  EXPECT_NE(child.read_line(), "");
  child.close_output();
  EXPECT_EQ(child.wait(), -SIGPIPE);
}

TEST(Process, StandardInputMayHoldTheJson) {
  test::FakeServer server(
      {test::answers("edit.apply", {{"edits", Json::array({1})}}, {{"results", Json::array({1})}, {"revision", 3}})});
  test::ChildProcess child(test::tweenctl(server, {"apply", "-"}), "[1]");
  EXPECT_EQ(child.read_all(), "1 edit applied (revision 3)\n");
  EXPECT_EQ(child.wait(), 0);
}

}  // namespace
}  // namespace tweend::cli
