#include "server/model/skeleton.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace tweend::model {
namespace {

Error bad(std::size_t joint, const char* field, std::string message) {
  return fail(ErrorCode::InvalidParams, std::move(message), fmt::format("joints[{}].{}", joint, field));
}

ContentHash hash_joints(const std::vector<Joint>& joints) {
  std::vector<std::uint64_t> words;
  for (const Joint& joint : joints) {
    const animation::JointPose& r = joint.rest;
    const std::array floats{r.translation.x, r.translation.y, r.translation.z, r.rotation.x, r.rotation.y,
                            r.rotation.z,    r.rotation.w,    r.scale.x,       r.scale.y,    r.scale.z};
    const ContentHash name = hash_bytes(std::as_bytes(std::span(joint.name)));
    const ContentHash rest = hash_bytes(std::as_bytes(std::span(floats)));
    words.insert(words.end(), {name.high, name.low, static_cast<std::uint64_t>(joint.parent), rest.high, rest.low});
  }
  return hash_bytes(std::as_bytes(std::span(words)));
}

}  // namespace

Result<SkeletonPtr> Skeleton::make(std::vector<Joint> joints) {
  if (joints.empty()) return fail(ErrorCode::InvalidParams, "expected at least one joint, found none", "joints");
  const std::shared_ptr<Skeleton> skeleton(new Skeleton);
  skeleton->joints_ = std::move(joints);
  TWEEND_TRY(skeleton->name_joints());
  TWEEND_TRY(skeleton->order_joints());
  skeleton->rest_.reset(skeleton->size(), 0);
  for (std::uint32_t i = 0; i < skeleton->size(); ++i) {
    skeleton->rest_.set_joint(skeleton->place_of_[i], skeleton->joints_[i].rest);
  }
  skeleton->hash_ = hash_joints(skeleton->joints_);
  return SkeletonPtr(skeleton);
}

Status Skeleton::name_joints() {
  for (std::uint32_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].name.empty()) return bad(i, "name", "expected a name, found an empty one");
    if (!by_name_.emplace(joints_[i].name, i).second) {
      return bad(i, "name", fmt::format("expected names that are used once, found \"{}\" again", joints_[i].name));
    }
  }
  return {};
}

Status Skeleton::order_joints() {
  const std::size_t count = joints_.size();
  std::vector<std::vector<std::uint32_t>> children(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::int32_t parent = joints_[i].parent;
    if (parent < -1 || parent >= static_cast<std::int32_t>(count)) {
      return bad(i, "parent", fmt::format("expected the index of one of {} joints or -1, found {}", count, parent));
    }
    if (parent < 0) {
      joint_at_.push_back(i);
    } else {
      children[static_cast<std::size_t>(parent)].push_back(i);
    }
  }
  for (std::size_t next = 0; next < joint_at_.size(); ++next) {  // grows while it runs: level by level
    const auto& below = children[joint_at_[next]];
    joint_at_.insert(joint_at_.end(), below.begin(), below.end());
  }
  place_of_.assign(count, UINT32_MAX);
  for (std::uint32_t place = 0; place < joint_at_.size(); ++place) place_of_[joint_at_[place]] = place;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (place_of_[i] == UINT32_MAX) {
      return bad(i, "parent", fmt::format("expected a way up to a root, found that \"{}\" is above itself", joints_[i].name));
    }
  }
  for (const std::uint32_t joint : joint_at_) {
    const std::int32_t parent = joints_[joint].parent;
    parent_places_.push_back(parent < 0 ? -1 : static_cast<std::int32_t>(place_of_[static_cast<std::size_t>(parent)]));
  }
  return {};
}

std::optional<std::uint32_t> Skeleton::find(std::string_view name) const noexcept {
  const auto at = by_name_.find(name);
  if (at == by_name_.end()) return std::nullopt;
  return at->second;
}

}  // namespace tweend::model
