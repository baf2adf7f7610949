#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "server/commands/command_table.hpp"
#include "server/commands/edit_helpers.hpp"

namespace tweend::commands {
namespace {

struct ClipCreateParams : EditTarget {
  static constexpr std::string_view kName = "ClipCreateParams";
  std::optional<std::string> actor;
  protocol::Name clip;
  std::optional<WireClipType> type;
  std::optional<bool> closed;
  std::optional<double> duration;
  std::optional<Interpolation> interpolation;
  std::optional<std::vector<std::int64_t>> keys;
  static void describe(FieldList<ClipCreateParams>& f) {
    using T = ClipCreateParams;
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&T::clip>("clip", "The new clip's name.");
    f.add<&T::type>("type", "What its keyframes will hold; the first one says if left out.");
    f.add<&T::closed>("closed", "Whether it blends from its last keyframe back to the first.");
    f.add<&T::duration>("duration", "Seconds.", protocol::kPositive);
    f.add<&T::interpolation>("interpolation", "Where neither keyframe nor actor say.");
    f.add<&T::keys>(
        "keys",
        "A cue: ids of the actor's keyframes, shown in this order, evenly spaced over the duration (1 s apart if left out).");
  }
};

struct ClipUpdateParams : EditTarget {
  static constexpr std::string_view kName = "ClipUpdateParams";
  std::optional<std::string> actor;
  std::string clip;
  std::optional<bool> closed;
  Nullable<double> duration;
  Nullable<Interpolation> interpolation;
  static void describe(FieldList<ClipUpdateParams>& f) {
    using T = ClipUpdateParams;
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&T::clip>("clip", "Name of the clip.");
    f.add<&T::closed>("closed", "Whether it blends from its last keyframe back to the first.");
    f.add<&T::duration>("duration", "Seconds; null: as its keyframes give it.", protocol::kPositive);
    f.add<&T::interpolation>("interpolation", "Where neither keyframe nor actor say; null: linear.");
  }
};

struct ClipRemoveParams : EditTarget {
  static constexpr std::string_view kName = "ClipRemoveParams";
  std::optional<std::string> actor;
  std::string clip;
  static void describe(FieldList<ClipRemoveParams>& f) {
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&ClipRemoveParams::clip>("clip", "Name of the clip; an actor's only one stays.");
  }
};

struct ClipCreateResult {
  static constexpr std::string_view kName = "ClipCreated";
  std::string clip;
  std::vector<std::int64_t> keyframes;
  std::uint64_t revision = 0;
  static void describe(FieldList<ClipCreateResult>& f) {
    using T = ClipCreateResult;
    f.add<&T::clip>("clip", "Its name.");
    f.add<&T::keyframes>("keyframes", "Ids of a cue's keyframes, which are its own.");
    f.add<&T::revision>("revision", "The scene's new revision.");
  }
};

struct Found {
  const model::Clip* clip = nullptr;
  const model::Keyframe* keyframe = nullptr;
};

Found find_in_any_clip(const model::Actor& actor, model::KeyframeId id) {
  for (const model::ClipPtr& clip : actor.clips) {
    if (const auto index = clip->index_of(id)) return {clip.get(), &clip->keyframes[*index]};
  }
  return {};
}

/// What is said of the tracks in either; `own` comes first.
model::ChannelModesPtr joined_modes(const model::ChannelModesPtr& own, const model::ChannelModesPtr& other) {
  if (!other || own == other) return own;
  if (!own) return other;
  std::vector<model::ChannelMode> all;
  std::set_union(own->begin(), own->end(), other->begin(), other->end(), std::back_inserter(all),
                 [](const model::ChannelMode& a, const model::ChannelMode& b) { return a.channel < b.channel; });
  return std::make_shared<const std::vector<model::ChannelMode>>(std::move(all));
}

/// Fills the clip with those keyframes in that order, evenly spaced: an open cue's last stands at the end, a closed one's
/// leaves a spacing to blend back.
Status fill_cue(model::Clip& clip, const ClipCreateParams& p, const model::Actor& actor, stage::Transaction& transaction) {
  const std::size_t count = p.keys->size();
  const std::size_t gaps = clip.settings.closed ? count : count - 1;
  const double spacing_s = p.duration && gaps > 0 ? *p.duration / static_cast<double>(gaps) : 1.0;
  if (spacing_s < 2 * model::kSameTimeSeconds) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected a duration with room for {} keyframes, found {} s", count, *p.duration),
                "params.duration");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Found found = find_in_any_clip(actor, (*p.keys)[i]);
    if (found.keyframe == nullptr) {
      return fail(ErrorCode::NotFound,
                  fmt::format("expected ids of keyframes of the actor \"{}\", found {}; keyframe.list names them", actor.name,
                              (*p.keys)[i]),
                  fmt::format("params.keys[{}]", i));
    }
    if (i > 0 && found.clip->type() != clip.type()) {
      return fail(ErrorCode::InvalidParams, "expected keyframes of one kind, found poses among vertices",
                  fmt::format("params.keys[{}]", i));
    }
    clip.times_s.push_back(static_cast<double>(i) * spacing_s);
    clip.keyframes.push_back(*found.keyframe);
    clip.channel_modes = joined_modes(clip.channel_modes, found.clip->channel_modes);
    clip.keyframes.back().id = transaction.new_keyframe_id();
  }
  // An open cue's duration is where its last keyframe stands, and grows with it; that of a single one is held.
  if (!clip.settings.closed && gaps > 0) clip.settings.duration_s.reset();
  return {};
}

