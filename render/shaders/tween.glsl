// Keyframe animation on the GPU: each of the up to four keyframes that make a moment is bound as vertex attributes, at
// its own offset into the one buffer that holds them all. SOURCES (1, 2 or 4) says how many are bound.
layout(location = 0) in vec3 position0;
layout(location = 4) in vec3 normal0;
layout(location = 8) in vec3 tangent0;
#if SOURCES > 1
layout(location = 1) in vec3 position1;
layout(location = 5) in vec3 normal1;
layout(location = 9) in vec3 tangent1;
#endif
#if SOURCES > 2
layout(location = 2) in vec3 position2;
layout(location = 3) in vec3 position3;
layout(location = 6) in vec3 normal2;
layout(location = 7) in vec3 normal3;
layout(location = 10) in vec3 tangent2;
layout(location = 11) in vec3 tangent3;
#endif

// weight[i] belongs to source i. Of two sources it is (1 - u, u): mix(). Of four they are Catmull-Rom's polynomials in u,
// worked out once for all vertices, as u, u2 and u3 once were in a shader's preamble.
uniform vec4 weights;
uniform int nearest;  // the source whose direction stands in where the blended one has no length

vec3 tween(vec3 source0, vec3 source1, vec3 source2, vec3 source3) {
#if SOURCES == 1
  return source0;
#elif SOURCES == 2
  return weights.x * source0 + weights.y * source1;
#else
  return weights.x * source0 + weights.y * source1 + weights.z * source2 + weights.w * source3;
#endif
}

// Unit vectors blend to less than unit length, and opposite ones to none.
vec3 tween_direction(vec3 source0, vec3 source1, vec3 source2, vec3 source3) {
#if SOURCES == 1
  return source0;
#else
  vec3 blended = tween(source0, source1, source2, source3);
  float size = length(blended);
  if (size > SHORTEST_DIRECTION) return blended / size;
  return nearest == 0 ? source0 : nearest == 1 ? source1 : nearest == 2 ? source2 : source3;
#endif
}

// A blend of one attribute's sources, of which those that are not bound are not looked at.
#if SOURCES == 1
#define TWEEN(blend, source0, source1, source2, source3) blend(source0, source0, source0, source0)
#elif SOURCES == 2
#define TWEEN(blend, source0, source1, source2, source3) blend(source0, source1, source1, source1)
#else
#define TWEEN(blend, source0, source1, source2, source3) blend(source0, source1, source2, source3)
#endif
#define TWEENED_POSITION TWEEN(tween, position0, position1, position2, position3)
#define TWEENED_NORMAL TWEEN(tween_direction, normal0, normal1, normal2, normal3)
#define TWEENED_TANGENT TWEEN(tween_direction, tangent0, tangent1, tangent2, tangent3)
