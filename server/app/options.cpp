#include "server/app/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "server/app/list_option.hpp"
#include "server/commands/command_table.hpp"
#include "server/commands/wire_types.hpp"

namespace tweend::app {
namespace {

void add_serve_options(CLI::App& serve, ServeOptions& o) {
  serve.add_option("--listen", o.listen, "Address and port; port 0 lets the system pick one")
      ->type_name("ADDR:PORT")
      ->capture_default_str();
  serve.add_option("--port-file", o.port_file, "Write the port here once it is open")->type_name("FILE");
  serve.add_option("--data", o.data, "The data folder; a folder serves one server")->type_name("DIR");
  serve.add_option("--web", o.web, "The page at /; by default the one that was installed with this program")->type_name("DIR");
  serve.add_option("--assets", o.assets, "A folder of assets; may be given several times")
      ->type_name("DIR")
      ->allow_extra_args(false);
  serve
      .add_option("--load", o.load,
                  "Add an actor with this asset to the scene main, unless it is there; may be given several times")
      ->type_name("ASSET")
      ->allow_extra_args(false);
  serve.add_flag("--play", o.play, "Play what was loaded");
  serve.add_flag("--no-auth", o.no_auth, "Everyone may do everything; the only way in this version, and on loopback only");
  serve
      .add_option("--allow-origin", o.allowed_origins,
                  "Pages of this origin may speak to the server, e.g. https://studio.example")
      ->type_name("ORIGIN")
      ->allow_extra_args(false);
  serve.add_flag("--no-render", o.render.off, "Draw nothing: for those who only want numbers");
  serve.add_option("--samples", o.render.samples, "Samples a pixel; by default 4 on a GPU and 1 where the processor draws")
      ->type_name("N")
      ->check(CLI::Range(1, 16));
}

void add_limit_options(CLI::App& serve, ServeOptions& o) {
  Limits& l = o.limits;
  const auto add = [&serve](const char* name, std::size_t& value, const char* help) {
    serve.add_option(name, value, help)->type_name("N")->capture_default_str()->check(CLI::PositiveNumber)->group("Limits");
  };
  add("--max-connections", l.connections, "Connections");
  add("--max-message-bytes", l.message_bytes, "Bytes of a JSON message");
  add("--max-json-depth", l.json_depth, "Nesting of JSON");
  add("--max-batch", l.batch_requests, "Requests in a batch");
  add("--max-streams", l.streams_per_connection, "Streams a connection");
  add("--max-scenes", l.scenes, "Scenes");
  add("--max-actors", l.actors_per_scene, "Actors a scene");
  add("--max-vertices", l.vertices_per_actor, "Vertices an actor");
  add("--max-triangles", l.triangles_per_actor, "Triangles an actor");
  add("--max-joints", l.joints_per_actor, "Joints an actor");
  add("--max-morph-targets", l.morph_targets_per_actor, "Morph targets an actor");
  add("--max-morphed-vertices", l.morphed_vertices, "Vertices of an actor's morph targets together");
  add("--max-keyed-values", l.keyed_values, "Keyed values of an asset's clips together");
  add("--max-clips", l.clips_per_actor, "Clips an actor");
  add("--max-keyframes", l.keyframes_per_clip, "Keyframes a clip");
  add("--max-markers", l.markers_per_clip, "Markers a clip");
  add("--max-queued-clips", l.queued_clips, "Clips of a queue");
  add("--max-scheduled", l.scheduled_commands, "Commands that wait for their reading of the clock");
  add("--max-undo", l.undo_steps, "Steps that can be undone");
  add("--max-stream-pixels", l.stream_pixels, "Pixels of a connection's streams of frames together");
  add("--max-frame-side", l.frame_side, "Pixels of a picture's width, and of its height");
  add("--max-recordings", l.recordings, "Recordings at once");
  add("--max-recorded-pictures", l.recorded_pictures, "Pictures a recording");
  add("--max-film-pictures", l.film_pictures, "Pictures of a film by HTTP");
  add("--max-film-bytes", l.film_bytes, "Bytes of a film by HTTP");
  add("--max-gpu-bytes", o.render.gpu_bytes, "Bytes of the GPU's memory for meshes and keyframes");
  add("--max-asset-bytes", l.asset_bytes, "Bytes of an asset's files");
  add("--max-texture-pixels", l.texture_pixels, "Pixels of a texture");
}

/// Whether a float holds it.
bool is_float(double number) { return std::isfinite(static_cast<float>(number)); }

CLI::Option* add_place(CLI::App& render, const char* name, std::optional<glm::vec3>& to, const char* help) {
  return add_list(render, name, {.form = "X,Y,Z", .least = 3, .most = 3, .fits = is_float}, help,
                  [&to](const std::vector<double>& n) { to = glm::vec3(n[0], n[1], n[2]); });
}

void add_view_options(CLI::App& render, OfflineOptions& o) {
  CLI::Option* orbit = add_list(render, "--orbit", {.form = "A,E", .least = 2, .most = 2, .fits = is_float},
                                "Where to look from: degrees from +Z towards +X, and above the ground; all is in view",
                                [&o](const std::vector<double>& n) {
                                  o.orbit_deg = {static_cast<float>(n[0]), static_cast<float>(n[1])};
                                  o.looks_from = true;
                                })
                           ->default_str(fmt::format("{},{}", o.orbit_deg[0], o.orbit_deg[1]));
  CLI::Option* eye = add_place(render, "--eye", o.eye, "Where to look from, in place of --orbit")->excludes(orbit);
  eye->each([&o](const std::string&) { o.looks_from = true; });
  add_place(render, "--target", o.target, "What --eye looks at; by default the origin")->needs(eye);
  add_list(render, "--background",
           {.form = "R,G,B",
            .least = 3,
            .most = 3,
            .fits = [](double n) { return n >= 0.0 && n <= 1.0; },
            .each = "a number from 0 to 1"},
           "sRGB, each 0 to 1", [&o](const std::vector<double>& n) { o.background = glm::vec3(n[0], n[1], n[2]); });
  add_place(render, "--light", o.light, "Where the light stands");
  render.add_flag("--grid", o.grid, "Draw the ground");
}

void add_clip_options(CLI::App& render, OfflineOptions& o) {
  render.add_option("--clip", o.clip, "Which clip to show; by default the first")->type_name("NAME");
  render.add_option("--sequence-fps", o.fps, "Frames a second of a sequence")
      ->type_name("N")
      ->capture_default_str()
      ->check(finite_above_zero());
  render.add_flag("--closed", o.closed, "The clip blends from its last keyframe back to the first");
  render.add_option("--duration", o.duration_s, "Of the clip, seconds")->type_name("S")->check(finite_above_zero());
  const auto read = [&o](const std::string& text) {
    o.interpolation.clear();
    for (const std::string_view mode : split(text, ',')) {
      const auto& names = protocol::EnumNames<animation::Interpolation>::kNames;
      if (std::find(names.begin(), names.end(), mode) == names.end()) {
        throw CLI::ValidationError("--interpolation", fmt::format("expected {}; found \"{}\"", fmt::join(names, ", "), mode));
      }
      o.interpolation.emplace_back(mode);
    }
  };
  render
      .add_option_function<std::string>("--interpolation", read,
                                        "step, linear or catmull_rom; one for each asset, or one for all")
      ->type_name("MODE[,MODE...]");
}

/// `--fps` is a film's, and without one that of sequences, as it was before there were films.
void add_film_options(CLI::App& render, OfflineOptions& o) {
  CLI::Option* mp4 = render.add_option("--mp4", o.mp4, "A film of the clip, in place of pictures")->type_name("FILE");
  for (const char* picture : {"--at", "--output", "--sheet", "--quality"}) mp4->excludes(render.get_option(picture));
  const auto fps = [&o, mp4, sequence = render.get_option("--sequence-fps")](double found) {
    if (mp4->count() > 0) {
      o.film_fps = found;
    } else if (sequence->count() > 0) {
      throw CLI::ValidationError("--fps", "expected --sequence-fps alone without --mp4, found both");
    } else {
      o.fps = found;
    }
  };
  render
      .add_option_function<double>("--fps", fps,
                                   "Pictures a second of a film, by default 30; without --mp4 the same as --sequence-fps")
      ->type_name("N")
      ->check(finite_above_zero());
  const auto add_time = [&](const char* name, std::optional<double>& to, const char* help) {
    add_list(render, name,
             {.form = "S", .least = 1, .most = 1, .fits = [](double n) { return n >= 0.0; }, .each = "a number from 0 on"},
             help, [&to](const std::vector<double>& n) { to = n.front(); })
        ->needs(mp4);
  };
  add_time("--from", o.from_s, "Media time at which the film begins; by default 0");
  add_time("--to", o.to_s, "Media time at which the film ends, not shown itself; by default the first actor's clip's end");
}

void add_offline_options(CLI::App& render, OfflineOptions& o) {
  render
      .add_option("ASSET", o.assets,
                  "glTF and OBJ files and sequences' folders; several stand side by side. Or a .json file of edits")
      ->required();
  render.add_option("--assets", o.assets_folder, "Where the assets are that a file of edits names; by default its own folder")
      ->type_name("DIR");
  add_list(render, "--at", {.form = "T[,T...]"}, "Media times, seconds; a picture for each",
           [&o](const std::vector<double>& n) { o.times_s = n; })
      ->default_str("0");
  render.add_option("-o,--output", o.output, "Where to: .png or .jpg, with %d or %04d for the picture's number")
      ->type_name("FILE")
      ->capture_default_str();
  render.add_flag("--sheet", o.sheet, "All pictures in one");
  add_list(render, "--size",
           {.form = "WxH",
            .separator = 'x',
            .least = 2,
            .most = 2,
            .fits = [](double n) { return n >= 1.0 && n <= 65535.0 && n == std::floor(n); },
            .each = "a whole number of pixels"},
           "Of each picture, pixels",
           [&o](const std::vector<double>& n) {
             o.size = {static_cast<std::uint32_t>(n[0]), static_cast<std::uint32_t>(n[1])};
           })
      ->default_str(fmt::format("{}x{}", o.size.width, o.size.height));
  add_clip_options(render, o);
  add_view_options(render, o);
  render.add_option("--samples", o.render.samples, "Samples a pixel")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(1, 16));
  render.add_option("--quality", o.quality, "Of a .jpg")->type_name("N")->capture_default_str()->check(CLI::Range(1, 100));
  add_film_options(render, o);
}

void print_commands() {
  for (const commands::Command& c : commands::command_table()) {
    std::cout << c.name << '\t' << commands::role_name(c.role) << '\t' << c.summary << '\n';
  }
}

}  // namespace

