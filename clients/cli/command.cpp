#include "clients/cli/command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <ostream>

#include "clients/cli/arguments.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/session.hpp"
#include "clients/cli/timing.hpp"

namespace tweend::cli {
namespace {

Json& place(Arguments& arguments, const Field& field) {
  return (field.is_own ? arguments.own : arguments.params)[Json::json_pointer("/" + field.path)];
}

}  // namespace

Command::Command(CLI::App& app) : app_(app), arguments_(std::make_unique<Arguments>()) {}
Command::~Command() = default;

CLI::Option* Command::value_option(const std::string& name, const Field& field, ValueKind kind, std::string help) {
  const auto read = [this, name, field, read_value = std::move(kind.read)](const std::string& text) {
    try {
      place(*arguments_, field) = read_value(text);
    } catch (const Usage& wrong) {
      throw Usage(fmt::format("{}: {}", name, wrong.what()));
    }
  };
  return app_.add_option_function<std::string>(name, read, std::move(help))->type_name(kind.shape);
}

CLI::Option* Command::flag_option(const std::string& name, const Field& field, bool value, std::string help) {
  const auto set = [this, field, value](std::int64_t) { place(*arguments_, field) = value; };
  return app_.add_flag_function(name, set, std::move(help));
}

Command& Command::argument(const std::string& name, const Field& field, ValueKind kind, std::string help) {
  value_option(name, field, std::move(kind), std::move(help))->required();
  return *this;
}

Command& Command::optional_argument(const std::string& name, const Field& field, ValueKind kind, std::string help) {
  value_option(name, field, std::move(kind), std::move(help));
  return *this;
}

Command& Command::more_arguments(std::string name, const Field& field, std::string shape, std::string help) {
  const auto read = [this, field](const std::vector<std::string>& words) { place(*arguments_, field) = words; };
  app_.add_option_function<std::vector<std::string>>(std::move(name), read, std::move(help))->type_name(std::move(shape));
  return *this;
}

Command& Command::option(const std::string& flag, const Field& field, ValueKind kind, std::string help) {
  value_option(flag, field, std::move(kind), std::move(help));
  return *this;
}

Command& Command::flag(const std::string& yes, const Field& field, std::string help) {
  flag_option(yes, field, true, std::move(help));
  return *this;
}

Command& Command::toggle(const std::string& yes, const std::string& no, const Field& field, std::string help) {
  flag_option(yes, field, true, std::move(help));
  flag_option(no, field, false, fmt::format("the opposite of {}", yes));
  app_.get_option(no)->excludes(app_.get_option(yes));
  return *this;
}

Command& Command::exclusive(std::initializer_list<const char*> flags) {
  for (const auto* one = flags.begin(); one != flags.end(); ++one) {
    for (const auto* other = flags.begin(); other != one; ++other) app_.get_option(*one)->excludes(app_.get_option(*other));
  }
  return *this;
}

Command& Command::needs_one_of(std::vector<std::string> flags) {
  needed_.push_back(std::move(flags));
  return *this;
}

Command& Command::otherwise(std::string unless, std::string parameter, int value) {
  defaults_.push_back({std::move(unless), std::move(parameter), value});
  return *this;
}

Command& Command::in_scene() {
  in_scene_ = true;
  return *this;
}

void Command::requests(std::string method, Show show) {
  runs([method = std::move(method), show = std::move(show)](Session& session, const Arguments& arguments) {
    const Json result = session.call(method, timed_params(session, arguments));
    if (session.options().json) {
      session.out() << to_line(result) << '\n';
    } else if (const std::string scheduled = scheduled_text(result); !scheduled.empty()) {
      session.out() << scheduled << '\n';
    } else {
      show(session.out(), arguments.params, result);
    }
    return ExitCode::Done;
  });
}

void Command::requests(std::string method, std::string pattern) {
  requests(std::move(method), [pattern = std::move(pattern)](std::ostream& out, const Json& params, const Json& result) {
    out << sentence(pattern, params, result) << '\n';
  });
}

ExitCode Command::run(Session& session) const {
  for (const auto& flags : needed_) {
    const auto given = [this](const std::string& flag) { return app_.count(flag) > 0; };
    if (std::none_of(flags.begin(), flags.end(), given)) {
      throw Usage(fmt::format("nothing to send: expected {}{}", flags.size() > 1 ? "one of " : "", fmt::join(flags, ", ")));
    }
  }
  Arguments arguments = *arguments_;
  // A scene that the command itself names stands nearer than --scene.
  if (in_scene_ && !arguments.params.contains("scene")) arguments.params.update(session.scene_params());
  for (const auto& [unless, parameter, value] : defaults_) {
    if (!arguments.params.contains(unless) && !arguments.params.contains(parameter)) arguments.params[parameter] = value;
  }
  return action_(session, arguments);
}

void CommandSet::group(const char* name, const char* help) { root_.add_subcommand(name, help)->require_subcommand(1); }

Command& CommandSet::add(std::string_view path, std::string help) {
  const auto space = path.find(' ');
  const bool grouped = space != std::string_view::npos;
  CLI::App* parent = grouped ? root_.get_subcommand(std::string(path.substr(0, space))) : &root_;
  CLI::App* app = parent->add_subcommand(std::string(grouped ? path.substr(space + 1) : path), std::move(help));
  return commands_.emplace_back(*app);
}

const Command* CommandSet::chosen() const {
  for (const Command& command : commands_) {
    if (command.app().parsed()) return &command;
  }
  return nullptr;
}

}  // namespace tweend::cli
