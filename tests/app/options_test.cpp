#include "server/app/options.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tweend::app {
namespace {

struct Parsed {
  CommandLine line;
  std::string out, err;
};

Parsed parse(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "tweend");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  CommandLine line = parse_command_line(static_cast<int>(arguments.size()), argv.data());
  std::string out = testing::internal::GetCapturedStdout();
  return {std::move(line), std::move(out), testing::internal::GetCapturedStderr()};
}

/// Expects a mistake; what was said of it.
std::string mistake(std::vector<std::string> arguments) {
  const std::string shown = testing::PrintToString(arguments);
  const Parsed parsed = parse(std::move(arguments));
  const int* code = std::get_if<int>(&parsed.line);
  EXPECT_TRUE(code != nullptr && *code == 2) << shown;
  EXPECT_EQ(parsed.out, "") << shown;
  EXPECT_NE(parsed.err, "") << shown;
  return parsed.err;
}

std::string rendering_mistake(const std::string& option, const std::string& value) {
  return mistake({"render", "a.obj", option, value});
}

OfflineOptions rendering(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "render");
  const Parsed parsed = parse(std::move(arguments));
  const auto* options = std::get_if<OfflineOptions>(&parsed.line);
  EXPECT_NE(options, nullptr) << parsed.err;
  return options != nullptr ? *options : OfflineOptions{};
}

void says(const std::string& message, const std::string& word) {
  EXPECT_NE(message.find(word), std::string::npos) << "\"" << word << "\" is not in: " << message;
}

TEST(CommandLine, RefusesWhatIsNoCommandAndPrintsHelp) {
  says(mistake({}), "serve");
  mistake({"nonsense"});
  mistake({"--nonsense"});
  mistake({"serve", "doctor"});
  mistake({"doctor", "extra"});
  mistake({"serve", "extra"});
}

TEST(CommandLine, RefusesOptionsOfServeThatAreNone) {
  mistake({"serve", "--nonsense"});
  mistake({"serve", "--listen"});
  mistake({"serve", "--samples", "0"});
  mistake({"serve", "--samples", "17"});
  mistake({"serve", "--samples", "two"});
  mistake({"serve", "--max-scenes", "0"});
  mistake({"serve", "--max-scenes", "-1"});
  mistake({"serve", "--max-frame-side", "4k"});
  mistake({"serve", "--size", "640x480"});
}

TEST(CommandLine, RefusesToRenderNothing) { says(mistake({"render"}), "ASSET"); }

TEST(CommandLine, RefusesSizesThatAreNotTwoWholeNumbersOfPixels) {
  for (const char* size : {"640", "640x", "x480", "x", "640x480x3", "640,480", "640 480", "0x480", "640x0", "-640x480",
                           "640.5x480", "axb", "640x480px", "65536x1", "1x65536", "1e9x1", "nanx1", "infx1", ""}) {
    const std::string said = rendering_mistake("--size", size);
    says(said, "--size");
    says(said, "expected WxH");
  }
  says(mistake({"render", "--size", "640", "480", "a.obj"}), "found \"640\"");
}

TEST(CommandLine, RefusesTimesThatAreNoNumbers) {
  for (const char* times : {"a", "", "0,", ",0", "0,,1", "0;1", "0,1s", "nan", "inf", "1e999", "0 1", "0x10"}) {
    says(rendering_mistake("--at", times), "expected T[,T...]");
  }
  says(rendering_mistake("--at", "0,b,1"), "found \"b\"");
}

TEST(CommandLine, RefusesPlacesThatAreNotThreeNumbers) {
  for (const char* option : {"--eye", "--light"}) {
    for (const char* place : {"1", "1,2", "1,2,3,4", "1,2,c", "1,2,", "1,2,nan", "1,2,1e300", ""}) {
      says(rendering_mistake(option, place), "expected X,Y,Z");
    }
  }
  mistake({"render", "a.obj", "--eye", "1,2,3", "--target", "1,2"});
}

TEST(CommandLine, RefusesOrbitsThatAreNotTwoAngles) {
  for (const char* orbit : {"1", "1,2,3", "1,b", ",", "1,", "nan,0", ""}) {
    says(rendering_mistake("--orbit", orbit), "expected A,E");
  }
}

TEST(CommandLine, RefusesColorsBeyondWhiteAndBlack) {
  for (const char* color : {"1", "0,0", "0,0,1.1", "-0.1,0,0", "0,0,0,1", "red", "nan,0,0"}) {
    says(rendering_mistake("--background", color), "expected R,G,B");
  }
}

TEST(CommandLine, RefusesRatesAndDurationsThatAreNotAboveZero) {
  for (const char* option : {"--fps", "--duration"}) {
    for (const char* value : {"0", "-1", "nan", "inf", "a", "1,2", ""}) says(rendering_mistake(option, value), option);
  }
}

