#include <fmt/format.h>

#include <memory>

#include "server/commands/command_table.hpp"
#include "server/commands/edit_helpers.hpp"
#include "server/commands/keyframe_content.hpp"

namespace tweend::commands {
namespace {

/// x1, y1, x2, y2 of a CSS cubic-bezier; the x may not run backwards.
Status check_easing(const std::array<double, 4>& e) {
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    if (e[i] < 0.0 || e[i] > 1.0) {
      return fail(ErrorCode::InvalidParams, fmt::format("expected x1 and x2 from 0 to 1, found {}", e[i]),
                  fmt::format("easing[{}]", i));
    }
  }
  return {};
}

animation::CubicBezier bezier(const std::array<double, 4>& e) { return {e[0], e[1], e[2], e[3]}; }

struct KeyframeAddParams : KeyframeContent {
  static constexpr std::string_view kName = "KeyframeAddParams";
  std::optional<Interpolation> interpolation;
  std::optional<std::array<double, 4>> easing;
  static void describe(FieldList<KeyframeAddParams>& f) {
    using T = KeyframeAddParams;
    add_edit_fields(f);
    add_actor_field(f);
    add_clip_field(f);
    add_content_fields(f);
    f.add<&T::interpolation>("interpolation", "Towards the next keyframe.");
    f.add<&T::easing>("easing", "[x1, y1, x2, y2] of a CSS cubic-bezier, applied to the blend.");
  }
  [[nodiscard]] Status check() const {
    TWEEND_TRY(check_content());
    if (!says_anything()) {
      return fail(ErrorCode::InvalidParams, "expected pose, vertices or capture: true, found none of them", "vertices");
    }
    if (easing) return check_easing(*easing);
    return {};
  }
};

struct KeyframeAddResult {
  static constexpr std::string_view kName = "KeyframeAdded";
  std::int64_t keyframe = 0;
  std::uint64_t index = 0;
  double time = 0.0;
  std::uint64_t revision = 0;
  static void describe(FieldList<KeyframeAddResult>& f) {
    using T = KeyframeAddResult;
    f.add<&T::keyframe>("keyframe", "Its id, never used again.");
    f.add<&T::index>("index", "Its place in the clip, from 0.");
    f.add<&T::time>("time", "Media seconds.");
    f.add<&T::revision>("revision", "The scene's new revision.");
  }
};

struct KeyframeUpdateParams : KeyframeContent {
  static constexpr std::string_view kName = "KeyframeUpdateParams";
  std::int64_t keyframe = 0;
  Nullable<Interpolation> interpolation;
  Nullable<std::array<double, 4>> easing;
  static void describe(FieldList<KeyframeUpdateParams>& f) {
    using T = KeyframeUpdateParams;
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&T::clip>("clip", "Name of the clip; may be left out, the id says which.");
    f.add<&T::keyframe>("keyframe", "Its id.");
    add_content_fields(f);
    f.add<&T::interpolation>("interpolation", "Towards the next keyframe; null: as actor and clip say.");
    f.add<&T::easing>("easing", "[x1, y1, x2, y2] of a CSS cubic-bezier; null: none.");
  }
  [[nodiscard]] Status check() const {
    TWEEND_TRY(check_content());
    if (easing && *easing) return check_easing(**easing);
    return {};
  }
};

struct KeyframeMoveParams : EditTarget {
  static constexpr std::string_view kName = "KeyframeMoveParams";
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  std::int64_t keyframe = 0;
  double time = 0.0;
  static void describe(FieldList<KeyframeMoveParams>& f) {
    using T = KeyframeMoveParams;
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&T::clip>("clip", "Name of the clip; may be left out, the id says which.");
    f.add<&T::keyframe>("keyframe", "Its id.");
    f.add<&T::time>("time", "Media seconds, not negative.", protocol::kNotNegative);
  }
};

struct KeyframeRemoveParams : EditTarget {
  static constexpr std::string_view kName = "KeyframeRemoveParams";
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  std::int64_t keyframe = 0;
  static void describe(FieldList<KeyframeRemoveParams>& f) {
    using T = KeyframeRemoveParams;
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&T::clip>("clip", "Name of the clip; may be left out, the id says which.");
    f.add<&T::keyframe>("keyframe", "Its id.");
  }
};

struct KeyframeListParams {
  static constexpr std::string_view kName = "KeyframeListParams";
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  static void describe(FieldList<KeyframeListParams>& f) {
    add_scene_field(f);
    add_actor_field(f);
    add_clip_field(f);
  }
};

struct KeyframeState {
  static constexpr std::string_view kName = "Keyframe";
  std::int64_t keyframe = 0;
  double time = 0.0;
  Interpolation interpolation = Interpolation::Linear;
  std::optional<std::array<double, 4>> easing;
  std::optional<std::vector<std::string>> joints;
  static void describe(FieldList<KeyframeState>& f) {
    using T = KeyframeState;
    f.add<&T::keyframe>("keyframe", "Its id.");
    f.add<&T::time>("time", "Media seconds.");
    f.add<&T::interpolation>("interpolation", "In force towards the next keyframe.");
    f.add<&T::easing>("easing", "[x1, y1, x2, y2] of a CSS cubic-bezier.");
    f.add<&T::joints>("joints", "Of a skeletal clip: names of the joints it keys.");
  }
};

struct KeyframeListResult {
  static constexpr std::string_view kName = "KeyframeList";
  std::vector<KeyframeState> keyframes;
  double duration = 0.0;
  bool closed = false;
  static void describe(FieldList<KeyframeListResult>& f) {
    using T = KeyframeListResult;
    f.add<&T::keyframes>("keyframes", "In ascending order of time.");
    f.add<&T::duration>("duration", "Of the clip, seconds.");
    f.add<&T::closed>("closed", "Whether the clip blends back to its first keyframe.");
  }
};

struct Found {
  model::ActorPtr actor;
  model::ClipPtr clip;
  std::size_t index = 0;
};

/// A keyframe by its id, in the clip that is named or in whichever of the actor's has it.
Result<Found> find_keyframe(const std::optional<std::string>& actor_name, const std::optional<std::string>& clip_name,
                            model::KeyframeId id, const EditContext& context) {
  TWEEND_ASSIGN(model::ActorPtr actor, find_actor(context.scene(), actor_name));
  if (clip_name && !actor->find_clip(*clip_name)) return no_such_clip(*actor, *clip_name);
  for (const model::ClipPtr& clip : actor->clips) {
    if (clip_name && clip->name != *clip_name) continue;
    if (const auto index = clip->index_of(id)) return Found{actor, clip, *index};
  }
  return fail(
      ErrorCode::NotFound,
      fmt::format("expected the id of a keyframe of the actor \"{}\", found {}; keyframe.list names them", actor->name, id),
      "params.keyframe");
}

Result<KeyframeAddResult> add_keyframe(const KeyframeAddParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  TWEEND_ASSIGN(const model::ClipPtr clip, find_clip(*actor, p.clip, context.view));
  if (const std::size_t most = context.services.limits.keyframes_per_clip; clip->keyframes.size() >= most) {
    return fail(ErrorCode::Limit,
                fmt::format("expected at most {} keyframes in a clip, found as many; remove one first", most));
  }
  const double time_s = p.time.value_or(clip->times_s.empty() ? 0.0 : clip->times_s.back() + 1.0);
  TWEEND_TRY(check_keyframe_time(*clip, time_s));
  TWEEND_ASSIGN(const KeyContent content, make_content(p, actor, clip, time_s, nullptr, context));

  model::Keyframe keyframe{context.transaction.new_keyframe_id(), p.interpolation, {}, content.vertices, content.pose};
  if (p.easing) keyframe.easing = bezier(*p.easing);
  const KeyframeAddResult result{keyframe.id, clip->place_of(time_s), time_s, 0};
  context.transaction.apply(stage::SetKeyframe{actor->name, clip->name, keyframe.id, stage::TimedKeyframe{time_s, keyframe}});
  context.transaction.about({actor->name, clip->name, keyframe.id});
  return result;
}

/// Puts a changed keyframe back, perhaps at another time.
Result<RevisionResult> replace_keyframe(const Found& found, double time_s, const model::Keyframe& keyframe,
                                        EditContext& context) {
  if (time_s != found.clip->times_s[found.index]) TWEEND_TRY(check_keyframe_time(*found.clip, time_s, keyframe.id));
  context.transaction.apply(
      stage::SetKeyframe{found.actor->name, found.clip->name, keyframe.id, stage::TimedKeyframe{time_s, keyframe}});
  context.transaction.about({found.actor->name, found.clip->name, keyframe.id});
  return RevisionResult{};
}

Result<RevisionResult> update_keyframe(const KeyframeUpdateParams& p, EditContext& context) {
  TWEEND_ASSIGN(const Found found, find_keyframe(p.actor, p.clip, p.keyframe, context));
  model::Keyframe keyframe = found.clip->keyframes[found.index];
  const double time_s = p.time.value_or(found.clip->times_s[found.index]);
  if (p.says_anything()) {
    TWEEND_ASSIGN(const KeyContent content, make_content(p, found.actor, found.clip, time_s, keyframe.pose.get(), context));
    keyframe.vertices = content.vertices;
    keyframe.pose = content.pose;
  }
  keyframe.interpolation = p.interpolation.value_or(keyframe.interpolation);
  if (p.easing) keyframe.easing = *p.easing ? std::optional(bezier(**p.easing)) : std::nullopt;
  return replace_keyframe(found, time_s, keyframe, context);
}

Result<RevisionResult> move_keyframe(const KeyframeMoveParams& p, EditContext& context) {
  TWEEND_ASSIGN(const Found found, find_keyframe(p.actor, p.clip, p.keyframe, context));
  return replace_keyframe(found, p.time, found.clip->keyframes[found.index], context);
}

Result<RevisionResult> remove_keyframe(const KeyframeRemoveParams& p, EditContext& context) {
  TWEEND_ASSIGN(const Found found, find_keyframe(p.actor, p.clip, p.keyframe, context));
  context.transaction.apply(stage::SetKeyframe{found.actor->name, found.clip->name, p.keyframe, {}});
  context.transaction.about({found.actor->name, found.clip->name, p.keyframe});
  return RevisionResult{};
}

std::vector<std::string> keyed_joints(const model::PoseKey& pose, const model::Skeleton& skeleton) {
  std::vector<std::string> names;
  std::optional<std::uint32_t> last;
  for (const model::KeyedValue& v : pose.values()) {  // by joint, then property
    if (v.channel.property == animation::Property::Weight || v.channel.target == last) continue;
    last = v.channel.target;
    names.push_back(skeleton.joints()[v.channel.target].name);
  }
  return names;
}

Result<KeyframeListResult> list_keyframes(const KeyframeListParams& p, const QueryContext& context) {
  const stage::SceneViewPtr view = context.view->find(scene_or_main(p.scene));
  if (!view) return no_such_scene(scene_or_main(p.scene));
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(*view->scene, p.actor));
  TWEEND_ASSIGN(const model::ClipPtr clip, find_clip(*actor, p.clip, view));
  KeyframeListResult result{{}, clip->duration_s(), clip->settings.closed};
  for (std::size_t i = 0; i < clip->keyframes.size(); ++i) {
    const model::Keyframe& k = clip->keyframes[i];
    KeyframeState state{k.id, clip->times_s[i], model::effective_interpolation(*actor, *clip, i), {}, {}};
    if (k.easing) state.easing = std::array{k.easing->x1, k.easing->y1, k.easing->x2, k.easing->y2};
    if (k.pose) state.joints = keyed_joints(*k.pose, *actor->model->skeleton);
    result.keyframes.push_back(std::move(state));
  }
  return result;
}

}  // namespace

void add_keyframe_commands(std::vector<Command>& t) {
  t.push_back(edit_command<&add_keyframe>("keyframe.add", Role::Control, "Add a keyframe: a pose, vertices, or what is shown.",
                                          Shape::HeavyEdit));
  t.push_back(edit_command<&update_keyframe>("keyframe.update", Role::Control, "Change a keyframe; what is left out stays.",
                                             Shape::HeavyEdit));
  t.push_back(edit_command<&move_keyframe>("keyframe.move", Role::Control, "Move a keyframe in time."));
  t.push_back(edit_command<&remove_keyframe>("keyframe.remove", Role::Control, "Remove a keyframe."));
  t.push_back(query_command<&list_keyframes>("keyframe.list", Role::View, "The keyframes of a clip.", Shape::WorkerQuery));
}

}  // namespace tweend::commands
