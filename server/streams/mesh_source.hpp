#pragma once

#include "render/picture.hpp"
#include "server/model/model.hpp"

namespace tweend::streams {

/// What the renderer calls content of this name.
[[nodiscard]] inline render::ResourceId resource_id(const model::ContentHash& hash) noexcept { return {hash.high, hash.low}; }

/// What the renderer is told of a model: mesh, materials, skin and morph targets. Its spans are the model's, which it holds.
/// Precondition: there is a mesh.
[[nodiscard]] render::MeshSourcePtr mesh_source(const model::ModelPtr& model);

}  // namespace tweend::streams
