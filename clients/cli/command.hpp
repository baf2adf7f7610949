#pragma once

#include <deque>
#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/cli/exit_code.hpp"
#include "clients/cli/json.hpp"
#include "clients/cli/value_kind.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's
class App;
class Option;
}  // namespace CLI

namespace tweend::cli {

class Session;

/// What the arguments of a command said.
struct Arguments;

/// Where the value of an argument goes: a parameter of the request (`transform/scale` is a member of one), or, made by own(),
/// something that only this program uses.
struct Field {
  Field(const char* parameter) : path(parameter) {}  // implicit: most fields are parameters
  Field(std::string parameter) : path(std::move(parameter)) {}
  std::string path;
  bool is_own = false;
};

[[nodiscard]] inline Field own(const char* name) {
  Field field(name);
  field.is_own = true;
  return field;
}

/// A subcommand: what it takes and what it does.
/// The arguments write into the request's params directly, so there is nothing in between to keep in step with the protocol.
class Command {
 public:
  using Action = std::function<ExitCode(Session&, const Arguments&)>;
  using Show = std::function<void(std::ostream& out, const Json& params, const Json& result)>;

  explicit Command(CLI::App& app);
  ~Command();
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  /// An argument without a flag, in the order they are added; `name` stands in the help.
  Command& argument(const std::string& name, const Field& field, ValueKind kind, std::string help);
  Command& optional_argument(const std::string& name, const Field& field, ValueKind kind, std::string help);
  /// The rest of the line, as an array of strings.
  Command& more_arguments(std::string name, const Field& field, std::string shape, std::string help);
  /// A flag with a value.
  Command& option(const std::string& flag, const Field& field, ValueKind kind, std::string help);
  /// A flag that means true, and one that means false.
  Command& flag(const std::string& yes, const Field& field, std::string help);
  Command& toggle(const std::string& yes, const std::string& no, const Field& field, std::string help);

  /// At most one of these flags may be given.
  Command& exclusive(std::initializer_list<const char*> flags);
  /// At least one of these flags must be given.
  Command& needs_one_of(std::vector<std::string> flags);
  /// Where neither of two parameters was given, the second is sent with this value.
  Command& otherwise(std::string unless, std::string parameter, int value);

  /// The request takes the scene that --scene names.
  Command& in_scene();
  void runs(Action action) { action_ = std::move(action); }
  /// Sends the arguments as this request and shows the result: by `show`, or raw with --json.
  void requests(std::string method, Show show);
  /// The same, with a pattern for sentence().
  void requests(std::string method, std::string pattern);

  [[nodiscard]] const CLI::App& app() const noexcept { return app_; }
  /// Once the command line has been read. Throws Failure.
  [[nodiscard]] ExitCode run(Session& session) const;

 private:
  struct Default {
    std::string unless;
    std::string parameter;
    int value;
  };

  CLI::Option* value_option(const std::string& name, const Field& field, ValueKind kind, std::string help);
  CLI::Option* flag_option(const std::string& name, const Field& field, bool value, std::string help);

  CLI::App& app_;
  std::unique_ptr<Arguments> arguments_;
  std::vector<std::vector<std::string>> needed_;
  std::vector<Default> defaults_;
  bool in_scene_ = false;
  Action action_;
};

/// All commands of the program.
class CommandSet {
 public:
  CommandSet(CLI::App& root, std::istream& in) : root_(root), in_(in) {}

  /// What the commands `NAME …` have in common.
  void group(const char* name, const char* help);
  /// A command, `seek` or, in a group, `scene create`.
  Command& add(std::string_view path, std::string help);
  /// Standard input, for json_file().
  [[nodiscard]] std::istream& in() const noexcept { return in_; }
  [[nodiscard]] const CLI::App& root() const noexcept { return root_; }
  /// The command that was read; nullptr: none.
  [[nodiscard]] const Command* chosen() const;

 private:
  CLI::App& root_;
  std::istream& in_;
  std::deque<Command> commands_;  // a deque: actions keep references
};

}  // namespace tweend::cli
