#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "server/animation/track.hpp"
#include "server/model/content_hash.hpp"

namespace tweend::model {

/// One keyed value; the channel's target is a joint in the skeleton's given order, or a morph weight.
struct KeyedValue {
  animation::Channel channel;
  glm::vec4 value{0.0F};  ///< xyz; rotations unit xyzw; weights x
  bool operator==(const KeyedValue&) const = default;
};

/// Tangents of a keyed value, per second; for `cubic`.
struct KeyedTangents {
  glm::vec4 in{0.0F};
  glm::vec4 out{0.0F};
  bool operator==(const KeyedTangents&) const = default;
};

/// What a skeletal keyframe keys, all of it or a part of a pose. Immutable, shared by all revisions and readers, named by its
/// content.
class PoseKey {
 public:
  /// @param values    finite, each channel once, in any order; rotations unit length
  /// @param tangents  one for each value, or empty: zero
  PoseKey(std::vector<KeyedValue> values, std::vector<KeyedTangents> tangents = {});

  /// In ascending order of their channels.
  [[nodiscard]] std::span<const KeyedValue> values() const noexcept { return values_; }
  /// One for each value, or none at all.
  [[nodiscard]] std::span<const KeyedTangents> tangents() const noexcept { return tangents_; }
  /// Null: not keyed here.
  [[nodiscard]] const KeyedValue* find(const animation::Channel& channel) const noexcept;
  [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }

 private:
  std::vector<KeyedValue> values_;
  std::vector<KeyedTangents> tangents_;
  ContentHash hash_;
};

using PoseKeyPtr = std::shared_ptr<const PoseKey>;

}  // namespace tweend::model
