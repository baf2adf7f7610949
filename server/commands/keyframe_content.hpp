#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/commands/command.hpp"
#include "server/commands/pose_types.hpp"

// What a keyframe is made of: the parameters that `keyframe.add` and `keyframe.update` share.

namespace tweend::commands {

/// The whole mesh at one time, as numbers or packed.
struct VerticesParams {
  static constexpr std::string_view kName = "Vertices";
  std::optional<std::vector<float>> positions, normals;
  std::optional<protocol::Base64Floats> positions_base64, normals_base64;
  static void describe(FieldList<VerticesParams>& f);
  [[nodiscard]] Status check() const;
};

struct KeyframeContent : EditTarget {
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  std::optional<double> time;
  std::optional<PoseParams> pose;
  std::optional<VerticesParams> vertices;
  std::optional<bool> capture;
  std::optional<bool> sparse;
  std::optional<std::vector<float>> weights, weights_in_tangent, weights_out_tangent;

  [[nodiscard]] bool captures() const noexcept { return capture.value_or(false); }
  /// Whether it says what a keyframe shall hold.
  [[nodiscard]] bool says_anything() const noexcept { return pose || vertices || weights || captures(); }
  /// Whether what it says can be said together.
  [[nodiscard]] Status check_content() const;
};

template <class T>
void add_content_fields(FieldList<T>& f) {
  f.template add<&T::time>("time", "Media seconds, not negative.", protocol::kNotNegative);
  f.template add<&T::pose>("pose", "By the joints' names; joints left out are keyed as the clip shows them at this time.");
  f.template add<&T::vertices>("vertices", "The whole mesh at this time.");
  f.template add<&T::capture>("capture", "Take what the actor shows at this moment.");
  f.template add<&T::sparse>("sparse", "Key only what is named.");
  f.template add<&T::weights>("weights", "Of all morph targets, in their order.");
  f.template add<&T::weights_in_tangent>("weights_in_tangent", "For cubic: a second, as each arrives.");
  f.template add<&T::weights_out_tangent>("weights_out_tangent", "For cubic: a second, as each leaves.");
}

/// One of the two.
struct KeyContent {
  model::VertexKeyPtr vertices;
  model::PoseKeyPtr pose;
};

/// What the keyframe shall hold; worked out once for the same actor and moment.
/// @param clip    where it will stand; what it keys already says which kind it takes
/// @param time_s  when
/// @param before  what the keyframe held until now, if it is to be changed; may be null
/// @return InvalidParams with a path: joints, counts, or a kind that the clip or the actor can't hold
[[nodiscard]] Result<KeyContent> make_content(const KeyframeContent& p, const model::ActorPtr& actor,
                                              const model::ClipPtr& clip, double time_s, const model::PoseKey* before,
                                              EditContext& context);

}  // namespace tweend::commands
