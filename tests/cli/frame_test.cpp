#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/child_process.hpp"
#include "tests/cli/pictures.hpp"
#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using test::Folder;
using test::run_alone;
using test::run_cli;

Json rendered(std::string_view format, std::string_view base64) {
  return {{"time", 0.5}, {"width", 640}, {"height", 360}, {"format", format}, {"base64", base64}};
}

test::Reaction renders_png(Json params = Json::object()) {
  params["format"] = "png";
  return test::answers("frame.render", params, rendered("png", test::kPngBase64));
}

TEST(Frame, RefusesOtherExtensionsBeforeAsking) {
  for (const std::string file : {"out.gif", "out", "png", "out.png.txt", ""}) {
    const auto run = run_alone({"frame", file});
    EXPECT_EQ(run.code, ExitCode::Usage);
    EXPECT_EQ(run.err,
              "tweenctl: FILE: expected a name that ends with .png or with .jpg or .jpeg, or - for PNG on standard output, "
              "found '" +
                  file + "'\n");
  }
}

TEST(Frame, RefusesWhatContradictsItself) {
  EXPECT_EQ(run_alone({"--json", "frame", "-"}).code, ExitCode::Usage);
  EXPECT_EQ(run_alone({"frame", "a.png", "--size", "640"}).err,
            "tweenctl: --size: expected WIDTHxHEIGHT in pixels, as 640x360, found '640'\n");
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{{"--size", "6x4", "--width", "6"},
                                                                                       {"--size", "6x4", "--height", "4"},
                                                                                       {"--size", "6x-4"},
                                                                                       {"--size", "6x4x2"},
                                                                                       {"--fit", "--eye", "0,0,1"},
                                                                                       {"--distance", "1", "--orbit", "0,0"}}) {
    std::vector<std::string> arguments{"frame", "a.png"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run_alone(arguments).code, ExitCode::Usage) << options.front();
  }
}

TEST(Frame, StoresThePictureAndSaysSo) {
  const Folder folder;
  const auto run = run_cli({renders_png()}, {"frame", folder.path("a.png")});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_EQ(run.out, folder.path("a.png") + ": 640 x 360, 67 B, at 0.5 s\n");
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(folder.read("a.png"), test::png());
  EXPECT_EQ(folder.list(), "a.png,");
}

TEST(Frame, ReplacesAFile) {
  const Folder folder;
  const auto jpeg = test::answers("frame.render", {{"format", "jpeg"}}, rendered("jpeg", "/9j/4A=="));
  for (const char* name : {"a.jpg", "b.JPEG", "a.jpg"}) {
    EXPECT_EQ(run_cli({jpeg}, {"frame", folder.path(name)}).code, ExitCode::Done) << name;
  }
  EXPECT_EQ(folder.list(), "a.jpg,b.JPEG,");
  EXPECT_EQ(folder.read("a.jpg"), "\xFF\xD8\xFF\xE0");
}

TEST(Frame, AsksForWhatTheOptionsSay) {
  const Folder folder;
  const auto asks = [&](std::vector<std::string> options, const char* params) {
    options.insert(options.begin(), {"frame", folder.path("a.png")});
    EXPECT_EQ(run_cli({renders_png(Json::parse(params))}, options).code, ExitCode::Done);
  };
  asks({"--scene", "two", "--time", "0.5", "--size", "640x360", "--quality", "70"},
       R"({"scene":"two","time":0.5,"width":640,"height":360,"quality":70})");
  asks({"--width", "64", "--height", "32"}, R"({"width":64,"height":32})");
  asks({"--eye", "0,1,9", "--target", "0,1,0", "--fov-y", "0.8"}, R"({"camera":{"eye":[0,1,9],"target":[0,1,0],"fov_y":0.8}})");
  asks({"--orbit", "1,0.5,9", "--target", "0,1,0"},
       R"({"camera":{"orbit":{"azimuth":1,"elevation":0.5,"distance":9,"target":[0,1,0]}}})");
  asks({"--azimuth", "1", "--elevation", "-0.5", "--distance", "3"},
       R"({"camera":{"orbit":{"azimuth":1,"elevation":-0.5,"distance":3}}})");
  asks({"--fit"}, R"({"camera":{"fit":true}})");
}

