#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/cli/child_process.hpp"
#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

const std::string& bash_script() {
  static const std::string script = test::run_alone({"completion", "bash"}).out;
  return script;
}

/// What bash offers for a line, the cursor at its end. Questions to the server are answered by the question itself.
std::vector<std::string> complete(const std::string& line) {
  test::ChildProcess bash({"bash", "--norc", "-c", R"(
    source /dev/stdin
    tweenctl() { local IFS=_; printf '%s\n' "ask_$*" 'b c'; }
    COMP_LINE=$1 COMP_POINT=${#1}
    _tweenctl tweenctl
    [[ ${#COMPREPLY[@]} -eq 0 ]] || printf '%s\n' "${COMPREPLY[@]}")",
                           "bash", line},
                          bash_script());
  std::istringstream lines(bash.read_all());
  EXPECT_EQ(bash.wait(), 0);
  std::vector<std::string> words;
  for (std::string word; std::getline(lines, word);) words.push_back(word);
  return words;
}

TEST(Completion, IsValidBash) { EXPECT_EQ(test::ChildProcess({"bash", "-n"}, bash_script()).wait(), 0); }

TEST(Completion, OffersCommands) {
  EXPECT_THAT(complete("tweenctl "), AllOf(Contains("play"), Contains("keyframe"), Not(Contains("--json"))));
  EXPECT_THAT(complete("tweenctl pl"), ElementsAre("play"));
  EXPECT_THAT(complete("tweenctl keyframe "), UnorderedElementsAre("add", "update", "move", "remove", "list"));
  EXPECT_THAT(complete("tweenctl --server 127.0.0.1:1 --json cli"), UnorderedElementsAre("clips", "clip"));
}

TEST(Completion, OffersOptions) {
  EXPECT_THAT(complete("tweenctl camera --f"), UnorderedElementsAre("--fov-y", "--far", "--fit"));
  EXPECT_THAT(complete("tweenctl seek 1 --s"), UnorderedElementsAre("--server", "--scene"));
  EXPECT_THAT(complete("tweenctl --v"), ElementsAre("--version"));
}

TEST(Completion, OffersTheWordsOfAnOption) {
  EXPECT_THAT(complete("tweenctl play --loop "), ElementsAre("once", "repeat", "ping_pong"));
  EXPECT_THAT(complete("tweenctl play --loop=p"), ElementsAre("ping_pong"));
  EXPECT_THAT(complete("tweenctl keyframe update 3 --easing "), ElementsAre("none"));
  EXPECT_THAT(complete("tweenctl export a --format "), ElementsAre("glb", "obj_sequence"));
  EXPECT_THAT(complete("tweenctl watch vertices --encoding "), ElementsAre("f32", "q16", "meshopt"));
  EXPECT_THAT(complete("tweenctl watch frames --delivery "), ElementsAre("latest", "every"));
  EXPECT_THAT(complete("tweenctl seek "), IsEmpty());
}

TEST(Completion, AsksTheServerForNames) {
  EXPECT_THAT(complete("tweenctl --server h:1 play --actor "),
              ElementsAre("ask_--timeout_1_--server_h:1_actors_--names", "b\\ c"));
  EXPECT_THAT(complete("tweenctl add box --asset "), Contains("ask_--timeout_1_assets_--names"));
  EXPECT_THAT(complete("tweenctl remove "), Contains("ask_--timeout_1_actors_--names"));
  EXPECT_THAT(complete("tweenctl clip update "), Contains("ask_--timeout_1_clips_--names"));
  EXPECT_THAT(complete("tweenctl play --scene=two --clip "), Contains("ask_--timeout_1_--scene=two_clips_--names"));
  EXPECT_THAT(complete("tweenctl --scene "), Contains("ask_--timeout_1_scenes_--names"));
}

TEST(Completion, AsksTheServerForMethodsAndTheirParameters) {
  EXPECT_THAT(complete("tweenctl call "), Contains("ask_--timeout_1_methods_--names"));
  EXPECT_THAT(complete("tweenctl call playback.seek "), Contains("ask_--timeout_1_methods_playback.seek_--names="));
  EXPECT_THAT(complete("tweenctl call playback.seek time=1 b"), ElementsAre("b c="));
}

TEST(Completion, KnowsThePictures) {
  EXPECT_THAT(complete("tweenctl watch "), UnorderedElementsAre("vertices", "pose", "frames"));
  EXPECT_THAT(complete("tweenctl watch frames --encoding "), ElementsAre("jpeg", "png", "h264", "rgba"));
  EXPECT_THAT(complete("tweenctl watch frames --o"), UnorderedElementsAre("--out", "--orbit"));
  EXPECT_THAT(complete("tweenctl frame a.png --el"), ElementsAre("--elevation"));
}

TEST(Completion, OffersFilesAndFolders) {
  EXPECT_THAT(complete("tweenctl apply /proc/self/cmd"), ElementsAre("/proc/self/cmdline"));
  EXPECT_THAT(complete("tweenctl watch frames -o /proc/self/fdi"), ElementsAre("/proc/self/fdinfo"));
  EXPECT_THAT(complete("tweenctl watch frames --out=/proc/self/cmd"), ElementsAre("/proc/self/cmdline"));
}

}  // namespace
}  // namespace tweend::cli
