// What each command asks of the server.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <ostream>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

struct Case {
  std::vector<std::string> arguments;
  std::string method;
  const char* params;  ///< JSON
  std::string in;
};

void PrintTo(const Case& c, std::ostream* out) {  // NOLINT(readability-identifier-naming): GoogleTest's name
  for (const auto& argument : c.arguments) *out << argument << ' ';
}

class Requests : public testing::TestWithParam<Case> {};

TEST_P(Requests, SendWhatTheArgumentsSay) {
  const Case& c = GetParam();
  auto arguments = c.arguments;
  arguments.insert(arguments.begin(), "--json");
  const auto run = test::run_cli({test::answers(c.method, Json::parse(c.params), {{"fine", true}})}, arguments, c.in);
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_EQ(run.out, "{\"fine\":true}\n");
}

INSTANTIATE_TEST_SUITE_P(Server, Requests,
                         testing::Values(Case{{"info"}, "server.hello", "{}", {}}, Case{{"stats"}, "server.stats", "{}", {}},
                                         Case{{"assets"}, "asset.list", "{}", {}}));

INSTANTIATE_TEST_SUITE_P(
    Scenes, Requests,
    testing::Values(
        Case{{"scenes"}, "scene.list", "{}", {}}, Case{{"actors"}, "scene.describe", "{}", {}},
        Case{{"clips", "--scene", "two"}, "scene.describe", R"({"scene":"two"})", {}},
        Case{{"scene", "create", "two", "--retry-key", "k"}, "scene.create", R"({"scene":"two","retry_key":"k"})", {}},
        Case{{"scene", "remove", "two"}, "scene.remove", R"({"scene":"two"})", {}},
        Case{{"scene", "show"}, "scene.describe", "{}", {}},
        Case{{"--scene", "x", "scene", "show", "two"}, "scene.describe", R"({"scene":"two"})", {}},
        Case{{"scene", "update", "two", "--background", "0,0.5,1", "--no-grid", "--retry-key", "k"},
             "scene.update",
             R"({"scene":"two","background":[0,0.5,1],"grid":false,"retry_key":"k"})",
             {}}));

INSTANTIATE_TEST_SUITE_P(
    Actors, Requests,
    testing::Values(
        Case{{"add", "man", "--skeleton", "-"},
             "actor.add",
             R"({"actor":"man","skeleton":{"joints":[{"name":"hip"}]}})",
             R"({"joints":[{"name":"hip"}]})"},
        Case{{"actor", "update", "man", "--show-skeleton"}, "actor.update", R"({"actor":"man","show_skeleton":true})", {}},
        Case{{"actor", "update", "--hide-skeleton"}, "actor.update", R"({"show_skeleton":false})", {}},
        Case{{"add", "box", "--asset", "a/walk", "--fps", "12", "--closed", "--duration", "2"},
             "actor.add",
             R"({"actor":"box","asset":"a/walk","fps":12,"closed":true,"duration":2})",
             {}},
        Case{{"--scene", "two", "add", "box", "--mesh", "-", "--translation", "-1,2,-.5", "--scale", "2", "--interpolation",
              "step"},
             "actor.add",
             R"({"scene":"two","actor":"box","mesh":{"positions":[0]},"interpolation":"step",
                 "transform":{"translation":[-1,2,-0.5],"scale":[2,2,2]}})",
             R"({"positions":[0]})"},
        Case{{"remove", "box", "--base-revision", "7"}, "actor.remove", R"({"actor":"box","base_revision":7})", {}},
        Case{{"actor", "update", "--rotation", "0,0,0,1", "--spin", "-1.5", "--hidden", "--interpolation", "none"},
             "actor.update",
             R"({"transform":{"rotation":[0,0,0,1]},"spin":-1.5,"visible":false,"interpolation":null})",
             {}},
        Case{{"actor", "update", "box", "--visible", "--rotate-y", "0"},
             "actor.update",
             R"({"actor":"box","visible":true,"transform":{"rotation":[0,0,0,1]}})",
             {}}));

INSTANTIATE_TEST_SUITE_P(
    Exports, Requests,
    testing::Values(
        Case{{"export", "a/b.glb", "--actor", "box"}, "asset.export", R"({"name":"a/b.glb","actor":"box","format":"glb"})", {}},
        Case{{"export", "walk"}, "asset.export", R"({"name":"walk","format":"obj_sequence"})", {}},
        Case{{"export", "walk", "--format", "glb", "--scene", "two"},
             "asset.export",
             R"({"name":"walk","format":"glb","scene":"two"})",
             {}}));

