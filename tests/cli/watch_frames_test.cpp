#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/cli/child_process.hpp"
#include "tests/cli/pictures.hpp"
#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using test::Folder;
using test::frame_packet;
using test::frame_stream;
using test::jpeg;
using test::png;
using test::run_cli;

const Json kNothing = Json::object();

TEST(WatchFrames, PrintsALineAPacket) {
  const auto run = run_cli(frame_stream(kNothing, frame_packet(1, 0, jpeg()) + frame_packet(2, 0, std::string(23'400, 'x'))),
                           {"watch", "frames", "--count", "2"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("#1          1.250 s  age "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find(" ms  key                 jpeg 640 x 360, 14 B\n"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("jpeg 640 x 360, 23.4 kB\n"), std::string::npos) << run.out;
}

TEST(WatchFrames, AsksForWhatTheOptionsSay) {
  const Json params = Json::parse(R"({"scene":"two","rate":10,"width":640,"height":360,"encoding":"png","quality":70,
                                      "camera":{"eye":[0,1,9],"up":[0,1,0]}})");
  const auto run = run_cli(frame_stream(params, frame_packet(1, 1, png())),
                           {"--scene", "two", "watch", "frames", "--count", "1", "--rate", "10", "--size", "640x360",
                            "--encoding", "png", "--quality", "70", "--eye", "0,1,9", "--up", "0,1,0"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("png 1 x 1 of 640 x 360, 67 B\n"), std::string::npos) << run.out;
}

/// The frame header of a JPEG of so many pixels behind a segment that says nothing of them; more is not read.
std::string jpeg_of(char width, char height) {
  using namespace std::string_literals;
  return "\xFF\xD8\xFF\xE0\x00\x04--\xFF\xC0\x00\x11\x08\x00"s + height + '\0' + width + "..........";
}

TEST(WatchFrames, SaysHowFarTheServerHasGoneDownForUs) {
  const auto packets = frame_packet(1, 0, jpeg_of(96, 54)) + frame_packet(2, 1, png());
  const auto run = run_cli(frame_stream({{"adaptive", true}}, packets), {"watch", "frames", "--count", "2", "--adaptive"});
  EXPECT_NE(run.out.find("jpeg 96 x 54 of 640 x 360, 27 B\n"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("png 1 x 1 of 640 x 360, "), std::string::npos) << run.out;
  const auto json = run_cli(frame_stream({{"adaptive", false}, {"delivery", "every"}}, frame_packet(1, 0, jpeg_of(96, 54))),
                            {"--json", "watch", "frames", "--count", "1", "--no-adaptive", "--delivery", "every"});
  EXPECT_EQ(Json::parse(json.out).at("width"), 96);
  EXPECT_EQ(Json::parse(json.out).at("height"), 54);
}

TEST(WatchFrames, APictureCutShortHasNoSize) {
  const std::string whole = jpeg_of(96, 54);
  for (std::size_t bytes = 3; bytes < 17; ++bytes) {
    const auto run =
        run_cli(frame_stream(kNothing, frame_packet(1, 0, whole.substr(0, bytes))), {"watch", "frames", "--count", "1"});
    EXPECT_NE(run.out.find("jpeg 640 x 360, "), std::string::npos) << run.out;
  }
}

TEST(WatchFrames, StoresVideoInOneFile) {
  const Folder folder;
  const Json params{{"encoding", "h264"}, {"bitrate", 500'000}};
  const auto packets = frame_packet(1, 2, "unit one,") + frame_packet(2, 2, "unit two");
  const std::string out = folder.path("o.h264");
  std::ofstream(out) << "an earlier and longer file than this one";
  const auto run = run_cli(frame_stream(params, packets),
                           {"watch", "frames", "--encoding", "h264", "--bitrate", "500000", "-o", out, "--count", "2"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_EQ(folder.read("o.h264"), "unit one,unit two");
  EXPECT_EQ(run.out.rfind(out + ": 2 frames, ", 0), 0U) << run.out;
}

TEST(WatchFrames, WritesVideoAloneToStandardOutput) {
  const auto run = run_cli(frame_stream({{"encoding", "h264"}}, frame_packet(1, 2, "unit")),
                           {"watch", "frames", "--encoding", "h264", "-o", "-", "--count", "1"});
  EXPECT_EQ(run.code, ExitCode::Done);
  EXPECT_EQ(run.out, "unit");
  EXPECT_EQ(run.err.rfind("-: 1 frame, ", 0), 0U) << run.err;
}

TEST(WatchFrames, VideoThatCantBeWrittenLosesNothing) {
  const Folder folder;
  const auto run = test::run_alone({"watch", "frames", "--encoding", "h264", "-o", folder.path("none/o.h264")});
  EXPECT_EQ(run.code, ExitCode::Usage);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "tweenctl: --out: expected a file that can be written, found " + folder.path("none/o.h264") +
                         ": No such file or directory\n");
  std::ofstream(folder.path("kept")) << "kept";
  const auto end = test::event("stream.ended", {{"stream", 4}, {"reason", "gone"}});
  const auto ended =
      run_cli(frame_stream({{"encoding", "h264"}}, end), {"watch", "frames", "--encoding", "h264", "-o", folder.path("kept")});
  EXPECT_EQ(ended.code, ExitCode::Refused);
  EXPECT_EQ(folder.read("kept"), "kept");
  (void)run_cli(frame_stream({{"encoding", "h264"}}, end), {"watch", "frames", "--encoding", "h264", "-o", folder.path("new")});
  EXPECT_EQ(folder.list(), "kept,");
}

TEST(WatchFrames, AFullPlaceEndsIt) {
  const auto run = run_cli(frame_stream({{"encoding", "h264"}}, frame_packet(1, 2, "unit")),
                           {"watch", "frames", "--encoding", "h264", "-o", "/dev/full"});
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.err, "tweenctl: can't write /dev/full: expected a place for 4 B, found: No space left on device\n");
}

TEST(WatchFrames, AStreamIsNoFilm) {
  const Folder folder;
  const auto complaint = [&](const std::string& encoding) {
    const auto run = test::run_alone({"watch", "frames", "--encoding", encoding, "-o", folder.path("film.mp4")});
    EXPECT_EQ(run.code, ExitCode::Usage);
    EXPECT_EQ(folder.list(), "");
    return run.err;
  };
  const std::string rest = ", found " + folder.path("film.mp4") + "; `tweenctl record start` makes films\n";
  EXPECT_EQ(complaint("h264"), "tweenctl: --out: expected a name such as film.h264" + rest);
  EXPECT_EQ(complaint("jpeg"), "tweenctl: --out: expected a folder with jpeg" + rest);
}

TEST(WatchFrames, ATerminalIsNoPlaceForVideo) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"watch", "frames", "--encoding", "rgba", "-o", "-"}, {"frame", "-"}}) {
    const auto run = test::run_alone_to_terminal(arguments);
    EXPECT_EQ(run.code, ExitCode::Usage);
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find("found a terminal: name a file, or add `> FILE` or `| PROGRAM`\n"), std::string::npos) << run.err;
  }
}

TEST(WatchFrames, StandardOutputIsForOneThing) {
  const auto pictures = test::run_alone({"watch", "frames", "-o", "-"});
  EXPECT_EQ(pictures.code, ExitCode::Usage);
  EXPECT_EQ(pictures.err,
            "tweenctl: --out: expected a folder with jpeg, found -; h264 and rgba can be written to standard output\n");
  const auto lines = test::run_alone({"--json", "watch", "frames", "--encoding", "h264", "-o", "-"});
  EXPECT_EQ(lines.code, ExitCode::Usage);
  EXPECT_EQ(lines.err, "tweenctl: --out: expected a file with --json, whose lines go to standard output, found -\n");
}

TEST(WatchFrames, StoresEachUnderItsNumber) {
  const Folder folder;
  const std::string out = folder.path("new/folder");
  const auto packets = frame_packet(7, 0, jpeg()) + frame_packet(8, 1, png()) + frame_packet(1'234'567, 0, jpeg());
  const auto run = run_cli(frame_stream(kNothing, packets), {"watch", "frames", "-o", out, "--count", "3"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_EQ(folder.list("new/folder"), "frame_000007.jpg,frame_000008.png,frame_1234567.jpg,");
  EXPECT_EQ(folder.read("new/folder/frame_000007.jpg"), jpeg());
  EXPECT_EQ(folder.read("new/folder/frame_000008.png"), png());
}

TEST(WatchFrames, SumsUpWithTheGaps) {
  const Folder folder;
  const auto packets = frame_packet(3, 0, jpeg()) + frame_packet(4, 0, jpeg()) + frame_packet(9, 0, jpeg());
  const auto run = run_cli(frame_stream(kNothing, packets), {"watch", "frames", "-o", folder.path("."), "--count", "3"});
  EXPECT_EQ(run.out.rfind(folder.path(".") + ": 3 frames, ", 0), 0U) << run.out;
  EXPECT_NE(run.out.find(" fps, 4 skipped, median age "), std::string::npos) << run.out;
  EXPECT_EQ(run.out.substr(run.out.rfind(" ms, ")), " ms, 42 B\n");
  EXPECT_EQ(run.err, "") << "nobody watches: there is no progress bar";
}

/// What is left on a terminal's line where this has been written.
std::string left_of(const std::string& written) {
  std::string line;
  std::size_t column = 0;
  for (const char c : written) {
    if (c == '\r') {
      column = 0;
    } else {
      if (column == line.size()) line += ' ';
      line[column++] = c;
    }
  }
  return line;
}

TEST(WatchFrames, DrawsAProgressBarOnATerminalAndCleansUp) {
  const Folder folder;
  const auto run = test::run_on_terminal(frame_stream(kNothing, frame_packet(3, 0, jpeg())),
                                         {"watch", "frames", "-o", folder.path("."), "--count", "1"}, 80);
  EXPECT_EQ(run.code, ExitCode::Done);
  const std::string bar = run.err.substr(0, run.err.find('\r', 1));
  EXPECT_EQ(bar, "\r[>" + std::string(39, ' ') + "]  0/1  ETA -:--");
  // Whoever is slow sees a second and longer one, of the frame.
  EXPECT_EQ(left_of(run.err).find_first_not_of(' '), std::string::npos) << run.err;
  EXPECT_TRUE(run.err.ends_with('\r')) << run.err;
  EXPECT_NE(run.out.find(": 1 frame, - fps, 0 skipped"), std::string::npos) << run.out;
}

TEST(WatchFrames, PrintsHeadersForPrograms) {
  const Folder folder;
  const auto line = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"--json", "watch", "frames", "--count", "1"});
    const auto run = test::run_on_terminal(frame_stream(kNothing, frame_packet(3, 0, jpeg())), arguments, 80);
    EXPECT_EQ(run.err, "") << "a bar would stand amid the lines";
    Json json = Json::parse(run.out);
    EXPECT_TRUE(json.at("age_us").is_number_integer());
    json.erase("age_us");
    return json;
  };
  Json expected = Json::parse(R"({"stream":4,"sequence":3,"media_us":1250000,"server_us":77,"revision":9,"flags":["key"],
                                  "encoding":"jpeg","bytes":14})");
  EXPECT_EQ(line({}), expected);
  expected["file"] = folder.path("frame_000003.jpg");
  EXPECT_EQ(line({"-o", folder.path("")}), expected);
}

TEST(WatchFrames, StopsAtWhatIsNoPicture) {
  const Folder folder;
  const auto complaint = [&](const std::string& packet) {
    const auto run = run_cli(frame_stream(kNothing, packet), {"watch", "frames", "-o", folder.path(".")});
    EXPECT_EQ(run.code, ExitCode::NoServer);
    EXPECT_NE(run.out.find(": 0 frames, - fps, 0 skipped"), std::string::npos) << run.out;
    return run.err;
  };
  EXPECT_EQ(complaint(frame_packet(3, 2, "x")),
            "tweenctl: packet 3: expected a frame in jpeg or png, found kind 3 in encoding 2\n");
  EXPECT_EQ(complaint(test::packet({}, std::vector<float>{1.0F})),
            "tweenctl: packet 0: expected a frame in jpeg or png, found kind 2 in encoding 0\n");
  EXPECT_EQ(complaint(frame_packet(3, 0, "")),
            "tweenctl: packet 3 sent no jpeg picture: expected bytes that start with ff d8 ff, found nothing\n");
  EXPECT_EQ(folder.list(), "");
}

TEST(WatchFrames, SumsUpWhatCameBeforeTheEnd) {
  const Folder folder;
  const auto end = test::event("stream.ended", {{"stream", 4}, {"reason", "the scene was removed"}});
  const auto run =
      run_cli(frame_stream(kNothing, frame_packet(3, 0, jpeg()) + end), {"watch", "frames", "-o", folder.path(".")});
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.err, "tweenctl: the stream has ended: the scene was removed\n");
  EXPECT_NE(run.out.find(": 1 frame, "), std::string::npos) << run.out;
}

TEST(WatchFrames, AFolderThatCantBeMadeIsAWrongCommandLine) {
  const Folder folder;
  std::ofstream(folder.path("file")) << "here";
  for (const char* name : {"file", "file/below"}) {
    const auto run = test::run_alone({"watch", "frames", "-o", folder.path(name)});
    EXPECT_EQ(run.code, ExitCode::Usage);
    EXPECT_EQ(run.err, "tweenctl: can't make the folder " + folder.path(name) +
                           ": expected one, or a place for it, found: Not a directory\n");
  }
}

TEST(WatchFrames, AFileThatCantBeWrittenEndsIt) {
  const Folder folder;
  std::filesystem::create_directory(folder.path("frame_000004.jpg"));
  const auto packets = frame_packet(3, 0, jpeg()) + frame_packet(4, 0, jpeg());
  const auto run = run_cli(frame_stream(kNothing, packets), {"watch", "frames", "-o", folder.path("")});
  EXPECT_EQ(run.code, ExitCode::Refused);
  EXPECT_EQ(run.err, "tweenctl: can't write " + folder.path("frame_000004.jpg") +
                         ": expected a place for 14 B, found: Is a directory\n");
  EXPECT_EQ(folder.list(), "frame_000003.jpg,frame_000004.jpg,");
}

TEST(WatchFrames, AnInterruptSumsUp) {
  const Folder folder;
  test::FakeServer server(frame_stream(kNothing, frame_packet(3, 0, jpeg())));
  test::ChildProcess child(test::tweenctl(server, {"watch", "frames", "-o", folder.path(".")}));
  while (!std::filesystem::exists(folder.path("frame_000003.jpg"))) std::this_thread::yield();
  child.send_signal(SIGINT);
  EXPECT_NE(child.read_all().find(": 1 frame, - fps, 0 skipped"), std::string::npos);
  EXPECT_EQ(child.wait(), 130);
}

}  // namespace
}  // namespace tweend::cli
