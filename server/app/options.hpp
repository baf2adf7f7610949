#pragma once

#include <string>
#include <variant>
#include <vector>

#include "render/render_thread.hpp"
#include "server/app/inspect.hpp"
#include "server/app/render_offline.hpp"
#include "server/base/limits.hpp"
#include "server/net/network.hpp"

namespace tweend::app {

/// What `tweend serve` was asked for.
struct ServeOptions {
  std::string listen = "127.0.0.1:8933";
  std::string port_file;
  std::string data;
  std::string web;
  std::vector<std::string> assets;
  std::vector<std::string> load;
  std::vector<std::string> allowed_origins;
  bool play = false;
  bool no_auth = false;
  render::RenderOptions render;
  Limits limits;
};

/// `tweend doctor`
struct DoctorOptions {};

/// What the command line asked for; an int: to end at once with this code (help, version, a mistake).
using CommandLine = std::variant<int, ServeOptions, OfflineOptions, InspectOptions, DoctorOptions>;

/// Reads the command line; prints help, version, the methods or what was wrong.
[[nodiscard]] CommandLine parse_command_line(int argc, char** argv);

}  // namespace tweend::app
