#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "server/animation/joint_pose.hpp"

namespace tweend::animation {

/// The rows of a pose: one float of every joint each.
enum class PoseRow : std::uint8_t { Tx, Ty, Tz, Rx, Ry, Rz, Rw, Sx, Sy, Sz };
inline constexpr std::size_t kPoseRows = 10;

/// Rows are padded to whole vectors of this many joints; the padding holds identity poses.
inline constexpr std::size_t kPoseLanes = 16;

/// A vector of floats in memory; aligned, so that what is made of them stays aligned in copies too.
struct alignas(64) Lanes {
  std::array<float, kPoseLanes> lane{};
};

/// Local transforms of all joints of a skeleton, as a structure of arrays, and its morph weights. Joints stand in the order of
/// evaluation (parents first). Owned by one thread at a time; reused from frame to frame, so that only growing allocates.
class Pose {
 public:
  /// All joints at identity, all weights 0. Keeps its memory.
  void reset(std::size_t joint_count, std::size_t weight_count);
  /// The joints of `joints`, and so many weights of 0. Keeps its memory.
  void assign(const Pose& joints, std::size_t weight_count);

  [[nodiscard]] std::size_t joint_count() const noexcept { return joint_count_; }
  /// Floats in a row, a multiple of kPoseLanes.
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }
  /// One float of every joint, padded; 64-byte aligned.
  [[nodiscard]] std::span<float> row(PoseRow row) noexcept {
    return {first_float(rows_) + static_cast<std::size_t>(row) * stride_, stride_};
  }
  [[nodiscard]] std::span<const float> row(PoseRow row) const noexcept {
    return {first_float(rows_) + static_cast<std::size_t>(row) * stride_, stride_};
  }
  /// Morph target weights; the memory behind them goes on to a multiple of kPoseLanes.
  [[nodiscard]] std::span<float> weights() noexcept { return {first_float(weights_), weight_count_}; }
  [[nodiscard]] std::span<const float> weights() const noexcept { return {first_float(weights_), weight_count_}; }

  /// Precondition: joint < joint_count().
  [[nodiscard]] JointPose joint(std::size_t joint) const noexcept;
  void set_joint(std::size_t joint, const JointPose& pose) noexcept;

 private:
  [[nodiscard]] static float* first_float(std::vector<Lanes>& lanes) noexcept {
    return lanes.empty() ? nullptr : lanes.front().lane.data();
  }
  [[nodiscard]] static const float* first_float(const std::vector<Lanes>& lanes) noexcept {
    return lanes.empty() ? nullptr : lanes.front().lane.data();
  }

  std::size_t joint_count_ = 0;
  std::size_t stride_ = 0;
  std::size_t weight_count_ = 0;
  std::vector<Lanes> rows_;  ///< shape [kPoseRows × stride / kPoseLanes]
  std::vector<Lanes> weights_;
};

}  // namespace tweend::animation
