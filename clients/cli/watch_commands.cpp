#include <fmt/format.h>

#include <string>

#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/picture_options.hpp"
#include "clients/cli/watch_frames.hpp"
#include "clients/cli/watch_pose.hpp"
#include "clients/cli/watch_vertices.hpp"

namespace tweend::cli {
namespace {

/// @param encodings  as words of word(), the default first
Command& with_packets(Command& command, const std::string& encodings, int rate = 30) {
  const std::string first = encodings.substr(0, encodings.find('|'));
  return command.option("--rate", "rate", number(), fmt::format("packets a second (default {})", rate))
      .option("--encoding", "encoding", word(encodings), fmt::format("(default {})", first))
      .option("--delivery", "delivery", word("latest|every"),
              "whether packets are skipped where we are too slow, or we are disconnected (default latest)")
      .option("--count", own("count"), count(), "stop after so many");
}

}  // namespace

void add_watch_commands(CommandSet& commands) {
  commands.group("watch", "Print or store what a stream sends.");
  with_packets(
      with_actor(
          commands.add("watch vertices", "Open a stream of vertices and print a line a packet, until interrupted.").in_scene()),
      "f32|q16|meshopt")
      .runs(watch_vertices);
  with_packets(
      with_actor(commands.add("watch pose", "Open a stream of poses and print a line a packet, until interrupted.").in_scene()),
      "f32|q16", 60)
      .runs(watch_pose);
  Command& frames =
      commands.add("watch frames", "Open a stream of pictures; store them or print a line a packet, until interrupted.")
          .in_scene()
          .option("-o,--out", own("out"), text("FILE"),
                  "store them: jpeg and png in this folder, as frame_SEQUENCE.jpg or .png; h264 and rgba one after the other "
                  "in this file, or - for standard output")
          .option("--bitrate", "bitrate", count("BITS"), "a second, at most; of h264 (default: as many as it takes)")
          .toggle("--adaptive", "--no-adaptive", "adaptive",
                  "whether jpeg comes smaller where we are too slow (default), or as it was asked for");
  with_picture(with_packets(frames, "jpeg|png|h264|rgba")).runs(watch_frames);
}

}  // namespace tweend::cli
