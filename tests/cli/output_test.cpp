// What people read.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

/// The output of one command where the server answers with this result.
std::string output(std::vector<std::string> arguments, const std::string& method, const char* params, const char* result) {
  const auto run = test::run_cli({test::answers(method, Json::parse(params), Json::parse(result))}, std::move(arguments));
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_EQ(run.err, "");
  return run.out;
}

constexpr const char* kPlayer = R"({"actor":"box","clip":"walk","playing":true,"time":1.25,"speed":1,"loop":"repeat",
                                    "range":[0,4],"duration":4})";

std::string players() { return std::string(R"({"players":[)") + kPlayer + R"(],"server_time_us":1})"; }

std::string scene() {
  return std::string(R"({"scene":"main","revision":12,"actors":[{"actor":"box","source":{"asset":"walk.obj"},
    "transform":{"translation":[0,0,0]},"interpolation":null,"player":)") +
         kPlayer + R"(,"clips":[{"clip":"walk","type":"vertex","keyframes":5,"duration":4,"closed":false}],"joints":[],
    "vertices":8,"triangles":12}],"camera":{"eye":[0,2,10]},"light":{"ambient":0.2}})";
}

TEST(Output, PlayersAreATable) {
  EXPECT_EQ(output({"status"}, "playback.get", "{}", players().c_str()),
            "actor  clip  state    time  duration  speed  loop    range\n"
            "box    walk  playing  1.25         4      1  repeat  0, 4\n");
  EXPECT_EQ(output({"status"}, "playback.get", "{}", R"({"players":[]})"), "no actors\n");
}

TEST(Output, EditsAreASentenceWithTheRevision) {
  EXPECT_EQ(output({"keyframe", "add", "--capture"}, "keyframe.add", R"({"capture":true})",
                   R"({"keyframe":3,"index":1,"time":2.5,"revision":9})"),
            "keyframe 3 added at 2.5 s (revision 9)\n");
  EXPECT_EQ(output({"undo"}, "edit.undo", "{}", R"({"revision":4,"undone":"actor.add"})"), "actor.add undone (revision 4)\n");
  EXPECT_EQ(
      output({"export", "a.glb"}, "asset.export", R"({"name":"a.glb","format":"glb"})", R"({"name":"a.glb","bytes":1200})"),
      "a.glb saved: 1200 bytes\n");
  EXPECT_EQ(output({"record", "start", "a.mp4"}, "record.start", R"({"name":"a.mp4"})", R"({"record":3,"start_us":17})"),
            "recording 3 to a.mp4: `record stop 3` ends it\n");
  EXPECT_EQ(output({"record", "stop", "3"}, "record.stop", R"({"record":3})", R"({"name":"a.mp4","frames":90,"bytes":1200})"),
            "a.mp4 saved: 90 pictures, 1200 bytes\n");
  EXPECT_EQ(output({"remove", "box"}, "actor.remove", R"({"actor":"box"})", R"({"revision":5})"),
            "actor box removed (revision 5)\n");
  EXPECT_EQ(output({"add", "box", "--asset", "a.obj"}, "actor.add", R"({"actor":"box","asset":"a.obj"})",
                   R"({"actor":"box","clips":["default"],"vertices":8,"joints":0,"revision":6})"),
            "actor box added: 8 vertices, 0 joints, clips default (revision 6)\n");
}

TEST(Output, ListsAreTables) {
  EXPECT_EQ(output({"assets"}, "asset.list", "{}", R"({"assets":[{"name":"a.obj","type":"obj","bytes":1200}]})"),
            "name   type  bytes\na.obj  obj    1200\n");
  EXPECT_EQ(output({"scenes"}, "scene.list", "{}", R"({"scenes":["main","two"]})"), "main\ntwo\n");
  EXPECT_EQ(output({"keyframe", "list"}, "keyframe.list", "{}",
                   R"({"keyframes":[{"keyframe":1,"time":0,"interpolation":"linear"}],"duration":0,"closed":true})"),
            "keyframe  time  interpolation\n       1     0  linear\nduration 0 s, closed\n");
  EXPECT_EQ(output({"stats"}, "server.stats", "{}", R"({"scenes":1,"net":{"bytes":2}})"),
            "figure     value\nscenes         1\nnet.bytes      2\n");
  EXPECT_EQ(output({"record", "list"}, "record.list", "{}", R"({"recordings":[{"recording":3,"name":"a.mp4","fps":30}]})"),
            "recording  name   fps\n        3  a.mp4   30\n");
  EXPECT_EQ(output({"record", "list"}, "record.list", "{}", R"({"recordings":[]})"), "no recordings\n");
  EXPECT_EQ(output({"--json", "record", "list"}, "record.list", "{}", R"({"recordings":[]})"), "{\"recordings\":[]}\n");
}

