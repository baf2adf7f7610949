#include <fmt/format.h>

#include <algorithm>

#include "server/commands/command_table.hpp"

namespace tweend::commands {
namespace {

/// Half of what can be shown at once: the other half is for those that fade out.
constexpr std::size_t kMostLayersOfAnActor = model::kMostLayers / 2;

struct LayerSetParams : EditTarget {
  static constexpr std::string_view kName = "LayerSetParams";
  std::optional<std::string> actor;
  protocol::Name layer;
  std::string clip;
  std::optional<float> weight;
  std::optional<bool> additive;
  std::optional<std::vector<std::string>> mask;
  std::optional<double> fade;
  static void describe(FieldList<LayerSetParams>& f) {
    using T = LayerSetParams;
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&T::layer>("layer",
                     "Its name; one of that name is replaced. Layers lie over each other in the order of their names.");
    f.add<&T::clip>("clip", "Name of the clip, of poses.");
    f.add<&T::weight>("weight", "How far it replaces what lies below, or how much of it is added; 1 if left out.",
                      {.min = 0.0, .max = 1.0});
    f.add<&T::additive>("additive", "Adds what differs from the rest pose; else, and if left out, it replaces.");
    f.add<&T::mask>("mask", "Names of the joints it touches; all, and the morph weights, if left out.");
    f.add<&T::fade>("fade", "Clock seconds in which the weight gets there, linearly.", protocol::kNotNegative);
  }
};

struct LayerRemoveParams : EditTarget {
  static constexpr std::string_view kName = "LayerRemoveParams";
  std::optional<std::string> actor;
  std::string layer;
  std::optional<double> fade;
  static void describe(FieldList<LayerRemoveParams>& f) {
    using T = LayerRemoveParams;
    add_edit_fields(f);
    add_actor_field(f);
    f.add<&T::layer>("layer", "Its name.");
    f.add<&T::fade>("fade", "Clock seconds in which its weight goes to 0, linearly.", protocol::kNotNegative);
  }
};

Status check_clip(const model::Actor& actor, const std::string& name) {
  const model::ClipPtr clip = actor.find_clip(name);
  if (!clip) return no_such_clip(actor, name);
  if (clip->type() != model::ClipType::Vertex) return {};
  return fail(ErrorCode::InvalidParams, fmt::format("expected a clip of poses, found that \"{}\" is one of vertices", name),
              "params.clip");
}

Status set_mask(const std::vector<std::string>& names, const model::Actor& actor, model::Layer& layer) {
  const model::SkeletonPtr& skeleton = actor.model->skeleton;
  auto joints = std::make_shared<std::vector<std::uint32_t>>();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto joint = skeleton ? skeleton->find(names[i]) : std::nullopt;
    if (!joint) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected the name of a joint of the actor \"{}\", found \"{}\"; scene.describe names them",
                              actor.name, names[i]),
                  fmt::format("params.mask[{}]", i));
    }
    joints->push_back(*joint);
  }
  std::sort(joints->begin(), joints->end());
  joints->erase(std::unique(joints->begin(), joints->end()), joints->end());
  auto factors = std::make_shared<std::vector<float>>(skeleton ? skeleton->size() : 0, 0.0F);
  for (const std::uint32_t joint : *joints) (*factors)[skeleton->place_of(joint)] = 1.0F;
  layer.joints = std::move(joints);
  layer.mask = std::move(factors);
  return {};
}

bool has_layer(const model::Actor& actor, const std::string& name) {
  return std::any_of(actor.layers.begin(), actor.layers.end(), [&](const model::Layer& l) { return l.name == name; });
}

Result<RevisionResult> set_layer(const LayerSetParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  TWEEND_TRY(check_clip(*actor, p.clip));
  if (actor->layers.size() >= kMostLayersOfAnActor && !has_layer(*actor, p.layer.text)) {
    return fail(ErrorCode::Limit,
                fmt::format("expected at most {} layers an actor, found as many; remove one first", kMostLayersOfAnActor));
  }
  model::Layer layer{p.layer.text, p.clip, p.weight.value_or(1.0F), p.additive.value_or(false), nullptr, nullptr};
  if (p.mask) TWEEND_TRY(set_mask(*p.mask, *actor, layer));
  context.transaction.apply(stage::SetLayer{actor->name, layer.name, layer});
  context.transaction.fade_layer({actor->name, layer.name, p.fade.value_or(0.0)});
  context.transaction.about({actor->name, p.clip, {}});
  return RevisionResult{};
}

Result<RevisionResult> remove_layer(const LayerRemoveParams& p, EditContext& context) {
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(context.scene(), p.actor));
  if (!has_layer(*actor, p.layer)) {
    return fail(
        ErrorCode::NotFound,
        fmt::format("expected a layer of the actor \"{}\", found \"{}\"; scene.describe names them", actor->name, p.layer),
        "params.layer");
  }
  context.transaction.apply(stage::SetLayer{actor->name, p.layer, {}});
  context.transaction.fade_layer({actor->name, p.layer, p.fade.value_or(0.0)});
  context.transaction.about({actor->name, {}, {}});
  return RevisionResult{};
}

}  // namespace

void add_layer_commands(std::vector<Command>& t) {
  t.push_back(edit_command<&set_layer>("layer.set", Role::Control, "Blend a clip over the player's, or change how."));
  t.push_back(edit_command<&remove_layer>("layer.remove", Role::Control, "Remove a layer."));
}

}  // namespace tweend::commands
