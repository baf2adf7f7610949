#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/model/scene.hpp"
#include "server/stage/change.hpp"

namespace tweend::stage {

/// What `scene.changed` tells beside the revision.
struct EditSubject {
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  std::optional<model::KeyframeId> keyframe;
};

/// How a layer that an edit sets or removes takes to its new weight: players alone know of it, it is no part of the document.
struct LayerFadeRequest {
  std::string actor;
  std::string layer;
  double length_s = 0.0;  ///< clock seconds; 0: at once
};

/// An edit in the making: a copy of the head (pointers, never vertices) that primitive changes are applied to.
/// Dropped, nothing has happened.
class Transaction {
 public:
  explicit Transaction(const model::Scene& head) : scene_(head) { ++scene_.revision; }

  /// The scene with all changes so far; its revision is the one the edit will have.
  [[nodiscard]] const model::Scene& scene() const noexcept { return scene_; }
  [[nodiscard]] std::uint64_t revision() const noexcept { return scene_.revision; }

  void apply(const Change& change) { inverses_.push_back(stage::apply(scene_, change)); }
  [[nodiscard]] model::KeyframeId new_keyframe_id() noexcept { return scene_.next_keyframe++; }
  void about(EditSubject subject) { subject_ = std::move(subject); }

  void fade_layer(LayerFadeRequest request) { layer_fades_.push_back(std::move(request)); }

  [[nodiscard]] const std::vector<LayerFadeRequest>& layer_fades() const noexcept { return layer_fades_; }
  [[nodiscard]] const EditSubject& subject() const noexcept { return subject_; }
  /// What takes the edit back, in the order to apply it.
  [[nodiscard]] std::vector<Change> undo_changes() const { return {inverses_.rbegin(), inverses_.rend()}; }

 private:
  model::Scene scene_;
  std::vector<Change> inverses_;
  EditSubject subject_;
  std::vector<LayerFadeRequest> layer_fades_;
};

}  // namespace tweend::stage
