#include "bench/support/character_clip.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <span>

#include "bench/support/server_process.hpp"

namespace tweend::bench {
namespace {

constexpr double kKeysPerSecond = 30.0;

/// A number between −1 and 1 that goes its own way for each seed.
float wave(std::uint32_t seed, double t) {
  const double s = seed;
  return static_cast<float>(0.6 * std::sin(t * (1.3 + std::fmod(s * 0.37, 1.7)) + s) + 0.4 * std::sin(t * 4.1 + 2.9 * s));
}

/// Spine, legs, arms with fingers, level by level, as skeletons are evaluated: levels of 1, 3, 5, 5, 5, … joints.
std::vector<std::int32_t> parents_of(std::size_t joints) {
  std::vector<std::int32_t> parents{-1, 0, 0, 0};
  while (parents.size() < joints) {
    const auto j = static_cast<std::int32_t>(parents.size());
    parents.push_back(j < 9 ? 1 + j % 3 : j - 5);
  }
  return parents;
}

std::vector<glm::vec4> as_keys(const std::vector<glm::vec3>& values) {
  std::vector<glm::vec4> keys;
  for (const glm::vec3& v : values) keys.emplace_back(v, 0.0F);
  return keys;
}

std::vector<glm::vec4> as_keys(const std::vector<glm::quat>& values) {
  std::vector<glm::vec4> keys;
  for (const glm::quat& q : values) keys.emplace_back(q.x, q.y, q.z, q.w);
  return keys;
}

/// The key at or before `t`, and how much of the way to the next has passed.
std::size_t search(const std::vector<float>& times_s, float t, float& u) {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), t);
  const std::size_t i = after == times_s.begin() ? 0 : static_cast<std::size_t>(after - times_s.begin()) - 1;
  if (i + 1 >= times_s.size()) {
    u = 1.0F;
    return times_s.size() - 2;
  }
  u = std::max(0.0F, (t - times_s[i]) / (times_s[i + 1] - times_s[i]));
  return i;
}

}  // namespace

CharacterClip::CharacterClip(std::size_t joints, double length_s, bool all_move, std::uint32_t seed)
    : duration_s(length_s), moves(all_move), parents(parents_of(joints)) {
  const auto keys = static_cast<std::size_t>(duration_s * kKeysPerSecond) + 1;
  for (std::size_t key = 0; key < keys; ++key) times_s.push_back(static_cast<double>(key) / kKeysPerSecond);
  translations.resize(joints);
  rotations.resize(joints);
  scales.resize(joints);
  for (std::size_t j = 0; j < joints; ++j) {
    const auto own = static_cast<std::uint32_t>(10 * j) + seed;
    rest_translations.emplace_back(0.02F, 0.1F, 0.01F);
    for (const double t : times_s) {
      rotations[j].push_back(glm::normalize(glm::quat(1.0F, 0.8F * wave(own, t), 0.5F * wave(own + 1, t), wave(own + 2, t))));
      if (!moves) continue;
      translations[j].push_back(rest_translations[j] + 0.01F * glm::vec3(wave(own + 3, t), wave(own + 4, t), wave(own + 5, t)));
      scales[j].push_back(1.0F + 0.02F * glm::vec3(wave(own + 6, t), wave(own + 7, t), wave(own + 8, t)));
    }
  }
}

animation::TrackSet CharacterClip::packed() const {
  using animation::Property;
  std::vector<std::vector<glm::vec4>> keys;
  std::vector<animation::TrackSource> sources;
  const std::vector<animation::KeyMode> linear{{animation::Interpolation::Linear, {}}};
  keys.reserve(3 * joint_count());
  const auto add = [&](std::size_t joint, Property property, std::vector<glm::vec4> values) {
    keys.push_back(std::move(values));
    sources.push_back({{static_cast<std::uint32_t>(joint), property}, times_s, keys.back(), {}, {}, linear});
  };
  for (std::size_t j = 0; j < joint_count(); ++j) {
    add(j, Property::Rotation, as_keys(rotations[j]));
    if (!moves) continue;
    add(j, Property::Translation, as_keys(translations[j]));
    add(j, Property::Scale, as_keys(scales[j]));
  }
  return {sources, duration_s, false};
}

