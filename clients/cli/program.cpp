#include "clients/cli/program.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/command.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"

namespace tweend::cli {
namespace {

constexpr const char* kFooter =
    "Numbers of a list are separated by commas: --eye -1,2,3. Times are seconds, angles radians.\n"
    "Exit codes: 0 done, 1 refused, 2 wrong usage, 3 no server.";

void add_global_options(CLI::App& app, Options& options) {
  app.require_subcommand(1)->fallthrough()->footer(kFooter);
  app.get_formatter()->column_width(36);
  app.set_version_flag("--version", "tweenctl " TWEEND_VERSION, "print the version");
  app.add_option("--server", options.server, "where the server listens (default 127.0.0.1:8933)")
      ->type_name("ADDR:PORT")
      ->envname("TWEEND_SERVER");
  app.add_option_function<std::string>(
         "--scene", [&options](const std::string& name) { options.scene = name; }, "which scene (default main)")
      ->type_name("SCENE");
  app.add_flag("--json", options.json, "print results and errors as JSON, for programs");
  app.add_option("--timeout", options.timeout_s, "for the connection and each answer (default 10)")->type_name("SECONDS");
}

void add_every_family(CommandSet& commands) {
  add_server_commands(commands);
  add_scene_commands(commands);
  add_actor_commands(commands);
  add_keyframe_commands(commands);
  add_clip_commands(commands);
  add_pose_commands(commands);
  add_edit_commands(commands);
  add_playback_commands(commands);
  add_marker_commands(commands);
  add_layer_commands(commands);
  add_schedule_commands(commands);
  add_view_commands(commands);
  add_sample_commands(commands);
  add_frame_commands(commands);
  add_export_commands(commands);
  add_record_commands(commands);
  add_event_commands(commands);
  add_watch_commands(commands);
  add_raw_commands(commands);
  add_completion_commands(commands);
}

/// `-.5` would be read as a flag; CLI11 knows negative numbers by the digit after the sign.
std::string with_leading_zero(std::string argument) {
  const bool bare = argument.size() > 2 && argument.starts_with("-.") && std::isdigit(static_cast<unsigned char>(argument[2]));
  if (bare) argument.insert(1, "0");
  return argument;
}

/// The innermost command that was read.
const CLI::App& innermost(const CLI::App& root) {
  const CLI::App* app = &root;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  return *app;
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? "tweenctl" : full_name(*app.get_parent()) + " " + app.get_name();
}

ExitCode report_usage(const CLI::App& root, const CLI::ParseError& error, const Io& io) {
  const CLI::App& app = innermost(root);
  const bool is_group = !app.get_subcommands([](const CLI::App*) { return true; }).empty();
  const auto rest = root.remaining(true);
  std::string what = error.what();
  if (is_group && rest.empty() && error.get_name() == "RequiredError") {
    io.err << root.help();  // that of the innermost command
    return ExitCode::Usage;
  }
  if (is_group && !rest.empty())
    what = (rest.front().starts_with('-') ? "there is no option " : "there is no command ") + rest.front();
  io.err << "tweenctl: " << printable(what) << "; see `" << full_name(app) << " --help`\n";
  return ExitCode::Usage;
}

ExitCode report(const Failure& failure, const Options& options, const Io& io) {
  if (const auto* refusal = dynamic_cast<const Refusal*>(&failure); refusal != nullptr && options.json) {
    io.out << refusal->error << '\n';
  }
  io.err << "tweenctl: " << printable(failure.what()) << '\n';
  return failure.exit_code;
}

ExitCode parse_and_run(CLI::App& app, Options& options, std::vector<std::string> arguments, const Io& io) {
  CommandSet commands(app, io.in);
  add_every_family(commands);
  std::transform(arguments.begin(), arguments.end(), arguments.begin(), with_leading_zero);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::Success& asked) {  // --help or --version
    app.exit(asked, io.out, io.err);
    return ExitCode::Done;
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error, io);
  }
  if (!(options.timeout_s > 0.0)) throw Usage("--timeout: expected more than 0 seconds");
  Session session(options, io);
  return commands.chosen()->run(session);
}

}  // namespace

ExitCode run(std::vector<std::string> arguments, const Io& io) {
  Options options;
  try {
    CLI::App app("Remote control of a tweend server.", "tweenctl");
    add_global_options(app, options);
    const ExitCode code = parse_and_run(app, options, std::move(arguments), io);
    io.out.flush();
    return code;
  } catch (const Failure& failure) {
    return report(failure, options, io);
  } catch (const nlohmann::json::exception& unexpected) {
    return report(NoServer(std::string("the server's answer is not what this program expects: ") + unexpected.what()), options,
                  io);
  } catch (const std::exception& unexpected) {
    return report(Failure(ExitCode::Usage, unexpected.what()), options, io);
  }
}

}  // namespace tweend::cli