Result<ClipCreateResult> create_clip(const ClipCreateParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  if (actor->find_clip(p.clip.text)) {
    return fail(ErrorCode::Conflict, fmt::format("expected a new name, found the clip \"{}\"", p.clip.text), "params.clip");
  }
  const Limits& limits = context.services.limits;
  if (actor->clips.size() >= limits.clips_per_actor) {
    return fail(ErrorCode::Limit,
                fmt::format("expected at most {} clips an actor, found as many; remove one first", limits.clips_per_actor));
  }
  if (p.type == WireClipType::Vertex && !actor->model->mesh) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected skeletal: the actor \"{}\" has no mesh", actor->name),
                "params.type");
  }
  if (p.type == WireClipType::Skeletal && !actor->model->skeleton) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected vertex: the actor \"{}\" has no skeleton", actor->name),
                "params.type");
  }
  model::Clip clip;
  clip.name = p.clip.text;
  clip.settings = {p.closed.value_or(false), p.duration, p.interpolation};
  if (p.type) clip.declared_type = *p.type == WireClipType::Vertex ? model::ClipType::Vertex : model::ClipType::Skeletal;
  if (p.keys && !p.keys->empty()) {
    if (p.keys->size() > limits.keyframes_per_clip) {
      return fail(ErrorCode::Limit,
                  fmt::format("expected at most {} keyframes in a clip, found {}", limits.keyframes_per_clip, p.keys->size()),
                  "params.keys");
    }
    TWEEND_TRY(fill_cue(clip, p, *actor, context.transaction));
  }
  ClipCreateResult result{clip.name, {}, 0};
  for (const model::Keyframe& k : clip.keyframes) result.keyframes.push_back(k.id);
  context.transaction.apply(stage::SetClip{actor->name, result.clip, std::make_shared<const model::Clip>(std::move(clip))});
  context.transaction.about({actor->name, result.clip, {}});
  return result;
}

Result<RevisionResult> update_clip(const ClipUpdateParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  TWEEND_ASSIGN(const model::ClipPtr clip, find_clip(*actor, p.clip, nullptr));
  model::Clip changed = *clip;
  changed.settings.closed = p.closed.value_or(clip->settings.closed);
  changed.settings.duration_s = p.duration.value_or(clip->settings.duration_s);
  changed.settings.interpolation = p.interpolation.value_or(clip->settings.interpolation);
  TWEEND_TRY(check_duration(changed, p.duration ? "params.duration" : "params.closed"));
  context.transaction.apply(stage::SetClipSettings{actor->name, clip->name, changed.settings});
  context.transaction.about({actor->name, clip->name, {}});
  return RevisionResult{};
}

Result<RevisionResult> remove_clip(const ClipRemoveParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  TWEEND_ASSIGN(const model::ClipPtr clip, find_clip(*actor, p.clip, nullptr));
  if (actor->clips.size() == 1) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected another clip to remain, found \"{}\" to be the only one", clip->name), "params.clip");
  }
  for (const model::Layer& layer : actor->layers) {
    if (layer.clip != clip->name) continue;
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected a clip that no layer plays, found \"{}\" in the layer \"{}\"; layer.remove it first",
                            clip->name, layer.name),
                "params.clip");
  }
  context.transaction.apply(stage::SetClip{actor->name, clip->name, nullptr});
  context.transaction.about({actor->name, clip->name, {}});
  return RevisionResult{};
}

}  // namespace

void add_clip_commands(std::vector<Command>& t) {
  t.push_back(
      edit_command<&create_clip>("clip.create", Role::Control, "Make a clip, empty or a cue of keyframes that are there."));
  t.push_back(edit_command<&update_clip>("clip.update", Role::Control, "Change a clip; what is left out stays."));
  t.push_back(edit_command<&remove_clip>("clip.remove", Role::Control, "Remove a clip."));
}

}  // namespace tweend::commands
