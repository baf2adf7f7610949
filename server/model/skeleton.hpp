#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "server/animation/pose.hpp"
#include "server/base/result.hpp"
#include "server/model/content_hash.hpp"

namespace tweend::model {

/// A joint as files and commands give it.
struct Joint {
  std::string name;             ///< unique in its skeleton, verbatim UTF-8
  std::int32_t parent = -1;     ///< index of another joint, before or after it; -1: a root
  animation::JointPose rest{};  ///< where it is when nothing is keyed; the rotation is unit length
};

/// Joints in the order they were given, and the order in which to evaluate them: level by level, so that parents come first
/// and the joints of one level do not wait for each other. Immutable; safe from any thread.
///
/// "joint" below means an index in the given order, "place" one in the order of evaluation (that of animation::Pose).
class Skeleton {
 public:
  /// @param joints  at least one, any number of roots
  /// @return InvalidParams, path "joints[i].name" or "joints[i].parent": a name that is empty or taken, a parent that is not
  ///         there, or a chain of parents that comes back to where it began
  [[nodiscard]] static Result<std::shared_ptr<const Skeleton>> make(std::vector<Joint> joints);

  [[nodiscard]] std::size_t size() const noexcept { return joints_.size(); }
  [[nodiscard]] const std::vector<Joint>& joints() const noexcept { return joints_; }
  [[nodiscard]] std::optional<std::uint32_t> find(std::string_view name) const noexcept;

  [[nodiscard]] std::uint32_t place_of(std::uint32_t joint) const noexcept { return place_of_[joint]; }
  [[nodiscard]] std::uint32_t joint_at(std::uint32_t place) const noexcept { return joint_at_[place]; }
  /// By place: the parent's place, -1 of a root.
  [[nodiscard]] std::span<const std::int32_t> parent_places() const noexcept { return parent_places_; }
  /// Every joint at rest, by place; no weights.
  [[nodiscard]] const animation::Pose& rest() const noexcept { return rest_; }
  [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }

 private:
  Skeleton() = default;
  [[nodiscard]] Status name_joints();
  [[nodiscard]] Status order_joints();

  std::vector<Joint> joints_;
  std::unordered_map<std::string_view, std::uint32_t> by_name_;  ///< views into joints_
  std::vector<std::uint32_t> place_of_;
  std::vector<std::uint32_t> joint_at_;
  std::vector<std::int32_t> parent_places_;
  animation::Pose rest_;
  ContentHash hash_;
};

using SkeletonPtr = std::shared_ptr<const Skeleton>;

}  // namespace tweend::model
