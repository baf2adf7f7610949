#pragma once

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "server/model/actor.hpp"
#include "tests/assets/must.hpp"

namespace tweend::assets {

/// Actors of every kind, the same in every run.
class RandomActors {
 public:
  explicit RandomActors(std::uint32_t seed) : random_(seed) {}

  struct Kind {
    bool skeleton = true;
    bool mesh = true;
    bool skin = true;
    bool morphs = true;
    bool vertex_clip = true;
    bool parts = true;
  };

  model::Actor actor(const Kind& kind) {
    model::Model m;
    if (kind.skeleton) m.skeleton = skeleton();
    if (kind.mesh) {
      m.mesh = mesh(kind.parts);
      m.rest = key(*m.mesh);
      if (kind.skin && kind.skeleton) m.skin = skin(*m.skeleton, m.rest->positions());
      if (kind.morphs && kind.skeleton) m.morphs = morphs();
    }
    model::Actor actor;
    actor.name = "puppet";
    actor.model = std::make_shared<const model::Model>(std::move(m));
    if (below(2) == 0) actor.settings.interpolation = mode();
    // Poses, those of morph weights too, are of actors with joints: no import and no command makes others.
    for (int i = 0; kind.skeleton && i < 3; ++i) {
      actor.clips.push_back(skeletal_clip("pose" + std::to_string(i), *actor.model));
    }
    if (kind.mesh && kind.vertex_clip) {
      for (int i = 0; i < 3; ++i) actor.clips.push_back(vertex_clip("mesh" + std::to_string(i), *actor.model));
    }
    return actor;
  }

  std::size_t below(std::size_t end) { return random_() % end; }
  float number(double low, double high) {
    return static_cast<float>(low + (high - low) * (static_cast<double>(random_()) / 4294967296.0));
  }

 private:
  static constexpr std::size_t kVertices = 24;
  static constexpr std::size_t kJoints = 7;
  static constexpr std::size_t kWeights = 3;

  glm::vec3 vec(double limit) { return {number(-limit, limit), number(-limit, limit), number(-limit, limit)}; }
  glm::quat turn(double most = 1.0) {
    return glm::normalize(glm::quat(1.0F, number(-most, most), number(-most, most), number(-most, most)));
  }
  animation::Interpolation mode() { return static_cast<animation::Interpolation>(below(4)); }

  model::SkeletonPtr skeleton() {
    std::vector<model::Joint> joints;
    for (std::size_t j = 0; j < kJoints; ++j) {
      model::Joint joint{"joint é " + std::to_string(j), -1, {vec(1), turn(), glm::vec3(1.0F) + 0.3F * vec(1)}};
      // Two roots at least.
      if (j >= 2) joint.parent = static_cast<std::int32_t>(below(j));
      joints.push_back(std::move(joint));
    }
    if (below(2) == 0) {  // parents behind their children
      std::reverse(joints.begin(), joints.end());
      for (model::Joint& joint : joints) {
        if (joint.parent >= 0) joint.parent = static_cast<std::int32_t>(kJoints) - 1 - joint.parent;
      }
    }
    return must(model::Skeleton::make(std::move(joints)));
  }

