#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>
#include <vector>

namespace tweend::bench {

/// three.js's AnimationMixer in a Node of its own, playing a clip that CharacterClip has written.
class ThreeMixer {
 public:
  /// Whether Node and three.js are there; `./dev bench` sees to it.
  [[nodiscard]] static bool is_installed();
  explicit ThreeMixer(const std::string& clip_json);
  ~ThreeMixer();
  ThreeMixer(const ThreeMixer&) = delete;
  ThreeMixer& operator=(const ThreeMixer&) = delete;

  /// The numbers that answer a line; see bench/three_mixer/mixer.mjs.
  [[nodiscard]] std::vector<double> ask(const std::string& line);

 private:
  pid_t pid_ = -1;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
};

}  // namespace tweend::bench
