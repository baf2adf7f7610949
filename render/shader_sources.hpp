#pragma once

#include <string_view>

namespace tweend::render::shaders {

// The files of render/shaders, compiled in.
extern const std::string_view kFrame;     ///< frame.glsl
extern const std::string_view kTween;     ///< tween.glsl
extern const std::string_view kDeform;    ///< deform.glsl
extern const std::string_view kLight;     ///< light.glsl
extern const std::string_view kMeshVert;  ///< mesh.vert
extern const std::string_view kMeshFrag;  ///< mesh.frag
extern const std::string_view kBoneVert;  ///< bone.vert
extern const std::string_view kBoneFrag;  ///< bone.frag
extern const std::string_view kGridVert;  ///< grid.vert
extern const std::string_view kGridFrag;  ///< grid.frag

}  // namespace tweend::render::shaders
