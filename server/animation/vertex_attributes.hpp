#pragma once

#include <span>

namespace tweend::animation {

/// One keyframe's vertices, borrowed: xyz-interleaved, shape [vertex_count × 3], model space.
struct VertexAttributes {
  std::span<const float> positions;  ///< metres
  std::span<const float> normals;    ///< unit vectors; may be empty
  std::span<const float> tangents;   ///< unit vectors; may be empty
};

/// Where blended vertices go, in the shape of VertexAttributes. A stream that is empty is not computed.
struct VertexTarget {
  std::span<float> positions;
  std::span<float> normals;
  std::span<float> tangents;
};

}  // namespace tweend::animation