TEST(CommandLine, RefusesInterpolationsThatAreNone) {
  for (const char* modes : {"smooth", "linear,", "Linear", "", "linear step"}) {
    says(rendering_mistake("--interpolation", modes), "expected step, linear, catmull_rom");
  }
}

TEST(CommandLine, RefusesQualitiesAndSamplesOutOfRange) {
  for (const char* quality : {"0", "101", "best"}) says(rendering_mistake("--quality", quality), "--quality");
  for (const char* samples : {"0", "17", "-1"}) says(rendering_mistake("--samples", samples), "--samples");
}

TEST(CommandLine, RefusesTwoPlacesToLookFrom) {
  mistake({"render", "a.obj", "--eye", "1,2,3", "--orbit", "1,2"});
  says(mistake({"render", "a.obj", "--target", "1,2,3"}), "--eye");
}

TEST(CommandLine, EndsAtOnceWhereHelpWasAskedFor) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"serve", "--help"},
                                                    {"render", "--help"},
                                                    {"doctor", "--help"},
                                                    {"render", "-h"}}) {
    const Parsed parsed = parse(arguments);
    ASSERT_TRUE(std::holds_alternative<int>(parsed.line));
    EXPECT_EQ(std::get<int>(parsed.line), 0);
    EXPECT_NE(parsed.out, "");
    EXPECT_EQ(parsed.err, "");
  }
}

TEST(CommandLine, TellsOfTheDefaultsInItsHelp) {
  const std::string help = parse({"render", "--help"}).out;
  for (const char* value : {"1280x720", "30,20", "frame-%04d.png", "catmull_rom", "A,E", "WxH", "T[,T...]"}) says(help, value);
}

TEST(CommandLine, PrintsTheVersion) {
  const Parsed parsed = parse({"--version"});
  EXPECT_EQ(std::get<int>(parsed.line), 0);
  EXPECT_EQ(parsed.out, "tweend " TWEEND_VERSION "\n");
}

TEST(CommandLine, ListsTheCommands) {
  const Parsed parsed = parse({"--list-commands"});
  EXPECT_EQ(std::get<int>(parsed.line), 0);
  says(parsed.out, "actor.add\tcontrol\t");
  says(parsed.out, "frame.render\tview\t");
}

TEST(CommandLine, AsksTheDoctor) { EXPECT_TRUE(std::holds_alternative<DoctorOptions>(parse({"doctor"}).line)); }

TEST(CommandLine, ServesByDefaultOnLoopback) {
  const Parsed parsed = parse({"serve"});
  const ServeOptions options = std::get<ServeOptions>(parsed.line);
  EXPECT_EQ(options.listen, "127.0.0.1:8933");
  EXPECT_FALSE(options.no_auth);
  EXPECT_FALSE(options.play);
  EXPECT_FALSE(options.render.off);
  EXPECT_EQ(options.render.samples, 0) << "as the device can";
}

