// Exit code 2, help and version; no server is needed for any of it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using test::run_alone;

std::string complaint(std::vector<std::string> arguments) {
  const auto run = run_alone(std::move(arguments));
  EXPECT_EQ(run.code, ExitCode::Usage);
  EXPECT_EQ(run.out, "");
  return run.err;
}

TEST(Usage, NothingToDoPrintsTheHelp) {
  EXPECT_NE(complaint({}).find("Subcommands:"), std::string::npos);
  EXPECT_NE(complaint({"scene"}).find("tweenctl scene"), std::string::npos);
}

TEST(Usage, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(run_alone({"--version"}).out, "tweenctl " TWEEND_VERSION "\n");
  EXPECT_EQ(run_alone({"--version"}).code, ExitCode::Done);
  const auto help = run_alone({"keyframe", "add", "--help"});
  EXPECT_EQ(help.code, ExitCode::Done);
  EXPECT_NE(help.out.find("tweenctl keyframe add"), std::string::npos) << help.out;
}

TEST(Usage, UnknownWordsAreNamed) {
  EXPECT_EQ(complaint({"foo"}), "tweenctl: there is no command foo; see `tweenctl --help`\n");
  EXPECT_EQ(complaint({"scene", "foo"}), "tweenctl: there is no command foo; see `tweenctl scene --help`\n");
  EXPECT_EQ(complaint({"--foo", "ping"}),
            "tweenctl: The following argument was not expected: --foo; see `tweenctl ping --help`\n");
  EXPECT_EQ(complaint({"seek", "1", "2"}),
            "tweenctl: The following argument was not expected: 2; see `tweenctl seek --help`\n");
}

TEST(Usage, MissingArgumentsAreNamed) {
  EXPECT_EQ(complaint({"seek"}), "tweenctl: TIME is required; see `tweenctl seek --help`\n");
  EXPECT_EQ(complaint({"keyframe", "add"}),
            "tweenctl: nothing to send: expected one of --capture, --vertices, --pose, --weights\n");
  EXPECT_EQ(complaint({"set"}), "tweenctl: nothing to send: expected one of --speed, --loop, --range\n");
  EXPECT_EQ(complaint({"add", "box"}), "tweenctl: nothing to send: expected one of --asset, --mesh, --skeleton\n");
}

TEST(Usage, WrongValuesSayWhatWasExpected) {
  EXPECT_EQ(complaint({"seek", "now"}), "tweenctl: TIME: expected a number, found 'now'\n");
  EXPECT_EQ(complaint({"camera", "--eye", "1,2"}), "tweenctl: --eye: expected 3 numbers separated by commas, found '1,2'\n");
  EXPECT_EQ(complaint({"play", "--loop", "on"}), "tweenctl: --loop: expected one of once, repeat, ping_pong, found 'on'\n");
  EXPECT_EQ(complaint({"apply", "/no/such"}), "tweenctl: FILE: can't read /no/such: No such file or directory\n");
  EXPECT_EQ(complaint({"call", "a.b", "7"}), "tweenctl: 7: expected a JSON object\n");
  EXPECT_EQ(complaint({"call", "a.b", "x"}), "tweenctl: x: expected a JSON object\n");
  EXPECT_EQ(complaint({"--server", "::1", "ping"}).rfind("tweenctl: expected a server as ADDR:PORT, found '::1'", 0), 0U);
  EXPECT_EQ(complaint({"--timeout", "0", "ping"}), "tweenctl: --timeout: expected more than 0 seconds\n");
}

TEST(Usage, SomeOptionsExcludeOthers) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"camera", "--fit", "--eye", "0,0,1"},
                                             {"clip", "update", "c", "--open", "--closed"},
                                             {"step", "--seconds", "1", "--keyframes", "1"},
                                             {"seek", "1", "--actor", "a", "--actor", "b"}}) {
    EXPECT_NE(complaint(arguments).find("see `tweenctl "), std::string::npos);
  }
}

TEST(Usage, WordsThatAreCommandsMayBeNames) {
  const auto run = test::run_cli({test::answers("actor.remove", {{"actor", "play"}}, {{"revision", 1}})}, {"remove", "play"});
  EXPECT_EQ(run.out, "actor play removed (revision 1)\n");
}

}  // namespace
}  // namespace tweend::cli
