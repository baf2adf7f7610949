#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"

namespace tweend::cli {
namespace {

void show_applied(std::ostream& out, const Json&, const Json& result) {
  const std::size_t edits = result.value("results", Json::array()).size();
  out << fmt::format("{} {} applied (revision {})\n", edits, edits == 1 ? "edit" : "edits", brief_member(result, "revision"));
}

}  // namespace

void add_edit_commands(CommandSet& commands) {
  with_edit_options(commands.add("undo", "Take the scene's last edit back.")).requests("edit.undo", "{undone} undone");
  with_edit_options(commands.add("redo", "Carry out again what was undone last.")).requests("edit.redo", "{redone} redone");
  with_edit_options(
      commands.add("apply", "Carry out several edits as one: all or none of them, one revision, one step to undo."))
      .argument("FILE", "edits", json_file(commands.in()), "a JSON array of {method, params}, - for standard input")
      .requests("edit.apply", show_applied);
}

}  // namespace tweend::cli