TEST(CommandLine, ServesWhatWasAskedFor) {
  const Parsed parsed = parse({"serve",
                               "--no-auth",
                               "--listen",
                               "[::1]:0",
                               "--assets",
                               "a",
                               "--assets",
                               "b",
                               "--load",
                               "x.obj",
                               "--load=y",
                               "--play",
                               "--no-render",
                               "--samples",
                               "8",
                               "--max-frame-side",
                               "100",
                               "--max-gpu-bytes",
                               "1000",
                               "--data",
                               "d",
                               "--web",
                               "w",
                               "--port-file",
                               "p",
                               "--allow-origin",
                               "https://studio.example",
                               "--max-vertices",
                               "5"});
  const ServeOptions options = std::get<ServeOptions>(parsed.line);
  EXPECT_TRUE(options.no_auth && options.play && options.render.off);
  EXPECT_EQ(options.listen, "[::1]:0");
  EXPECT_EQ(options.assets, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(options.load, (std::vector<std::string>{"x.obj", "y"}));
  EXPECT_EQ(options.render.samples, 8);
  EXPECT_EQ(options.render.gpu_bytes, 1000U);
  EXPECT_EQ(options.limits.frame_side, 100U);
  EXPECT_EQ(options.limits.vertices_per_actor, 5U);
  EXPECT_EQ(options.data + options.web + options.port_file, "dwp");
  EXPECT_EQ(options.allowed_origins, std::vector<std::string>{"https://studio.example"});
}

TEST(CommandLine, RendersOnePictureOfTheBeginningByDefault) {
  const OfflineOptions options = rendering({"a.obj"});
  EXPECT_EQ(options.assets, std::vector<std::string>{"a.obj"});
  EXPECT_EQ(options.times_s, std::vector<double>{0.0});
  EXPECT_EQ(options.size, (render::Size{1280, 720}));
  EXPECT_EQ(options.output, "frame-%04d.png");
  EXPECT_FALSE(options.eye || options.target || options.background || options.light);
  EXPECT_TRUE(options.interpolation.empty());
}

TEST(CommandLine, RendersWhatWasAskedFor) {
  const OfflineOptions options = rendering({"a.obj",
                                            "b",
                                            "--at",
                                            "0,0.5,-1,1e1",
                                            "--size",
                                            "640x480",
                                            "-o",
                                            "x%d.jpg",
                                            "--sheet",
                                            "--fps",
                                            "12.5",
                                            "--closed",
                                            "--duration",
                                            "3",
                                            "--interpolation",
                                            "step,catmull_rom",
                                            "--orbit",
                                            "-30,20.5",
                                            "--background",
                                            "0,0.5,1",
                                            "--light",
                                            "-1,2,3",
                                            "--grid",
                                            "--samples",
                                            "2",
                                            "--quality",
                                            "100"});
  EXPECT_EQ(options.assets, (std::vector<std::string>{"a.obj", "b"}));
  EXPECT_EQ(options.times_s, (std::vector<double>{0.0, 0.5, -1.0, 10.0}));
  EXPECT_EQ(options.size, (render::Size{640, 480}));
  EXPECT_EQ(options.output, "x%d.jpg");
  EXPECT_TRUE(options.sheet && options.closed && options.grid);
  EXPECT_EQ(options.fps, 12.5);
  EXPECT_EQ(options.duration_s, 3.0);
  EXPECT_EQ(options.interpolation, (std::vector<std::string>{"step", "catmull_rom"}));
  EXPECT_EQ(options.orbit_deg, (std::array<float, 2>{-30.0F, 20.5F}));
  EXPECT_EQ(options.background, glm::vec3(0.0F, 0.5F, 1.0F));
  EXPECT_EQ(options.light, glm::vec3(-1.0F, 2.0F, 3.0F));
  EXPECT_EQ(options.render.samples, 2);
  EXPECT_EQ(options.quality, 100);
}

TEST(CommandLine, RatesAreAFilmsOrASequences) {
  EXPECT_EQ(rendering({"a.obj"}).fps, 24.0);
  EXPECT_EQ(rendering({"a.obj", "--fps", "12"}).fps, 12.0);
  EXPECT_EQ(rendering({"a.obj", "--sequence-fps", "12"}).fps, 12.0);
  for (const std::vector<std::string>& order :
       {std::vector<std::string>{"a.obj", "--fps", "60", "--mp4", "a.mp4"}, {"a.obj", "--mp4", "a.mp4", "--fps", "60"}}) {
    EXPECT_EQ(rendering(order).film_fps, 60.0);
    EXPECT_EQ(rendering(order).fps, 24.0);
  }
  const OfflineOptions film = rendering({"a.obj", "--mp4", "a.mp4", "--sequence-fps", "12", "--from", "1", "--to", "2.5"});
  EXPECT_EQ(film.mp4, "a.mp4");
  EXPECT_EQ(film.film_fps, 30.0);
  EXPECT_EQ(film.fps, 12.0);
  EXPECT_EQ(film.from_s, 1.0);
  EXPECT_EQ(film.to_s, 2.5);
}

TEST(CommandLine, RefusesTimesOfAFilmThatAreNone) {
  for (const char* time : {"-1", "nan", "inf", "a", "", "1,2"}) {
    mistake({"render", "a.obj", "--mp4", "a.mp4", "--from", time});
    mistake({"render", "a.obj", "--mp4", "a.mp4", "--to", time});
  }
  says(mistake({"render", "a.obj", "--to", "1"}), "--mp4");
  says(mistake({"render", "a.obj", "--fps", "1", "--sequence-fps", "2"}), "--sequence-fps");
}

TEST(CommandLine, AFileOfEditsHasItsOwnCameraUnlessAnotherIsAskedFor) {
  EXPECT_TRUE(rendering({"scene.json"}).is_scene());
  EXPECT_FALSE(rendering({"scene.json", "a.obj"}).is_scene());
  EXPECT_FALSE(rendering({"scene.json"}).looks_from);
  EXPECT_TRUE(rendering({"scene.json", "--orbit", "1,2"}).looks_from);
  EXPECT_TRUE(rendering({"scene.json", "--eye", "1,2,3"}).looks_from);
}

TEST(CommandLine, TakesItsAssetsAlsoBehindTheOptions) {
  const OfflineOptions options = rendering({"--at", "0,1", "--size", "64x32", "--eye", "1,2,3", "--target", "-4,5,6",
                                            "--interpolation", "linear", "a.obj", "b.obj"});
  EXPECT_EQ(options.assets, (std::vector<std::string>{"a.obj", "b.obj"}));
  EXPECT_EQ(options.times_s, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(options.size, (render::Size{64, 32}));
  EXPECT_EQ(options.eye, glm::vec3(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(options.target, glm::vec3(-4.0F, 5.0F, 6.0F));
  EXPECT_EQ(options.interpolation, std::vector<std::string>{"linear"});
}

}  // namespace
}  // namespace tweend::app
