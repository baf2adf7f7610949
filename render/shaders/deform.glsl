// Morphing and linear blend skinning of one vertex, by the rules of animation::morph_vertices and animation::skin_vertices.
// What lasts as long as the mesh comes as attributes and as `displacements`; what is new with each picture, the palette and
// the list of targets that weigh anything, lies in one buffer, which is seen as rows of floats and as words.
// INFLUENCES (0, 1, 4 or 8) says how many entries of the palette move a vertex; 0: it is only morphed.
#if INFLUENCES == 1
layout(location = 1) in uint entry;
#elif INFLUENCES > 1
layout(location = 1) in uvec4 entries0;
layout(location = 5) in vec4 influences0;
#endif
#if INFLUENCES > 4
layout(location = 2) in uvec4 entries1;
layout(location = 6) in vec4 influences1;
#endif

layout(binding = 1) uniform samplerBuffer picture_rows;
layout(binding = 2) uniform isamplerBuffer picture_words;
layout(binding = 3) uniform samplerBuffer displacements;
uniform ivec3 pose_at;  // the palette's first row; the first target's first word; how many targets there are

vec3 unit_or(vec3 direction, vec3 fallback) {
  float size = length(direction);
  return size > SHORTEST_DIRECTION ? direction / size : fallback;
}

void morph(inout vec3 position, inout vec3 normal) {
  vec3 turned = normal;
  bool turns = false;
  for (int i = 0; i < pose_at.z; ++i) {
    // The first vertex, how many, and where among the displacements its positions and its normals (or -1) begin.
    ivec4 run = texelFetch(picture_words, pose_at.y + 2 * i);
    int at = gl_VertexID - run.x;
    if (at < 0 || at >= run.y) continue;
    float weight = intBitsToFloat(texelFetch(picture_words, pose_at.y + 2 * i + 1).x);
    position += weight * texelFetch(displacements, run.z + at).xyz;
    if (run.w < 0) continue;
    turned += weight * texelFetch(displacements, run.w + at).xyz;
    turns = true;
  }
  if (turns) normal = unit_or(turned, normal);
}

#if INFLUENCES > 0
// A matrix's rows are the columns here: a vector multiplies from the left.
void add_entry(uint entry, float weight, inout mat3x4 rows) {
  int at = pose_at.x + 3 * int(entry);
  rows[0] += weight * texelFetch(picture_rows, at);
  rows[1] += weight * texelFetch(picture_rows, at + 1);
  rows[2] += weight * texelFetch(picture_rows, at + 2);
}

mat3x4 blended_rows() {
  mat3x4 rows = mat3x4(0.0);
#if INFLUENCES == 1
  add_entry(entry, 1.0, rows);
#else
  for (int i = 0; i < 4; ++i) add_entry(entries0[i], influences0[i], rows);
#endif
#if INFLUENCES > 4
  for (int i = 0; i < 4; ++i) add_entry(entries1[i], influences1[i], rows);
#endif
  return rows;
}
#endif

// Moves the vertex to where the pose has it.
// @return -1 where it was mirrored on the way, so that its triangles run the other way round; else 1
float deform(inout vec3 position, inout vec3 normal) {
  morph(position, normal);
#if INFLUENCES > 0
  mat3x4 rows = blended_rows();
  position = vec4(position, 1.0) * rows;
  // The inverse transpose but for its length: the cofactors, with the sign of the determinant.
  vec3 a = rows[0].xyz, b = rows[1].xyz, c = rows[2].xyz;
  vec3 ab = cross(a, b);
  float side = dot(ab, c) < 0.0 ? -1.0 : 1.0;
  normal = unit_or(side * vec3(dot(cross(b, c), normal), dot(cross(c, a), normal), dot(ab, normal)), normal);
  return side;
#else
  return 1.0;
#endif
}
