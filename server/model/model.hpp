#pragma once

#include <memory>
#include <string>
#include <vector>

#include "server/model/clip.hpp"
#include "server/model/mesh.hpp"
#include "server/model/morph_targets.hpp"
#include "server/model/skeleton.hpp"
#include "server/model/skin.hpp"
#include "server/model/vertex_key.hpp"

namespace tweend::model {

/// What an actor is made of, beside its clips. At least a mesh or a skeleton. Immutable; all revisions share it.
struct Model {
  MeshPtr mesh;            ///< null: a skeleton alone
  VertexKeyPtr rest;       ///< the mesh before morphing and skinning; null without a mesh
  SkeletonPtr skeleton;    ///< null: a mesh that only its vertices' keyframes move
  SkinPtr skin;            ///< null: vertices stay in model space. Needs a mesh and a skeleton
  MorphTargetsPtr morphs;  ///< null: none

  [[nodiscard]] std::size_t vertex_count() const noexcept { return mesh ? mesh->vertex_count() : 0; }
  [[nodiscard]] std::size_t joint_count() const noexcept { return skeleton ? skeleton->size() : 0; }
  [[nodiscard]] std::size_t weight_count() const noexcept { return morphs ? morphs->size() : 0; }
};
using ModelPtr = std::shared_ptr<const Model>;

/// What reading an asset comes to.
struct ImportedModel {
  std::string source;  ///< the asset's name
  ModelPtr model;
  std::vector<Clip> clips;            ///< keyframes without ids yet (0)
  std::vector<std::string> warnings;  ///< a line each: what the files say that was passed over
};

}  // namespace tweend::model