INSTANTIATE_TEST_SUITE_P(
    Recordings, Requests,
    testing::Values(Case{{"record", "start", "a.mp4", "--size", "640x360", "--fps", "29.97"},
                         "record.start",
                         R"({"name":"a.mp4","width":640,"height":360,"fps":29.97})",
                         {}},
                    Case{{"--scene", "two", "record", "start", "walk", "--eye", "0,0,5", "--width", "33"},
                         "record.start",
                         R"({"scene":"two","name":"walk","format":"png_sequence","width":33,"camera":{"eye":[0,0,5]}})",
                         {}},
                    Case{{"record", "start", "walk.avi"}, "record.start", R"({"name":"walk.avi"})", {}},
                    Case{{"record", "start", "walk.1", "--format", "png_sequence"},
                         "record.start",
                         R"({"name":"walk.1","format":"png_sequence"})",
                         {}},
                    Case{{"record", "list"}, "record.list", "{}", {}},
                    Case{{"record", "stop", "3"}, "record.stop", R"({"record":3})", {}}));

INSTANTIATE_TEST_SUITE_P(
    Keyframes, Requests,
    testing::Values(Case{{"keyframe", "add", "--capture"}, "keyframe.add", R"({"capture":true})", {}},
                    Case{{"keyframe", "add", "--pose", R"({"hip":{"rotation":[0,0,0,1]}})", "--sparse", "--interpolation",
                          "cubic"},
                         "keyframe.add",
                         R"({"pose":{"hip":{"rotation":[0,0,0,1]}},"sparse":true,"interpolation":"cubic"})",
                         {}},
                    Case{{"keyframe", "update", "7", "--pose", "@-", "--weights", "0,.5"},
                         "keyframe.update",
                         R"({"keyframe":7,"pose":{"hip":{"scale":[1,1,1]}},"weights":[0,0.5]})",
                         R"({"hip":{"scale":[1,1,1]}})"},
                    Case{{"keyframe", "add", "--actor", "a", "--clip", "c", "--time", "1.5", "--vertices", "-",
                          "--interpolation", "linear", "--easing", "0.4,0,.2,1"},
                         "keyframe.add",
                         R"({"actor":"a","clip":"c","time":1.5,"vertices":{"positions":[1,2,3]},"interpolation":"linear",
                             "easing":[0.4,0,0.2,1]})",
                         R"({"positions":[1,2,3]})"},
                    Case{{"keyframe", "update", "3", "--easing", "none", "--interpolation", "none", "--time", "2"},
                         "keyframe.update",
                         R"({"keyframe":3,"easing":null,"interpolation":null,"time":2})",
                         {}},
                    Case{{"keyframe", "move", "3", "0.25", "--actor", "a"},
                         "keyframe.move",
                         R"({"keyframe":3,"time":0.25,"actor":"a"})",
                         {}},
                    Case{{"keyframe", "remove", "3"}, "keyframe.remove", R"({"keyframe":3})", {}},
                    Case{{"keyframe", "list", "--clip", "c"}, "keyframe.list", R"({"clip":"c"})", {}}));

INSTANTIATE_TEST_SUITE_P(Clips, Requests,
                         testing::Values(Case{{"clip", "create", "cue", "--keys", "3,1,2", "--duration", "4", "--type",
                                               "vertex", "--closed"},
                                              "clip.create",
                                              R"({"clip":"cue","keys":[3,1,2],"duration":4,"type":"vertex","closed":true})",
                                              {}},
                                         Case{{"clip", "update", "cue", "--open", "--duration", "none", "--actor", "a"},
                                              "clip.update",
                                              R"({"clip":"cue","closed":false,"duration":null,"actor":"a"})",
                                              {}},
                                         Case{{"clip", "remove", "cue"}, "clip.remove", R"({"clip":"cue"})", {}}));

INSTANTIATE_TEST_SUITE_P(
    Edits, Requests,
    testing::Values(Case{{"undo"}, "edit.undo", "{}", {}},
                    Case{{"redo", "--scene", "two"}, "edit.redo", R"({"scene":"two"})", {}},
                    Case{{"apply", "-", "--base-revision", "2"},
                         "edit.apply",
                         R"({"edits":[{"method":"actor.remove","params":{"actor":"a"}}],"base_revision":2})",
                         R"([{"method":"actor.remove","params":{"actor":"a"}}])"}));

INSTANTIATE_TEST_SUITE_P(
    Playback, Requests,
    testing::Values(Case{{"play"}, "playback.play", "{}", {}},
                    Case{{"play", "--clip", "c", "--time", "1", "--speed", "-1", "--loop", "ping_pong", "--actor", "a"},
                         "playback.play",
                         R"({"clip":"c","time":1,"speed":-1,"loop":"ping_pong","actor":"a"})",
                         {}},
                    Case{{"pause", "--actor", "a"}, "playback.pause", R"({"actor":"a"})", {}},
                    Case{{"stop"}, "playback.stop", "{}", {}}, Case{{"seek", "-1"}, "playback.seek", R"({"time":-1})", {}},
                    Case{{"seek", "-.5"}, "playback.seek", R"({"time":-0.5})", {}},
                    Case{{"seek", "--", "-1e-3"}, "playback.seek", R"({"time":-0.001})", {}},
                    Case{{"step"}, "playback.step", R"({"keyframes":1})", {}},
                    Case{{"step", "--keyframes", "-2"}, "playback.step", R"({"keyframes":-2})", {}},
                    Case{{"step", "--seconds=-0.25"}, "playback.step", R"({"seconds":-0.25})", {}},
                    Case{{"set", "--range", "0.5,2", "--loop", "once", "--speed", "2"},
                         "playback.set",
                         R"({"range":[0.5,2],"loop":"once","speed":2})",
                         {}},
                    Case{{"status"}, "playback.get", "{}", {}},
                    Case{{"play", "--clip", "c", "--fade", "0.5", "--at", "123456789", "--late", "error"},
                         "playback.play",
                         R"({"clip":"c","fade":0.5,"at_us":123456789,"late":"error"})",
                         {}},
                    Case{{"queue", "walk:3", "idle:1:0.4", "stand", "--actor", "a", "--at", "5"},
                         "playback.queue",
                         R"({"actor":"a","at_us":5,"clips":[{"clip":"walk","repeat":3},
                             {"clip":"idle","repeat":1,"fade":0.4},{"clip":"stand"}]})",
                         {}},
                    Case{{"queue", "walk", "--loop", "ping_pong"},
                         "playback.queue",
                         R"({"clips":[{"clip":"walk","loop":"ping_pong"}]})",
                         {}}));

