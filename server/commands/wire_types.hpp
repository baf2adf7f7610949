#pragma once

#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/type_info.hpp"
#include "server/model/scene.hpp"
#include "server/stage/show.hpp"

// Parts of requests and results that several commands share. Field names and meanings are docs/PROTOCOL.md's.

namespace tweend::commands {

/// What a clip holds, on the wire.
enum class WireClipType : std::uint8_t { Vertex, Skeletal };

/// What becomes of a command whose reading is past.
enum class Late : std::uint8_t { Run, Error };

}  // namespace tweend::commands

namespace tweend::protocol {

template <>
struct EnumNames<commands::WireClipType> {
  static constexpr std::array<std::string_view, 2> kNames{"vertex", "skeletal"};
};
template <>
struct EnumNames<commands::Late> {
  static constexpr std::array<std::string_view, 2> kNames{"run", "error"};
};
template <>
struct EnumNames<animation::Interpolation> {
  static constexpr std::array<std::string_view, 4> kNames{"step", "linear", "catmull_rom", "cubic"};
};
template <>
struct EnumNames<stage::Loop> {
  static constexpr std::array<std::string_view, 3> kNames{"once", "repeat", "ping_pong"};
};

}  // namespace tweend::protocol

namespace tweend::commands {

using animation::Interpolation;
using protocol::FieldList;
using protocol::Nullable;

/// `scene?`: main where it is left out.
[[nodiscard]] inline std::string scene_or_main(const std::optional<std::string>& scene) { return scene.value_or("main"); }

/// Parameters that every edit takes. Derive, and call add_edit_fields first in describe().
struct EditTarget {
  std::optional<std::string> scene;
  std::optional<std::uint64_t> base_revision;
  std::optional<std::string> retry_key;
};

template <class T>
void add_scene_field(FieldList<T>& f) {
  f.template add<&T::scene>("scene", "Name of the scene; main if left out.");
}
template <class T>
void add_edit_fields(FieldList<T>& f) {
  add_scene_field(f);
  f.template add<&T::base_revision>("base_revision", "Refuse the edit if the scene has gone past this revision.");
  f.template add<&T::retry_key>("retry_key",
                                "The client's choice, 1 to 64 characters: a repetition is answered as the first was.");
}
template <class T>
void add_actor_field(FieldList<T>& f) {
  f.template add<&T::actor>("actor", "Name of the actor; may be left out where the scene has one.");
}
template <class T>
void add_clip_field(FieldList<T>& f) {
  f.template add<&T::clip>("clip", "Name of the clip; the player's clip if left out.");
}

/// Parameters of what can be scheduled. Derive, and call add_timed_fields in describe().
struct Timed {
  std::optional<std::int64_t> at_us;
  std::optional<Late> late;
};

template <class T>
void add_timed_fields(FieldList<T>& f) {
  f.template add<&T::at_us>("at_us", "A reading of the server's steady clock (server.ping): carried out as of then.");
  f.template add<&T::late>("late", "What becomes of it where at_us is past; run, as of now, if left out.");
}

struct ScheduledResult {
  static constexpr std::string_view kName = "ScheduledCommand";
  std::int64_t scheduled = 0;
  std::int64_t at_us = 0;
  static void describe(FieldList<ScheduledResult>& f) {
    f.add<&ScheduledResult::scheduled>("scheduled", "Its id, for schedule.cancel.");
    f.add<&ScheduledResult::at_us>("at_us", "The reading as of which it will be carried out.");
  }
};

struct RevisionResult {
  static constexpr std::string_view kName = "Revision";
  std::uint64_t revision = 0;
  static void describe(FieldList<RevisionResult>& f) {
    f.add<&RevisionResult::revision>("revision", "The scene's new revision.");
  }
};

struct EmptyResult {
  static constexpr std::string_view kName = "Empty";
  static void describe(FieldList<EmptyResult>&) {}
};

struct TransformParams {
  static constexpr std::string_view kName = "Transform";
  std::optional<glm::vec3> translation;
  std::optional<glm::quat> rotation;
  std::optional<glm::vec3> scale;
  static void describe(FieldList<TransformParams>& f) {
    using T = TransformParams;
    f.add<&T::translation>("translation", "Metres.");
    f.add<&T::rotation>("rotation", "Quaternion [x, y, z, w]; normalised.");
    f.add<&T::scale>("scale", "Factors along x, y and z.");
  }
  void apply_to(model::Transform& t) const {
    t.translation = translation.value_or(t.translation);
    t.rotation = rotation.value_or(t.rotation);
    t.scale = scale.value_or(t.scale);
  }
};

/// A joint as `scene.describe` and the layout of a pose stream tell it.
struct JointState {
  static constexpr std::string_view kName = "Joint";
  std::string name;
  std::optional<std::string> parent;
  static void describe(FieldList<JointState>& f) {
    f.add<&JointState::name>("name", "Its name.");
    f.add<&JointState::parent>("parent", "The parent's name; a root has none.");
  }
};

/// In the skeleton's order.
[[nodiscard]] std::vector<JointState> joint_states(const model::Model& model);
/// Names of the morph targets.
[[nodiscard]] std::vector<std::string> weight_names(const model::Model& model);

/// A player as `playback.*` and `scene.describe` tell it.
struct PlayerState {
  static constexpr std::string_view kName = "Player";
  std::string actor;
  std::string clip;
  bool playing = false;
  double time = 0.0;
  double speed = 1.0;
  stage::Loop loop = stage::Loop::Repeat;
  std::array<double, 2> range{};
  double duration = 0.0;
  static void describe(FieldList<PlayerState>& f) {
    using T = PlayerState;
    f.add<&T::actor>("actor", "Name of the actor.");
    f.add<&T::clip>("clip", "The clip it is on.");
    f.add<&T::playing>("playing", "Whether its time runs.");
    f.add<&T::time>("time", "Media seconds.");
    f.add<&T::speed>("speed", "Media seconds a clock second; negative: backwards.");
    f.add<&T::loop>("loop", "What happens at the range's end.");
    f.add<&T::range>("range", "[in, out], media seconds.");
    f.add<&T::duration>("duration", "Of the clip, seconds.");
  }
};

[[nodiscard]] PlayerState player_state(const stage::SceneView& view, std::size_t player, ClockUs at_us);

struct PlayersResult {
  static constexpr std::string_view kName = "Players";
  std::vector<PlayerState> players;
  std::int64_t server_time_us = 0;
  static void describe(FieldList<PlayersResult>& f) {
    f.add<&PlayersResult::players>("players", "The players concerned.");
    f.add<&PlayersResult::server_time_us>("server_time_us", "The steady clock's reading at which these times hold.");
  }
};

[[nodiscard]] PlayersResult players_result(const stage::SceneView& view, const std::vector<std::size_t>& players,
                                           ClockUs at_us);

// Looking things up, with errors that name the parameter.

[[nodiscard]] Error no_such_scene(const std::string& scene);
[[nodiscard]] Error no_such_actor(const model::Scene& scene, const std::string& actor);
/// What asks for vertices of an actor that is a skeleton alone.
[[nodiscard]] Error no_mesh(const model::Actor& actor);
/// What asks for the pose of an actor that has no joints.
[[nodiscard]] Error no_skeleton(const model::Actor& actor);
[[nodiscard]] Error no_such_clip(const model::Actor& actor, const std::string& clip);
/// `actor?`: the named one, or the only one.
[[nodiscard]] Result<model::ActorPtr> find_actor(const model::Scene& scene, const std::optional<std::string>& actor);
/// What `*.sample` looks at.
struct Moment {
  double time_s = 0.0;  ///< of the clip
  model::Shown shown;
};
/// `clip?` and `time?`: that clip at that time, clamped to it. Without a time: what is shown now; of another clip than the
/// player is on, that clip at the player's time.
[[nodiscard]] Result<Moment> moment_of(const model::ActorPtr& actor, const std::optional<std::string>& clip,
                                       std::optional<double> time_s, const stage::SceneViewPtr& view, ClockUs now_us);

/// `clip?`: the named one, or the one that the published player is on.
[[nodiscard]] Result<model::ClipPtr> find_clip(const model::Actor& actor, const std::optional<std::string>& clip,
                                               const stage::SceneViewPtr& view);

}  // namespace tweend::commands