  model::MeshPtr mesh(bool parts) {
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < 60; ++i) indices.push_back(static_cast<std::uint32_t>(below(kVertices)));
    std::vector<float> texcoords, colors;
    for (std::size_t i = 0; i < 2 * kVertices; ++i) texcoords.push_back(number(-0.5, 1.5));
    for (std::size_t i = 0; i < 4 * kVertices; ++i) colors.push_back(number(0, 1));
    model::Surface surface;
    if (parts) {
      model::Material red;
      red.name = "red \"é\"";
      red.base_color = {0.8F, 0.1F, 0.02F};
      red.base_color_texture = must(model::Image::make(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 255}));
      model::Material glass;
      glass.alpha = 0.5F;
      glass.alpha_cutoff = 0.25F;
      glass.unlit = true;
      glass.base_color_texture = must(model::Image::make(1, 2, {1, 2, 3, 4, 5, 6, 7, 8}));
      glass.wrap_u = model::TextureWrap::ClampToEdge;
      surface.materials = {red, glass};
      surface.parts = {{0, 24, 0}, {24, 30, 1}, {54, 6, 0}};
    }
    return must(model::Mesh::make(kVertices, std::move(indices), below(4) == 0 ? std::vector<float>() : texcoords, surface,
                                  below(2) == 0 ? std::vector<float>() : colors));
  }

  model::VertexKeyPtr key(const model::Mesh& mesh) {
    std::vector<float> positions, normals;
    for (std::size_t v = 0; v < kVertices; ++v) {
      const glm::vec3 p = vec(2);
      const glm::vec3 n = glm::vec3(turn() * glm::vec3(0, 0, 1));
      positions.insert(positions.end(), {p.x, p.y, p.z});
      normals.insert(normals.end(), {n.x, n.y, n.z});
    }
    return must(model::VertexKey::make(mesh, positions, normals));
  }

  model::SkinPtr skin(const model::Skeleton& skeleton, std::span<const float> positions) {
    std::vector<model::SkinEntry> entries;
    for (std::uint32_t j = 0; j < skeleton.size(); ++j) {
      entries.push_back({j, animation::Affine()});
      if (j % 3 != 0) continue;
      // The same joint again, as a skin has it whose mesh also has a part that hangs on the joint.
      animation::Affine bind;
      for (glm::vec4& row : bind.rows) row += 0.2F * glm::vec4(vec(1), number(-1, 1));
      entries.push_back({j, bind});
    }
    const std::size_t per_vertex = std::size_t{1} << (below(2) == 0 ? 2U : 3U);
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (std::size_t i = 0; i < kVertices * per_vertex; ++i) {
      joints.push_back(static_cast<std::uint16_t>(below(entries.size())));
      weights.push_back(i % per_vertex == 0 ? 0.6F : below(2) == 0 ? 0.0F : number(0, 0.15));
    }
    return must(model::Skin::make(std::move(entries), per_vertex, std::move(joints), std::move(weights), positions));
  }

  model::MorphTargetsPtr morphs() {
    std::vector<model::MorphTarget> targets;
    for (std::size_t t = 0; t < kWeights; ++t) {
      model::MorphTarget target;
      target.name = t == 0 ? "mesh0:0" : "smile " + std::to_string(t);
      target.default_weight = number(0, 1);
      target.first_vertex = 4 * t;
      for (std::size_t i = 0; i < 3 * (kVertices - 8 * t); ++i) target.positions.push_back(number(-0.3, 0.3));
      if (t != 1) {
        for (std::size_t i = 0; i < target.positions.size(); ++i) target.normals.push_back(number(-0.2, 0.2));
      }
      targets.push_back(std::move(target));
    }
    return must(model::MorphTargets::make(std::move(targets), kVertices));
  }

  /// Even or uneven, from 0 or later; now and then only one.
  std::vector<double> times() {
    std::vector<double> times;
    double time_s = below(2) == 0 ? 0.0 : static_cast<double>(number(0.05, 0.4));
    const std::size_t keys = below(5) == 0 ? 1 : 2 + below(4);
    for (std::size_t k = 0; k < keys; ++k) {
      times.push_back(time_s);
      time_s += static_cast<double>(number(0.1, 0.8));
    }
    return times;
  }

  void set_modes(model::Clip& clip) {
    clip.settings.closed = below(3) == 0;
    if (below(3) == 0) clip.settings.duration_s = clip.times_s.back() + static_cast<double>(number(0.2, 0.7));
    if (below(2) == 0) clip.settings.interpolation = mode();
    const std::size_t style = below(3);  // 0: as the clip says; 1: each key its own; 2: eased as well
    for (model::Keyframe& keyframe : clip.keyframes) {
      if (style > 0 && below(2) == 0) keyframe.interpolation = mode();
      if (style > 1 && below(2) == 0) keyframe.easing = animation::CubicBezier{0.42, 0.0, 0.4, 1.3};
    }
  }

  model::KeyedValue keyed(std::uint32_t target, animation::Property property) {
    if (property != animation::Property::Rotation) return {{target, property}, glm::vec4(vec(1) + glm::vec3(1.2F), 0.0F)};
    const glm::quat q = turn(0.8);
    return {{target, property}, glm::vec4(q.x, q.y, q.z, q.w)};
  }

  model::PoseKeyPtr pose(const model::Model& m, bool sparse) {
    std::vector<model::KeyedValue> values;
    for (std::uint32_t j = 0; j < m.joint_count(); ++j) {
      for (const auto property :
           {animation::Property::Translation, animation::Property::Rotation, animation::Property::Scale}) {
        if (!sparse || below(2) == 0) values.push_back(keyed(j, property));
      }
    }
    for (std::uint32_t w = 0; w < m.weight_count(); ++w) {
      if (!sparse || below(2) == 0) values.push_back({{w, animation::Property::Weight}, {number(-0.5, 1.5), 0, 0, 0}});
    }
    std::vector<model::KeyedTangents> tangents;
    for (std::size_t i = 0; i < values.size(); ++i) {
      // Small ones, so that rotations stay away from where their direction turns over.
      tangents.push_back({glm::vec4(vec(0.4), number(-0.4, 0.4)), glm::vec4(vec(0.4), number(-0.4, 0.4))});
    }
    if (below(2) == 0) tangents.clear();
    return std::make_shared<const model::PoseKey>(std::move(values), std::move(tangents));
  }

  model::ClipPtr skeletal_clip(std::string name, const model::Model& m) {
    auto clip = std::make_shared<model::Clip>();
    clip->name = std::move(name);
    clip->times_s = times();
    const bool sparse = below(2) == 0;
    for (std::size_t k = 0; k < clip->times_s.size(); ++k) clip->keyframes.push_back({0, {}, {}, nullptr, pose(m, sparse)});
    set_modes(*clip);
    return clip;
  }

  model::ClipPtr vertex_clip(std::string name, const model::Model& m) {
    auto clip = std::make_shared<model::Clip>();
    clip->name = std::move(name);
    clip->times_s = times();
    for (std::size_t k = 0; k < clip->times_s.size(); ++k) {
      // The rest itself, one that was there before, or a new one.
      const bool again = k > 1 && below(3) == 0;
      const model::VertexKeyPtr shown = below(4) == 0 ? m.rest : again ? clip->keyframes[k - 2].vertices : key(*m.mesh);
      clip->keyframes.push_back({0, {}, {}, shown, nullptr});
    }
    set_modes(*clip);
    return clip;
  }

  std::mt19937 random_;
};

}  // namespace tweend::assets