TEST(Output, DurationsAreSummedUp) {
  const char* stats = R"({"scenes":1,"a_count":7,
    "d_bucket{le=\"+Inf\"}":200,"d_bucket{le=\"0.002\"}":10,"d_bucket{le=\"0.01\"}":200,"d_bucket{le=\"1e-03\"}":0,
    "d_sum":1.5,"d_count":200,
    "e_bucket{le=\"0.5\"}":3,"e_bucket{le=\"+Inf\"}":4,"e_sum":9,"e_count":4,
    "f_bucket{le=\"0.5\"}":0,"f_bucket{le=\"+Inf\"}":0,"f_sum":0,"f_count":0})";
  // Of d: the 100th is the 90th of 190 between 2 and 10 ms, and the 198th the 188th. Of e: the 2nd is the 2nd of 3 up to 500
  // ms.
  EXPECT_EQ(output({"stats"}, "server.stats", "{}", stats),
            "figure   value\n"
            "scenes       1\n"
            "a_count      7\n"
            "\n"
            "duration  count  median ms  p99 ms\n"
            "d           200       5.79  9.92\n"
            "e             4     333.33  > 500\n"
            "f             0          -  -\n");
  EXPECT_EQ(Json::parse(output({"--json", "stats"}, "server.stats", "{}", stats)), Json::parse(stats));
}

TEST(Output, NamesAreOneALine) {
  const std::string s = scene();
  EXPECT_EQ(output({"actors", "--names"}, "scene.describe", "{}", s.c_str()), "box\n");
  EXPECT_EQ(output({"clips", "--names"}, "scene.describe", "{}", s.c_str()), "walk\n");
  EXPECT_EQ(output({"scenes", "--names"}, "scene.list", "{}", R"({"scenes":[{"scene":"main"},{"scene":"two"}]})"),
            "main\ntwo\n");
  EXPECT_EQ(output({"assets", "--names"}, "asset.list", "{}", R"({"assets":[{"name":"a b.obj"}]})"), "a b.obj\n");
}

TEST(Output, ASceneIsAPage) {
  EXPECT_EQ(output({"scene", "show"}, "scene.describe", "{}", scene().c_str()),
            "scene main, revision 12, 1 actor\n"
            "camera: eye (0, 2, 10)\n"
            "light: ambient 0.2\n"
            "\n"
            "actor  source          vertices  triangles  joints  interpolation  transform\n"
            "box    asset walk.obj         8         12       0              -  translation (0, 0, 0)\n"
            "\n"
            "actor  clip  state    time  duration  speed  loop    range\n"
            "box    walk  playing  1.25         4      1  repeat  0, 4\n"
            "\n"
            "actor  clip  type    keyframes  duration  closed\n"
            "box    walk  vertex          5         4  no\n");
}

TEST(Output, CameraAndLightWithoutOptionsAreShown) {
  const std::string s = scene();
  EXPECT_EQ(output({"camera"}, "scene.describe", "{}", s.c_str()), "eye (0, 2, 10) (revision 12)\n");
  EXPECT_EQ(output({"light", "--json"}, "scene.describe", "{}", s.c_str()), "{\"light\":{\"ambient\":0.2},\"revision\":12}\n");
}

TEST(Output, VerticesAreCountedAndBounded) {
  EXPECT_EQ(output({"vertices", "--rows", "1"}, "vertices.sample", "{}",
                   R"({"time":1.5,"count":2,"positions":[0,0,0,1,-2,3],"normals":[0,1,0,0,1,0],"indices":[0,1,0]})"),
            "2 vertices at 1.5 s, (0, -2, 0) to (1, 0, 3)\n"
            "1 triangles\n"
            "vertex  x  y  z  nx  ny  nz\n"
            "     0  0  0  0   0   1   0\n");
}

TEST(Output, ServersIntroduceThemselves) {
  EXPECT_EQ(output({"info"}, "server.hello", "{}",
                   R"({"server":"tweend","version":"0.1.0","protocol":1,"role":"admin","capabilities":["vertices"]})"),
            "tweend 0.1.0, protocol 1; your role is admin; capabilities: vertices\n");
}

TEST(Output, JsonIsWhatTheServerSentInItsOrder) {
  EXPECT_EQ(output({"--json", "status"}, "playback.get", "{}", R"({"z":1,"a":[1.5,"x"]})"), "{\"z\":1,\"a\":[1.5,\"x\"]}\n");
}

TEST(Output, PingTellsTheQuickestOfAFewQuestions) {
  const std::vector<test::Reaction> script(3, test::answers("server.ping", Json::object(), {{"time_us", 5}}));
  const auto people = test::run_cli(script, {"ping", "--count", "2"});
  EXPECT_NE(people.out.find(" ms (quickest of 2); its clock is -"), std::string::npos) << people.out;
  const Json json = Json::parse(test::run_cli(script, {"--json", "ping", "--count", "2"}).out);
  EXPECT_EQ(json.at("time_us"), 5);
  EXPECT_GE(json.at("round_trip_us").get<int>(), 0);
  EXPECT_LT(json.at("offset_us").get<std::int64_t>(), 0);
}

}  // namespace
}  // namespace tweend::cli