INSTANTIATE_TEST_SUITE_P(
    MarkersLayersSchedules, Requests,
    testing::Values(Case{{"marker", "add", "0.5", "step", "--clip", "walk"},
                         "marker.add",
                         R"({"time":0.5,"name":"step","clip":"walk"})",
                         {}},
                    Case{{"marker", "remove", "7", "--actor", "a"}, "marker.remove", R"({"marker":7,"actor":"a"})", {}},
                    Case{{"layer", "set", "arms", "wave", "--weight", "0.5", "--additive", "--mask", "hand_l,hand_r", "--fade",
                          "0.3"},
                         "layer.set",
                         R"({"layer":"arms","clip":"wave","weight":0.5,"additive":true,"mask":["hand_l","hand_r"],"fade":0.3})",
                         {}},
                    Case{{"layer", "remove", "arms", "--fade", "1"}, "layer.remove", R"({"layer":"arms","fade":1})", {}},
                    Case{{"schedule", "list", "--scene", "two"}, "schedule.list", R"({"scene":"two"})", {}},
                    Case{{"schedule", "cancel", "3"}, "schedule.cancel", R"({"scheduled":3})", {}},
                    Case{{"camera", "--eye", "1,2,3", "--at", "9"}, "camera.set", R"({"eye":[1,2,3],"at_us":9})", {}},
                    Case{{"actor", "update", "--spin", "1", "--at", "9"}, "actor.update", R"({"spin":1,"at_us":9})", {}}));

INSTANTIATE_TEST_SUITE_P(
    Views, Requests,
    testing::Values(Case{{"camera", "--eye", "-1,2,3", "--target", "0,1,0", "--up", "0,1,0", "--fov-y", "0.8", "--near", ".1",
                          "--far", "100"},
                         "camera.set",
                         R"({"eye":[-1,2,3],"target":[0,1,0],"up":[0,1,0],"fov_y":0.8,"near":0.1,"far":100})",
                         {}},
                    Case{{"camera", "--orbit", "-1,0.5,9", "--target", "0,1,0"},
                         "camera.set",
                         R"({"orbit":{"azimuth":-1,"elevation":0.5,"distance":9,"target":[0,1,0]}})",
                         {}},
                    Case{{"camera", "--orbit", "1,0", "--scene", "two"},
                         "camera.set",
                         R"({"scene":"two","orbit":{"azimuth":1,"elevation":0}})",
                         {}},
                    Case{{"camera", "--azimuth", "1", "--elevation", "0.5", "--target", "0,1,0"},
                         "camera.set",
                         R"({"orbit":{"azimuth":1,"elevation":0.5,"target":[0,1,0]}})",
                         {}},
                    Case{{"camera", "--fit"}, "camera.set", R"({"fit":true})", {}},
                    Case{{"light", "--position", "1,2,3", "--ambient", "0.2", "--diffuse", "1", "--specular", "0",
                          "--shininess", "8"},
                         "light.set",
                         R"({"position":[1,2,3],"ambient":0.2,"diffuse":1,"specular":0,"shininess":8})",
                         {}},
                    Case{{"vertices", "--time", "2", "--indices", "--clip", "c", "--actor", "a", "--rows", "1"},
                         "vertices.sample",
                         R"({"time":2,"indices":true,"clip":"c","actor":"a"})",
                         {}}));

INSTANTIATE_TEST_SUITE_P(
    Raw, Requests,
    testing::Values(Case{{"call", "a.b"}, "a.b", "{}", {}}, Case{{"call", "a.b", R"({"x":[1]})"}, "a.b", R"({"x":[1]})", {}},
                    Case{{"call", "a.b", "-"}, "a.b", R"({"x":2})", R"({"x":2})"},
                    Case{{"--scene", "two", "call", "a.b", "actor=box", "time=-2", "range=[0,1]", "on=true", "empty="},
                         "a.b",
                         R"({"scene":"two","actor":"box","time":-2,"range":[0,1],"on":true,"empty":""})",
                         {}}));

}  // namespace
}  // namespace tweend::cli
