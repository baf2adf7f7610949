#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "server/animation/track.hpp"

// What the benchmarks of skeletal animation play: a character that moves all its joints, and the usual way to play it.

namespace tweend::bench {

/// Dense keys, 30 a second, of every joint.
struct CharacterClip {
  /// @param moves  whether translations and scales have keys too, or rotations only
  CharacterClip(std::size_t joints, double duration_s, bool moves, std::uint32_t seed = 1);

  [[nodiscard]] std::size_t joint_count() const noexcept { return parents.size(); }
  [[nodiscard]] animation::TrackSet packed() const;
  /// A pose of this many joints at rest, as memory to sample into.
  [[nodiscard]] animation::Pose rest_pose() const;
  /// For three/mixer.mjs: parents, rest, times and keys, xyzw, as JSON.
  void write_json(const std::string& path) const;

  double duration_s;
  bool moves;
  std::vector<std::int32_t> parents;
  std::vector<glm::vec3> rest_translations;
  std::vector<double> times_s;
  std::vector<std::vector<glm::vec3>> translations;  ///< [joint][key]; empty where they rest
  std::vector<std::vector<glm::quat>> rotations;
  std::vector<std::vector<glm::vec3>> scales;
};

/// How the same is usually played: arrays of keys of GLM types, a binary search in each track, slerp, 4 × 4 matrices.
class GlmPlayer {
 public:
  explicit GlmPlayer(const CharacterClip& clip);
  void sample(double time_s);
  void local_to_model();

  std::vector<glm::vec3> translations;
  std::vector<glm::quat> rotations;
  std::vector<glm::vec3> scales;
  std::vector<glm::mat4> model_from_joint;

 private:
  template <class Value>
  struct Track {
    std::vector<float> times_s;
    std::vector<Value> values;
  };
  std::vector<std::int32_t> parents_;
  std::vector<Track<glm::vec3>> translation_tracks_;
  std::vector<Track<glm::quat>> rotation_tracks_;
  std::vector<Track<glm::vec3>> scale_tracks_;
};

}  // namespace tweend::bench
