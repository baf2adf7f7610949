// Playing skeletal clips with dense keys (20 s, 30 keys a second, every joint), one core: tweend against plain GLM (a binary
// search in each track, slerp, 4 × 4 matrices) and three.js's AnimationMixer, which Node runs beside. A step samples a pose and
// makes its model matrices.

#include <hwy/targets.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "bench/support/character_clip.hpp"
#include "bench/support/character_skin.hpp"
#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"
#include "bench/support/three_process.hpp"
#include "server/animation/local_to_model.hpp"
#include "tests/animation/reference_track.hpp"

namespace {

using namespace tweend;
using namespace tweend::animation;
using bench::CharacterClip;

constexpr double kDurationS = 20.0;
constexpr std::size_t kCrowd = 1000;

double next_frame(double time_s) { return std::fmod(time_s + 1.0 / 60.0, kDurationS); }

/// Times all over the clip, in no order.
std::vector<double> jumps() {
  std::mt19937 random(1);
  std::vector<double> times_s;
  for (int i = 0; i < 4096; ++i) times_s.push_back(kDurationS * static_cast<double>(random()) / 4294967296.0);
  return times_s;
}

struct Character {
  explicit Character(const CharacterClip& clip, double start_s = 0.0)
      : parents(&clip.parents), pose(clip.rest_pose()), model_from_joint(clip.joint_count()), time_s(start_s) {}
  void sample(const TrackSet& tracks, double t) {
    tracks.sample(t, Interpolation::Linear, pose);
    bench::keep(pose.row(PoseRow::Tx).data());
  }
  void to_model() {
    local_to_model(*parents, pose, model_from_joint);
    bench::keep(model_from_joint.data());
  }
  void step(const TrackSet& tracks, double t) {
    sample(tracks, t);
    to_model();
  }
  const std::vector<std::int32_t>* parents;
  Pose pose;
  std::vector<Affine> model_from_joint;
  double time_s;
};

/// Never time a wrong answer: rotations against the definition in double, matrices against GLM's.
void check(const CharacterClip& clip, const TrackSet& tracks) {
  bench::GlmPlayer glm_player(clip);
  Character character(clip);
  for (const double t : {0.0, 0.01, 3.21, 11.0 + 1.0 / 3.0, 19.99, 20.0}) {
    character.step(tracks, t);
    glm_player.sample(t);
    glm_player.local_to_model();
    for (std::size_t j = 0; j < clip.joint_count(); ++j) {
      reference::Track track{{0, Property::Rotation}, clip.times_s, {}, {}, {}, {{Interpolation::Linear, {}}}};
      for (const glm::quat& q : clip.rotations[j]) track.values.emplace_back(q.x, q.y, q.z, q.w);
      const glm::dvec4 exact = reference::sample(track, kDurationS, false, t, Interpolation::Linear).value;
      const glm::quat found = character.pose.joint(j).rotation;
      const double cosine = glm::dot(exact, glm::dvec4(found.x, found.y, found.z, found.w));
      const double error = glm::length(exact - std::copysign(1.0, cosine) * glm::dvec4(found.x, found.y, found.z, found.w));
      if (error > 1e-6) bench::give_up("a rotation is " + std::to_string(error) + " away from the definition");
      for (int column = 0; column < 4; ++column) {
        const glm::vec4 apart = to_mat4(character.model_from_joint[j])[column] - glm_player.model_from_joint[j][column];
        if (glm::length(apart) > 2e-3F) bench::give_up("a matrix differs from GLM's");  // GLM's times are floats
      }
    }
  }
}

/// One character: rows of the table.
void race_glm(std::size_t joints, bool moves, const std::vector<double>& jumps_s, std::vector<bench::Claim>& claims) {
  const CharacterClip clip(joints, kDurationS, moves);
  const TrackSet tracks = clip.packed();
  check(clip, tracks);
  Character one(clip);
  bench::GlmPlayer glm_player(clip);
  std::size_t at = 0;
  double glm_s = 0.0;
  const auto forward = [&] { return one.time_s = next_frame(one.time_s); };
  const auto jump = [&] { return jumps_s[at++ % jumps_s.size()]; };
  const auto glm_step = [&](double t) {
    glm_player.sample(t);
    glm_player.local_to_model();
    bench::keep(glm_player.model_from_joint.data());
  };
  const bench::Race race = bench::measure(
      {.items = static_cast<double>(joints)}, [&] { one.sample(tracks, forward()); }, [&] { one.sample(tracks, jump()); },
      [&] { one.to_model(); }, [&] { one.step(tracks, forward()); }, [&] { one.step(tracks, jump()); },
      [&] { glm_step(glm_s = next_frame(glm_s)); }, [&] { glm_step(jump()); });
  std::printf("%6zu  %-9s %8.2f %8.2f %8.2f %8.2f %8.2f %8.1f %8.1f %8.1f\n", joints, moves ? "T R S" : "R", race.ns(0),
              race.ns(1), race.ns(2), race.ns(3), race.ns(4), race.ns(5), race.ns(6), race.ratio(5, 3));
  if (joints != 67 || !moves) return;
  claims.push_back({"pose_step_glm_vs_tweend", race.ratio(5, 3), 10.0, true});
  claims.push_back({"pose_seek_vs_forward", race.ratio(4, 3), 1.5});
}

/// Many characters of 67 joints, each with its own time, pose and matrices.
void race_crowd(const std::vector<double>& jumps_s, std::vector<bench::Claim>& claims) {
  constexpr std::size_t kClips = 8;
  const CharacterClip clip(67, kDurationS, true);
  std::vector<TrackSet> clips;
  for (std::uint32_t seed = 1; seed <= kClips; ++seed) clips.push_back(CharacterClip(67, kDurationS, true, seed).packed());
  Character one(clip);
  std::vector<Character> crowd;
  for (std::size_t i = 0; i < kCrowd; ++i) crowd.emplace_back(clip, jumps_s[i]);
  const auto step = [](Character& c, const TrackSet& tracks) { c.step(tracks, c.time_s = next_frame(c.time_s)); };
  const bench::Race race = bench::measure(
      {.items = 67.0 * static_cast<double>(kCrowd), .rounds = 41},
      [&] {
        for (std::size_t i = 0; i < kCrowd; ++i) step(one, clips[0]);
      },
      [&] {
        for (Character& character : crowd) step(character, clips[0]);
      },
      [&] {
        for (std::size_t i = 0; i < kCrowd; ++i) step(crowd[i], clips[i % kClips]);
      });
  std::printf("\na step of 67 joints, ns a joint: one character %.2f, each of %zu %.2f, on %zu clips %.2f\n", race.ns(0),
              kCrowd, race.ns(1), kClips, race.ns(2));
  claims.push_back({"pose_crowd_vs_one", race.ratio(1, 0), 1.5});
}

/// The largest distance between columns of our matrices and three.js's.
double distance_to(const std::vector<double>& three, const Character& character) {
  double worst = 0.0;
  for (std::size_t j = 0; j < character.model_from_joint.size(); ++j) {
    const glm::mat4 ours = to_mat4(character.model_from_joint[j]);
    for (int i = 0; i < 16; ++i) {
      const double theirs = three[16 * j + static_cast<std::size_t>(i)];
      worst = std::max(worst, std::abs(theirs - static_cast<double>(ours[i / 4][i % 4])));
    }
  }
  return worst;
}

void race_three(bool moves, std::vector<bench::Claim>& claims) {
  const CharacterClip clip(67, kDurationS, moves);
  const TrackSet tracks = clip.packed();
  const std::string file =
      std::filesystem::temp_directory_path() / ("tweend-bench-clip-" + std::to_string(::getpid()) + ".json");
  clip.write_json(file);
  bench::ThreeProcess three("mixer.mjs", file);
  Character one(clip);
  for (const double t : {0.4, 7.77, 19.3}) {
    one.step(tracks, t);
    const double apart = distance_to(three.ask("show " + std::to_string(t)), one);
    if (apart > 2e-4) bench::give_up("three.js shows something else, " + std::to_string(apart) + " away");
  }
  std::filesystem::remove(file);
  bench::Race race;
  race.ns_per_item.resize(4);  // ours, three.js's with and without matrices, its seek
  static_cast<void>(three.ask("forward 3000"));
  static_cast<void>(three.ask("seek 1000"));
  for (int round = 0; round < 15; ++round) {
    const auto ours = bench::measure({.items = 67.0, .rounds = 9, .batch_ns = 1e6},
                                     [&] { one.step(tracks, one.time_s = next_frame(one.time_s)); });
    const std::vector<double> forward = three.ask("forward 300");
    race.ns_per_item[0].push_back(ours.ns(0));
    for (std::size_t i = 0; i < 2; ++i) race.ns_per_item[1 + i].push_back(forward[i] / 67.0);
    race.ns_per_item[3].push_back(three.ask("seek 300")[0] / 67.0);
  }
  std::printf(
      "%6s  %-9s step %.2f; three.js: step %.0f, its mixer alone %.0f, a step elsewhere %.0f; step/tw. %.0f, mixer/tw. %.0f\n",
      "67", moves ? "T R S" : "R", race.ns(0), race.ns(1), race.ns(2), race.ns(3), race.ratio(1, 0), race.ratio(2, 0));
  if (moves) claims.push_back({"pose_step_three_vs_tweend", race.ratio(1, 0), 35.0, true});
}

void race_skinning() {
  std::printf("\nskinning, 4 influences, positions and normals, ns a vertex\n%8s %10s %10s %10s\n", "vertices", "tweend", "GLM",
              "GLM/tw.");
  for (const std::size_t vertices : {2'000U, 50'000U}) {
    bench::CharacterSkin skin(vertices, 67);
    skin.skin_tweend();
    skin.skin_glm();
    if (skin.difference() > 1e-4) bench::give_up("skinned vertices differ from GLM's");
    const auto ours = [&] {
      skin.skin_tweend();
      bench::keep(skin.out_positions.data());
    };
    const auto theirs = [&] {
      skin.skin_glm();
      bench::keep(skin.glm_out_positions.data());
    };
    const bench::Race race = bench::measure({.items = static_cast<double>(vertices)}, ours, theirs);
    std::printf("%8zu %10.2f %10.2f %10.2f\n", vertices, race.ns(0), race.ns(1), race.ratio(1, 0));
  }
}

}  // namespace

int main() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;  // the lowest bit is the best
  std::printf("ns a joint, one core, %s; a clip of %g s with 30 keys a second; step: sample and to model\n",
              hwy::TargetName(usable & -usable), kDurationS);
  std::printf("%6s  %-9s %8s %8s %8s %8s %8s %8s %8s %8s\n", "joints", "tracks", "sample", "seek", "to model", "step", "seek",
              "GLM", "seek", "GLM/tw.");
  const std::vector<double> jumps_s = jumps();
  std::vector<bench::Claim> claims;
  for (const bool moves : {true, false}) {
    for (const std::size_t joints : {20U, 67U, 250U}) race_glm(joints, moves, jumps_s, claims);
  }
  race_crowd(jumps_s, claims);
  if (bench::ThreeProcess::is_installed()) {
    std::printf("\nbeside three.js, ns a joint\n");
    for (const bool moves : {true, false}) race_three(moves, claims);
  } else {
    std::printf("\nthree.js is not measured: expected Node, and three.js in bench/three; `./dev bench` installs it\n");
  }
  race_skinning();
  return bench::report(claims) ? 0 : 1;
}
