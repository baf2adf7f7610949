#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

const Json kDocument = Json::parse(R"({"openrpc":"1.3.2","methods":[
  {"name":"playback.seek","summary":"Move the playhead.","x-role":"control","params":[
    {"name":"actor","schema":{"type":"string","description":"Which actor."}},
    {"name":"time","required":true,"description":"Media seconds.","schema":{"type":"number"}}]},
  {"name":"server.ping","summary":"The clock.","x-role":"view","params":[]}]})");

std::string output(std::vector<std::string> arguments) {
  return test::run_cli({test::answers("rpc.discover", Json::object(), kDocument)}, std::move(arguments)).out;
}

TEST(Methods, AreATable) {
  EXPECT_EQ(output({"methods"}),
            "method         role     summary\n"
            "playback.seek  control  Move the playhead.\n"
            "server.ping    view     The clock.\n");
}

TEST(Methods, OneIsShownWithItsParameters) {
  EXPECT_EQ(output({"methods", "playback.seek"}),
            "playback.seek: Move the playhead.\n"
            "parameter  type    required  meaning\n"
            "actor      string  no        Which actor.\n"
            "time       number  yes       Media seconds.\n");
  EXPECT_EQ(output({"methods", "server.ping"}), "server.ping: The clock.\n");
}

TEST(Methods, NamesServeTheCompletion) {
  EXPECT_EQ(output({"methods", "--names"}), "playback.seek\nserver.ping\n");
  EXPECT_EQ(output({"methods", "playback.seek", "--names"}), "actor\ntime\n");
}

TEST(Methods, JsonIsTheWholeDocument) { EXPECT_EQ(output({"--json", "methods"}), kDocument.dump() + "\n"); }

TEST(Methods, UnknownOnesAreRefused) {
  const auto run = test::run_cli({test::answers("rpc.discover", Json::object(), kDocument)}, {"methods", "a.b"});
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.err, "tweenctl: the server has no method a.b\n");
}

TEST(Call, PrintsForPeopleOrPrograms) {
  const auto script = std::vector{test::answers("a.b", {{"x", 1}}, {{"y", {1, 2}}})};
  EXPECT_EQ(test::run_cli(script, {"call", "a.b", "x=1"}).out, "{\n  \"y\": [\n    1,\n    2\n  ]\n}\n");
  EXPECT_EQ(test::run_cli(script, {"call", "a.b", R"({"x":1})", "--json"}).out, "{\"y\":[1,2]}\n");
}

}  // namespace
}  // namespace tweend::cli
