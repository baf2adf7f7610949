#include <fmt/format.h>

#include "server/commands/command_table.hpp"

namespace tweend::commands {
namespace {

struct HistoryParams : EditTarget {
  static constexpr std::string_view kName = "HistoryParams";
  static void describe(FieldList<HistoryParams>& f) { add_edit_fields(f); }
};

struct UndoResult {
  static constexpr std::string_view kName = "Undone";
  std::uint64_t revision = 0;
  std::string undone;
  static void describe(FieldList<UndoResult>& f) {
    f.add<&UndoResult::revision>("revision", "The scene's new revision.");
    f.add<&UndoResult::undone>("undone", "The method that was taken back.");
  }
};

struct RedoResult {
  static constexpr std::string_view kName = "Redone";
  std::uint64_t revision = 0;
  std::string redone;
  static void describe(FieldList<RedoResult>& f) {
    f.add<&RedoResult::revision>("revision", "The scene's new revision.");
    f.add<&RedoResult::redone>("redone", "The method that was done again.");
  }
};

struct EditItem {
  static constexpr std::string_view kName = "Edit";
  std::string method;
  std::optional<protocol::JsonValue> params;
  static void describe(FieldList<EditItem>& f) {
    f.add<&EditItem::method>("method",
                             "An edit: actor.*, keyframe.*, clip.*, marker.*, layer.*, scene.update, camera.set, light.set.");
    f.add<&EditItem::params>("params", "Its parameters; scene, if given, is that of the whole.");
  }
};

struct ApplyParams : EditTarget {
  static constexpr std::string_view kName = "ApplyParams";
  std::vector<EditItem> edits;
  static void describe(FieldList<ApplyParams>& f) {
    add_edit_fields(f);
    f.add<&ApplyParams::edits>("edits", "Carried out in this order, all or none.");
  }
  [[nodiscard]] Status check() const {
    if (edits.empty()) return fail(ErrorCode::InvalidParams, "expected at least one edit, found none", "edits");
    return {};
  }
};

struct ApplyResult {
  static constexpr std::string_view kName = "Applied";
  std::uint64_t revision = 0;
  std::vector<protocol::JsonText> results;
  static void describe(FieldList<ApplyResult>& f) {
    f.add<&ApplyResult::revision>("revision", "The scene's new revision; all results have the same.");
    f.add<&ApplyResult::results>("results", "Each edit's own, in their order.");
  }
};

void undo(const HistoryParams&, const Services& services, stage::EditOptions options, stage::EditDone done) {
  const auto answer = [](std::uint64_t revision, const std::string& method) {
    return protocol::encode(UndoResult{revision, method});
  };
  services.stage.move_history(std::move(options), stage::HistoryMove::Undo, answer, std::move(done));
}

void redo(const HistoryParams&, const Services& services, stage::EditOptions options, stage::EditDone done) {
  const auto answer = [](std::uint64_t revision, const std::string& method) {
    return protocol::encode(RedoResult{revision, method});
  };
  services.stage.move_history(std::move(options), stage::HistoryMove::Redo, answer, std::move(done));
}

struct Step {
  const Command* command = nullptr;
  Params params;
};

/// Looks the method up and decodes its parameters; what only makes sense for the whole is refused in a part.
Result<Step> decode_step(const EditItem& item, const std::string& path, const std::string& scene) {
  const Command* command = find_command(item.method);
  if (command == nullptr || command->edit == nullptr || item.method == "edit.apply") {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected an edit (actor.*, keyframe.*, clip.*, marker.*, layer.*, scene.update, camera.set, "
                            "light.set), found \"{}\"",
                            item.method),
                path + ".method");
  }
  TWEEND_ASSIGN(Params params, decode_params(*command, item.params.value_or(protocol::JsonValue()), path + ".params"));
  const EditTarget& target = command->target(params.get());
  if (target.scene && *target.scene != scene) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected the scene of the whole, \"{}\", found \"{}\"", scene, *target.scene),
                path + ".params.scene");
  }
  if (target.base_revision) {
    return fail(ErrorCode::InvalidParams, "expected base_revision beside edits, found it in one of them",
                path + ".params.base_revision");
  }
  if (target.retry_key) {
    return fail(ErrorCode::InvalidParams, "expected retry_key beside edits, found it in one of them",
                path + ".params.retry_key");
  }
  if (command->timed != nullptr && command->timed(params.get()).at_us) {
    return fail(ErrorCode::InvalidParams, "expected an edit for now, found at_us: parts of a whole are carried out together",
                path + ".params.at_us");
  }
  return Step{command, std::move(params)};
}

/// "params.time" of the second edit is "params.edits[1].params.time" of the whole.
Error in_step(Error error, const std::string& path) {
  error.path = error.path.empty() ? path : path + "." + error.path;
  return error;
}

Result<ApplyResult> apply_edits(const ApplyParams& p, EditContext& context) {
  ApplyResult result;
  for (std::size_t i = 0; i < p.edits.size(); ++i) {
    const std::string path = fmt::format("params.edits[{}]", i);
    const std::string scratch = fmt::format("{} ", i);
    const Result<Step>& step =
        context.scratch.once(scratch + "step", [&] { return decode_step(p.edits[i], path, context.scene().name); });
    if (!step) return step.error();
    EditContext part{context.services, context.transaction, context.scratch, scratch, context.view, context.now_us};
    Result<std::string> answer = step->command->edit(step->params.get(), part);
    if (!answer) return in_step(answer.error(), path);
    result.results.push_back({std::make_shared<const std::string>(std::move(*answer))});
  }
  // scene.changed speaks of the whole, not of its last part.
  context.transaction.about({});
  return result;
}

}  // namespace

void add_edit_commands(std::vector<Command>& t) {
  t.push_back(scene_command<UndoResult, HistoryParams, &undo>("edit.undo", Role::Control, "Take the last edit back."));
  t.push_back(
      scene_command<RedoResult, HistoryParams, &redo>("edit.redo", Role::Control, "Do again what was taken back last."));
  t.push_back(edit_command<&apply_edits>(
      "edit.apply", Role::Control, "Several edits as one: one revision, one step to undo, all or nothing.", Shape::HeavyEdit));
}

}  // namespace tweend::commands