animation::Pose CharacterClip::rest_pose() const {
  animation::Pose pose;
  pose.reset(joint_count(), 0);
  for (std::size_t j = 0; j < joint_count(); ++j) pose.set_joint(j, {.translation = rest_translations[j]});
  return pose;
}

void CharacterClip::write_json(const std::string& path) const {
  std::ofstream out(path);
  out.precision(9);
  const auto list = [&](const auto& items, auto write_item) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      out << (i == 0 ? "[" : ",");
      write_item(items[i]);
    }
    out << (items.empty() ? "[]" : "]");
  };
  const auto number = [&](auto value) { out << value; };
  const auto vec3 = [&](const glm::vec3& v) { out << v.x << ',' << v.y << ',' << v.z; };
  const auto quat = [&](const glm::quat& q) { out << q.x << ',' << q.y << ',' << q.z << ',' << q.w; };
  const auto vec3_track = [&](const std::vector<glm::vec3>& keys) { list(keys, vec3); };
  const auto quat_track = [&](const std::vector<glm::quat>& keys) { list(keys, quat); };
  out << "{\"duration\":" << duration_s << ",\"parents\":", list(parents, number);
  out << ",\"rest\":", list(rest_translations, vec3);
  out << ",\"times\":", list(times_s, number);
  out << ",\"translations\":", list(translations, vec3_track);
  out << ",\"rotations\":", list(rotations, quat_track);
  out << ",\"scales\":", list(scales, vec3_track);
  out << "}\n";
  if (!out.flush()) give_up("could not write " + path);
}

GlmPlayer::GlmPlayer(const CharacterClip& clip)
    : translations(clip.rest_translations),
      rotations(clip.joint_count(), glm::quat(1, 0, 0, 0)),
      scales(clip.joint_count(), glm::vec3(1.0F)),
      model_from_joint(clip.joint_count()),
      parents_(clip.parents) {
  const std::vector<float> times(clip.times_s.begin(), clip.times_s.end());
  for (std::size_t j = 0; j < clip.joint_count(); ++j) {
    rotation_tracks_.push_back({times, clip.rotations[j]});
    if (!clip.moves) continue;
    translation_tracks_.push_back({times, clip.translations[j]});
    scale_tracks_.push_back({times, clip.scales[j]});
  }
}

void GlmPlayer::sample(double time_s) {
  const auto t = static_cast<float>(time_s);
  float u = 0.0F;
  for (std::size_t j = 0; j < rotation_tracks_.size(); ++j) {
    const auto& track = rotation_tracks_[j];
    const std::size_t i = search(track.times_s, t, u);
    rotations[j] = glm::slerp(track.values[i], track.values[i + 1], u);
  }
  for (std::size_t j = 0; j < translation_tracks_.size(); ++j) {
    const auto& track = translation_tracks_[j];
    const std::size_t i = search(track.times_s, t, u);
    translations[j] = glm::mix(track.values[i], track.values[i + 1], u);
  }
  for (std::size_t j = 0; j < scale_tracks_.size(); ++j) {
    const auto& track = scale_tracks_[j];
    const std::size_t i = search(track.times_s, t, u);
    scales[j] = glm::mix(track.values[i], track.values[i + 1], u);
  }
}

void GlmPlayer::local_to_model() {
  for (std::size_t j = 0; j < parents_.size(); ++j) {
    const glm::mat4 local = glm::translate(glm::mat4(1.0F), translations[j]) * glm::mat4_cast(rotations[j]) *
                            glm::scale(glm::mat4(1.0F), scales[j]);
    model_from_joint[j] = parents_[j] < 0 ? local : model_from_joint[static_cast<std::size_t>(parents_[j])] * local;
  }
}

}  // namespace tweend::bench
