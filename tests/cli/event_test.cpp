#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using test::answer;
using test::event;
using test::run_cli;

const Json kNothing = Json::object();

Json ended(const char* actor) { return {{"scene", "main"}, {"actor", actor}, {"clip", "walk"}}; }

Json changed(const char* actor) {
  const Json player{{"actor", actor}, {"clip", "walk"}, {"playing", true}, {"time", 0.5}, {"duration", 2.0}};
  return {{"scene", "main"}, {"players", Json::array({player})}, {"server_time_us", 1}};
}

test::Reaction subscribe(const std::string& then, bool closes = false) {
  return {"events.subscribe", kNothing, answer(kNothing) + then, closes};
}

TEST(Events, AreALineEach) {
  const auto run = run_cli({subscribe(event("playback.changed", changed("box")) +
                                      event("scene.changed", {{"scene", "main"}, {"revision", 3}, {"method", "edit.undo"}}))},
                           {"events", "--count", "2"});
  EXPECT_EQ(run.code, ExitCode::Done);
  EXPECT_EQ(run.out,
            "playback.changed  scene main, box walk playing 0.5 of 2 s\n"
            "scene.changed     scene main, revision 3, method edit.undo\n");
}

TEST(Events, OfMarkersNameTheMarkerAndWhere) {
  const Json crossed{{"scene", "main"}, {"actor", "walker"}, {"clip", "walk"}, {"marker", 7},
                     {"name", "left"},  {"time", 0.5},       {"at_us", 123}};
  EXPECT_EQ(run_cli({subscribe(event("marker.crossed", crossed))}, {"events", "--count", "1"}).out,
            "marker.crossed    scene main, walker walk: left at 0.5 s\n");
  EXPECT_EQ(run_cli({subscribe(event("marker.crossed", crossed))}, {"wait", "marker", "--actor", "walker"}).out,
            "marker.crossed    scene main, walker walk: left at 0.5 s\n");
}

TEST(Events, AreObjectsForPrograms) {
  const auto run = run_cli({subscribe(event("playback.ended", ended("box")))}, {"--json", "events", "--count", "1"});
  EXPECT_EQ(run.out, "{\"method\":\"playback.ended\",\"params\":{\"scene\":\"main\",\"actor\":\"box\",\"clip\":\"walk\"}}\n");
}

TEST(Events, BeforeTheAnswerCountToo) {
  const auto run = run_cli({{"events.subscribe", {{"scene", "two"}}, event("playback.ended", ended("box")) + answer(kNothing)}},
                           {"--scene", "two", "events", "--count", "1"});
  EXPECT_EQ(run.out, "playback.ended    scene main, actor box, clip walk\n");
}

TEST(Events, EndWithTheServer) {
  const auto run = run_cli({subscribe(event("playback.ended", ended("box")), true)}, {"events"});
  EXPECT_EQ(run.code, ExitCode::NoServer);
  EXPECT_NE(run.out, "");
  EXPECT_EQ(run.err, "tweenctl: the connection was closed\n");
}

TEST(Wait, IsForItsOwnEvent) {
  const auto run = run_cli({subscribe(event("playback.changed", changed("box")) + event("playback.ended", ended("box")))},
                           {"wait", "ended", "--timeout", "20"});
  EXPECT_EQ(run.code, ExitCode::Done);
  EXPECT_EQ(run.out, "playback.ended    scene main, actor box, clip walk\n");
}

TEST(Wait, MayBeForOneActor) {
  const std::string events = event("playback.ended", ended("a")) + event("playback.ended", ended("b")) +
                             event("playback.changed", changed("a")) + event("playback.changed", changed("b"));
  EXPECT_EQ(run_cli({subscribe(events)}, {"wait", "ended", "--actor", "b"}).out,
            "playback.ended    scene main, actor b, clip walk\n");
  EXPECT_EQ(run_cli({subscribe(events)}, {"wait", "changed", "--actor", "b"}).out,
            "playback.changed  scene main, b walk playing 0.5 of 2 s\n");
}

TEST(Wait, ForAnEdit) {
  EXPECT_EQ(run_cli({subscribe(event("scene.changed", {{"revision", 2}}))}, {"--json", "wait", "edited"}).out,
            "{\"method\":\"scene.changed\",\"params\":{\"revision\":2}}\n");
}

TEST(Wait, GivesUpWithASentence) {
  const auto run = run_cli({subscribe("")}, {"wait", "ended", "--timeout", "0.01"});
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.err, "tweenctl: no playback.ended within 0.01 s\n");
}

TEST(Wait, ALostServerIsNoTimeout) {
  EXPECT_EQ(run_cli({subscribe("", true)}, {"wait", "ended", "--timeout", "20"}).code, ExitCode::NoServer);
}

TEST(Wait, IfPlayingAsksAfterSubscribing) {
  const auto players = [](bool playing) {
    return Json{{"players", Json::array({Json{{"actor", "a"}, {"playing", playing}}})}};
  };
  const auto idle =
      run_cli({subscribe(""), test::answers("playback.get", kNothing, players(false))}, {"wait", "ended", "--if-playing"});
  EXPECT_EQ(idle.code, ExitCode::Done);
  EXPECT_EQ(idle.out, "");
  const auto busy =
      run_cli({subscribe(""), {"playback.get", {{"actor", "a"}}, event("playback.ended", ended("a")) + answer(players(true))}},
              {"wait", "ended", "--if-playing", "--actor", "a"});
  EXPECT_EQ(busy.code, ExitCode::Done);
  EXPECT_EQ(busy.out, "playback.ended    scene main, actor a, clip walk\n");
}

}  // namespace
}  // namespace tweend::cli