CommandLine parse_command_line(int argc, char** argv) {
  CLI::App app{"tweend: headless keyframe-animation playback server"};
  app.set_version_flag("--version", std::string("tweend ") + TWEEND_VERSION);
  bool list_commands = false;
  app.add_flag("--list-commands", list_commands, "Print every method with its role and meaning");
  app.require_subcommand(0, 1);
  ServeOptions serve_options;
  CLI::App& serve = *app.add_subcommand("serve", "Open the port and serve until SIGTERM or SIGINT");
  add_serve_options(serve, serve_options);
  add_limit_options(serve, serve_options);
  OfflineOptions offline_options;
  CLI::App& render = *app.add_subcommand("render", "Draw assets to picture files or a film, without a server");
  add_offline_options(render, offline_options);
  InspectOptions inspect_options;
  CLI::App& inspect = *app.add_subcommand("inspect", "What a file holds that can be an asset, and what is wrong with it");
  inspect.add_option("FILE", inspect_options.path, "A .glb, .gltf or .obj file, or a sequence's folder")->required();
  const CLI::App& doctor = *app.add_subcommand("doctor", "Which devices there are to draw with, and why one was not taken");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == 0;  // --help, --version
    app.exit(error, std::cout, std::cerr);
    return asked ? 0 : 2;
  }
  if (serve.parsed()) return serve_options;
  if (render.parsed()) return offline_options;
  if (inspect.parsed()) return inspect_options;
  if (doctor.parsed()) return DoctorOptions{};
  if (list_commands) {
    print_commands();
    return 0;
  }
  std::cerr << app.help();
  return 2;
}

}  // namespace tweend::app
