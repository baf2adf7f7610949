#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tweend::bench {

/// A mesh as a stream of vertices shows it, 60 times a second.
struct MovingMesh {
  struct Frame {
    std::vector<float> positions, normals;  ///< shape [vertices × 3]
  };
  std::string name;
  std::vector<Frame> frames;

  [[nodiscard]] std::size_t vertices() const noexcept { return frames.front().positions.size() / 3; }
};

inline constexpr std::size_t kMovingFrames = 12;

/// 313 rings of 320 vertices: radius 1 + 0.2 sin(3θ + 2t) sin(2φ − t).
[[nodiscard]] MovingMesh moving_sphere();
/// A cloth of 200 × 150 vertices that waves.
[[nodiscard]] MovingMesh moving_flag();
/// The first clip of a glTF file: a skinned character.
/// @param folder  with the file `name` in it; the program ends where it can't be read
[[nodiscard]] MovingMesh moving_character(const std::string& folder, const std::string& name);

/// A skeleton's pose as a stream shows it, 60 times a second.
struct MovingPose {
  std::string name;
  std::size_t joints = 0;
  std::vector<std::vector<float>> frames;  ///< shape [joints × 10] each: translation xyz, rotation xyzw, scale xyz
};

inline constexpr std::size_t kPoseFrames = 240;

/// The pose of the same, round and round.
[[nodiscard]] MovingPose moving_pose(const std::string& folder, const std::string& name);

}  // namespace tweend::bench
