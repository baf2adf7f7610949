// Joints and bones of skeletons, an instance each: the ball of the joint, and the octahedron that leads to it.
layout(location = 0) in vec3 shape_position;  // the ball: radius 1 around the joint; the bone: length 1 from the parent along +Y
layout(location = 1) in vec3 shape_normal;
layout(location = 2) in float is_bone;  // 1 or 0
layout(location = 3) in vec4 joint;     // and the ball's radius; world space, metres
layout(location = 4) in vec3 parent;
layout(location = 5) in vec3 across;  // unit

out vec3 world_position;
out vec3 world_normal;
flat out float bone;

void main() {
  vec3 way = joint.xyz - parent;
  float size = length(way);
  bone = is_bone;
  if (is_bone > 0.5) {
    // Scaled evenly and turned: a normal is only turned. A bone without length shrinks to a point, which covers nothing.
    vec3 along = size > 0.0 ? way / size : vec3(0.0, 1.0, 0.0);
    mat3 turned = mat3(across, along, cross(across, along));
    world_position = parent + size * (turned * shape_position);
    world_normal = turned * shape_normal;
  } else {
    world_position = joint.xyz + joint.w * shape_position;
    world_normal = shape_normal;
  }
  gl_Position = clip_from_world * vec4(world_position, 1.0);
}
