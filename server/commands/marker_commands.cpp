#include <fmt/format.h>

#include <algorithm>

#include "server/commands/command_table.hpp"

namespace tweend::commands {
namespace {

struct MarkerAddParams : EditTarget {
  static constexpr std::string_view kName = "MarkerAddParams";
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  double time = 0.0;
  protocol::Name name;
  static void describe(FieldList<MarkerAddParams>& f) {
    using T = MarkerAddParams;
    add_edit_fields(f);
    add_actor_field(f);
    add_clip_field(f);
    f.add<&T::time>("time", "Media seconds; beyond the clip's end it is not reached.", protocol::kNotNegative);
    f.add<&T::name>("name", "What it is called; several may be called the same.");
  }
};

struct MarkerAddResult {
  static constexpr std::string_view kName = "MarkerAdded";
  std::int64_t marker = 0;
  std::uint64_t revision = 0;
  static void describe(FieldList<MarkerAddResult>& f) {
    f.add<&MarkerAddResult::marker>("marker", "Its id.");
    f.add<&MarkerAddResult::revision>("revision", "The scene's new revision.");
  }
};

struct MarkerRemoveParams : EditTarget {
  static constexpr std::string_view kName = "MarkerRemoveParams";
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  std::int64_t marker = 0;
  static void describe(FieldList<MarkerRemoveParams>& f) {
    using T = MarkerRemoveParams;
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&T::clip>("clip", "Name of the clip; found by the marker's id if left out.");
    f.add<&T::marker>("marker", "Its id.");
  }
};

struct MarkerListParams {
  static constexpr std::string_view kName = "MarkerListParams";
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  static void describe(FieldList<MarkerListParams>& f) {
    add_scene_field(f);
    add_actor_field(f);
    add_clip_field(f);
  }
};

struct MarkerState {
  static constexpr std::string_view kName = "Marker";
  std::int64_t marker = 0;
  double time = 0.0;
  std::string name;
  static void describe(FieldList<MarkerState>& f) {
    using T = MarkerState;
    f.add<&T::marker>("marker", "Its id.");
    f.add<&T::time>("time", "Media seconds.");
    f.add<&T::name>("name", "What it is called.");
  }
};

struct MarkerListResult {
  static constexpr std::string_view kName = "MarkerList";
  std::vector<MarkerState> markers;
  static void describe(FieldList<MarkerListResult>& f) { f.add<&MarkerListResult::markers>("markers", "In order of time."); }
};

Result<MarkerAddResult> add_marker(const MarkerAddParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  TWEEND_ASSIGN(const model::ClipPtr clip, find_clip(*actor, p.clip, context.view));
  const std::size_t most = context.services.limits.markers_per_clip;
  if (clip->markers && clip->markers->size() >= most) {
    return fail(ErrorCode::Limit, fmt::format("expected at most {} markers in a clip, found as many; remove one first", most));
  }
  const model::KeyframeId id = context.transaction.new_keyframe_id();
  context.transaction.apply(stage::SetMarker{actor->name, clip->name, id, model::Marker{id, p.time, p.name.text}});
  context.transaction.about({actor->name, clip->name, {}});
  return MarkerAddResult{id, 0};
}

bool has_marker(const model::Clip& clip, model::KeyframeId id) {
  return clip.markers && std::any_of(clip.markers->begin(), clip.markers->end(), [id](const auto& m) { return m.id == id; });
}

Result<RevisionResult> remove_marker(const MarkerRemoveParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  if (p.clip && !actor->find_clip(*p.clip)) return no_such_clip(*actor, *p.clip);
  for (const model::ClipPtr& clip : actor->clips) {
    if ((p.clip && clip->name != *p.clip) || !has_marker(*clip, p.marker)) continue;
    context.transaction.apply(stage::SetMarker{actor->name, clip->name, p.marker, {}});
    context.transaction.about({actor->name, clip->name, {}});
    return RevisionResult{};
  }
  return fail(ErrorCode::NotFound,
              fmt::format("expected the id of a marker of the actor \"{}\", found {}; marker.list names those of a clip",
                          actor->name, p.marker),
              "params.marker");
}

Result<MarkerListResult> list_markers(const MarkerListParams& p, const QueryContext& context) {
  const stage::SceneViewPtr view = context.view->find(scene_or_main(p.scene));
  if (!view) return no_such_scene(scene_or_main(p.scene));
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(*view->scene, p.actor));
  TWEEND_ASSIGN(const model::ClipPtr clip, find_clip(*actor, p.clip, view));
  MarkerListResult result;
  if (!clip->markers) return result;
  for (const model::Marker& m : *clip->markers) result.markers.push_back({m.id, m.time_s, m.name});
  return result;
}

}  // namespace

void add_marker_commands(std::vector<Command>& t) {
  t.push_back(
      edit_command<&add_marker>("marker.add", Role::Control, "Name an instant of a clip: events tell when it is passed."));
  t.push_back(edit_command<&remove_marker>("marker.remove", Role::Control, "Remove a marker."));
  t.push_back(query_command<&list_markers>("marker.list", Role::View, "The markers of a clip.", Shape::WorkerQuery));
}

}  // namespace tweend::commands