TEST(Frame, WritesNothingButThePictureToStandardOutput) {
  const auto run = run_cli({renders_png()}, {"frame", "-"});
  EXPECT_EQ(run.code, ExitCode::Done);
  EXPECT_EQ(run.out, test::png());
  EXPECT_EQ(run.err, "");
}

TEST(Frame, TellsProgramsWhereThePictureIs) {
  const Folder folder;
  const std::string file = folder.path("a.png");
  EXPECT_EQ(Json::parse(run_cli({renders_png()}, {"--json", "frame", file}).out),
            (Json{{"time", 0.5}, {"width", 640}, {"height", 360}, {"format", "png"}, {"file", file}, {"bytes", 67}}));
}

TEST(Frame, NeverStoresWhatIsNoPicture) {
  const Folder folder;
  const auto complaint = [&](std::string_view base64) {
    const auto answer = test::answers("frame.render", {{"format", "png"}}, rendered("png", base64));
    const auto run = run_cli({answer}, {"frame", folder.path("a.png")});
    EXPECT_EQ(run.code, ExitCode::NoServer);
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  EXPECT_EQ(
      complaint(""),
      "tweenctl: frame.render sent no png picture: expected bytes that start with 89 50 4e 47 0d 0a 1a 0a, found nothing\n");
  EXPECT_EQ(complaint("/9j/4A=="),
            "tweenctl: frame.render sent no png picture: expected bytes that start with 89 50 4e 47 0d 0a 1a 0a, found 4 bytes "
            "that start with ff d8 ff e0\n");
  EXPECT_EQ(complaint("abc"),
            "tweenctl: frame.render sent a broken picture: expected base64 with padding, a multiple of 4 characters, found 3 "
            "characters\n");
  EXPECT_EQ(folder.list(), "");
}

TEST(Frame, ARefusalLeavesTheFileAlone) {
  const Folder folder;
  const Json error{{"code", -32004},
                   {"message", "a limit was reached"},
                   {"data", {{"kind", "limit"}, {"path", "params.width"}, {"message", "expected at most 4096, found 9000"}}}};
  const auto run = run_cli({{"frame.render", {{"width", 9000}, {"format", "png"}}, test::refusal(error)}},
                           {"frame", folder.path("a.png"), "--width", "9000"});
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.err, "tweenctl: frame.render refused (limit, params.width): expected at most 4096, found 9000\n");
  EXPECT_EQ(folder.list(), "");
}

TEST(Frame, SaysWhyItCantBeStored) {
  const Folder folder;
  std::filesystem::create_directory(folder.path("taken.png"));
  const auto complaint = [&](const std::string& name) {
    const auto run = run_cli({renders_png()}, {"frame", folder.path(name)});
    EXPECT_EQ(run.code, ExitCode::Refused);
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  EXPECT_EQ(complaint("no/a.png"), "tweenctl: can't write " + folder.path("no/a.png") +
                                       ": expected a place for 67 B, found: No such file or directory\n");
  EXPECT_EQ(complaint("taken.png"),
            "tweenctl: can't write " + folder.path("taken.png") + ": expected a place for 67 B, found: Is a directory\n");
  EXPECT_EQ(folder.list(), "taken.png,");
}

TEST(Frame, AFullDiskLeavesNothingBehind) {
  const Folder folder;
  test::FakeServer server({renders_png()});
  // No file may grow past 0 blocks, which write() then tells as a full disk would.
  auto command = test::tweenctl(server, {"frame", folder.path("a.png")});
  command.insert(command.begin(), {"bash", "-c", R"(trap '' XFSZ; ulimit -f 0; exec "$@" 2>&1)", "bash"});
  test::ChildProcess child(command);
  EXPECT_EQ(child.read_all(),
            "tweenctl: can't write " + folder.path("a.png") + ": expected a place for 67 B, found: File too large\n");
  EXPECT_EQ(child.wait(), 1);
  EXPECT_EQ(folder.list(), "");
}

}  // namespace
}  // namespace tweend::cli
