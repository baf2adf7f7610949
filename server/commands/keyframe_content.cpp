#include "server/commands/keyframe_content.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "server/model/evaluate.hpp"

namespace tweend::commands {

void VerticesParams::describe(FieldList<VerticesParams>& f) {
  using T = VerticesParams;
  f.add<&T::positions>("positions", "x, y, z of each vertex, model space, metres.");
  f.add<&T::normals>("normals", "x, y, z of each vertex; computed if left out.");
  f.add<&T::positions_base64>("positions_base64", "The same as base64 of little-endian float32.");
  f.add<&T::normals_base64>("normals_base64", "The same as base64 of little-endian float32.");
}

Status VerticesParams::check() const {
  if (positions.has_value() == positions_base64.has_value()) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected positions or positions_base64, found {}", positions ? "both" : "neither"), "positions");
  }
  if (normals && normals_base64)
    return fail(ErrorCode::InvalidParams, "expected normals or normals_base64, found both", "normals");
  return {};
}

Status KeyframeContent::check_content() const {
  const bool of_pose = pose || weights;
  if (vertices && of_pose) {
    return fail(ErrorCode::InvalidParams, "expected vertices or a pose, found both", pose ? "pose" : "weights");
  }
  if (captures() && (vertices || of_pose)) {
    return fail(ErrorCode::InvalidParams, "expected pose, vertices or capture: true, found more than one", "capture");
  }
  if (sparse.value_or(false) && !of_pose) {
    return fail(ErrorCode::InvalidParams, "expected a pose or weights with sparse: true, found none", "sparse");
  }
  for (const auto& [tangents, name] :
       {std::pair{&weights_in_tangent, "weights_in_tangent"}, std::pair{&weights_out_tangent, "weights_out_tangent"}}) {
    if (!tangents->has_value()) continue;
    if (weights && weights->size() == (*tangents)->size()) continue;
    return fail(
        ErrorCode::InvalidParams,
        fmt::format("expected as many as there are weights, {}, found {}", weights ? weights->size() : 0, (*tangents)->size()),
        name);
  }
  return {};
}

namespace {

std::span<const float> either(const std::optional<std::vector<float>>& plain,
                              const std::optional<protocol::Base64Floats>& packed) {
  if (plain) return *plain;
  if (packed) return packed->values;
  return {};
}

Result<model::VertexKeyPtr> given_vertices(const VerticesParams& p, const model::Mesh& mesh) {
  auto key = model::VertexKey::make(mesh, either(p.positions, p.positions_base64), either(p.normals, p.normals_base64));
  if (key) return *key;
  const bool packed = key.error().path == "positions" ? p.positions_base64.has_value() : p.normals_base64.has_value();
  return fail(key.error().code, key.error().message, "params.vertices." + key.error().path + (packed ? "_base64" : ""));
}

Result<model::VertexKeyPtr> captured_vertices(const model::Actor& actor, const stage::ActorShow& show) {
  std::vector<float> block(6 * actor.model->vertex_count());
  const std::span<float> positions = std::span(block).first(block.size() / 2);
  const std::span<float> normals = std::span(block).subspan(block.size() / 2);
  TWEEND_TRY(model::Evaluator().vertices(*show.actor, show.shown, {positions, normals, {}}));
  return model::VertexKey::make(*actor.model->mesh, positions, normals);
}

Status add_given_weights(const KeyframeContent& p, const model::Actor& actor, KeyedPose& out) {
  const std::size_t count = actor.model->weight_count();
  if (p.weights->size() != count) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected the weights of the {} morph targets of the actor \"{}\", found {}", count, actor.name,
                            p.weights->size()),
                "params.weights");
  }
  const auto at = [](const std::optional<std::vector<float>>& list, std::size_t i) {
    return glm::vec4(list ? (*list)[i] : 0.0F, 0.0F, 0.0F, 0.0F);
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    out.set({i, animation::Property::Weight}, at(p.weights, i), {at(p.weights_in_tangent, i), at(p.weights_out_tangent, i)});
  }
  return {};
}

void add_key(const model::PoseKey& key, KeyedPose& out) {
  for (std::size_t i = 0; i < key.values().size(); ++i) {
    const model::KeyedValue& v = key.values()[i];
    out.set(v.channel, v.value, key.tangents().empty() ? model::KeyedTangents{} : key.tangents()[i]);
  }
}

/// What is not named is as the clip shows it, but for what the keyframe itself holds.
Result<model::PoseKeyPtr> given_pose(const KeyframeContent& p, const model::ActorPtr& actor, const model::ClipPtr& clip,
                                     double time_s, const model::PoseKey* before) {
  KeyedPose pose;
  if (!p.sparse.value_or(false)) {
    model::Evaluator evaluator;
    add_whole_pose(*actor->model, evaluator.pose(*actor, model::shown_clip(clip, time_s)), pose);
  }
  if (before != nullptr) add_key(*before, pose);
  if (p.pose) TWEEND_TRY(add_given_pose(*actor, *p.pose, pose));
  if (p.weights) TWEEND_TRY(add_given_weights(p, *actor, pose));
  return std::move(pose).key();
}

model::PoseKeyPtr captured_pose(const stage::ActorShow& show) {
  KeyedPose pose;
  model::Evaluator evaluator;
  add_whole_pose(*show.actor->model, evaluator.pose(*show.actor, show.shown), pose);
  return std::move(pose).key();
}

/// What the actor shows at this moment. One whose creation is not published yet has no player: it shows its first clip from
/// the start.
stage::ActorShow shown_now(const model::ActorPtr& actor, const EditContext& context) {
  const stage::Player* player = context.view ? context.view->find_player(actor->name) : nullptr;
  if (player != nullptr) return stage::show_actor(actor, *player, context.now_us);
  stage::ActorShow show;
  show.actor = actor;
  show.clip = actor->clips.front();
  show.shown = model::shown_clip(show.clip, 0.0);
  return show;
}

/// Which of both a capture for this clip records.
model::ClipType captured_type(const model::Actor& actor, const model::Clip& clip, const stage::ActorShow& show) {
  if (clip.type() != model::ClipType::None) return clip.type();
  if (!actor.model->skeleton) return model::ClipType::Vertex;
  return actor.model->mesh && show.clip->type() == model::ClipType::Vertex ? model::ClipType::Vertex
                                                                           : model::ClipType::Skeletal;
}

Status check_type(const KeyframeContent& p, const model::Actor& actor, const model::Clip& clip) {
  if (p.vertices && !actor.model->mesh) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected a pose: the actor \"{}\" is a skeleton alone", actor.name),
                "params.vertices");
  }
  if (p.vertices && clip.type() == model::ClipType::Skeletal) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected a pose: the keyframes of the clip \"{}\" are poses", clip.name),
                "params.vertices");
  }
  if ((p.pose || p.weights) && clip.type() == model::ClipType::Vertex) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected vertices: those are what the keyframes of the clip \"{}\" hold", clip.name),
                p.pose ? "params.pose" : "params.weights");
  }
  return {};
}

Result<KeyContent> capture(const model::ActorPtr& actor, const model::Clip& clip, EditContext& context) {
  const stage::ActorShow show = shown_now(actor, context);
  const bool vertices = captured_type(*actor, clip, show) == model::ClipType::Vertex;
  // The same actor, player and reading show the same: what was worked out before the strand's turn still holds.
  const std::string picture = fmt::format("capture {} {} {}", fmt::ptr(actor.get()), vertices, fmt::ptr(context.view.get()));
  return context.once(picture, [&]() -> Result<KeyContent> {
    if (!vertices) return KeyContent{nullptr, captured_pose(show)};
    TWEEND_ASSIGN(model::VertexKeyPtr key, captured_vertices(*actor, show));
    return KeyContent{std::move(key), nullptr};
  });
}

}  // namespace

Result<KeyContent> make_content(const KeyframeContent& p, const model::ActorPtr& actor, const model::ClipPtr& clip,
                                double time_s, const model::PoseKey* before, EditContext& context) {
  TWEEND_TRY(check_type(p, *actor, *clip));
  if (p.captures()) return capture(actor, *clip, context);
  if (p.vertices) {
    const std::string mesh = "vertices " + to_string(actor->model->mesh->hash());
    const Result<model::VertexKeyPtr>& key =
        context.once(mesh, [&] { return given_vertices(*p.vertices, *actor->model->mesh); });
    if (!key) return key.error();
    return KeyContent{*key, nullptr};
  }
  const std::string moment = fmt::format("pose {} {} {}", fmt::ptr(actor.get()), fmt::ptr(clip.get()), time_s);
  const Result<model::PoseKeyPtr>& key = context.once(moment, [&] { return given_pose(p, actor, clip, time_s, before); });
  if (!key) return key.error();
  return KeyContent{nullptr, *key};
}

}  // namespace tweend::commands
