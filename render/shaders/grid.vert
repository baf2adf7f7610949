// A square of ground around what is looked at, without vertex data: two triangles as a strip.
uniform vec2 center;  // x and z, metres

out vec3 world_position;

void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  vec2 ground = center + corner * grid_terms.y;
  world_position = vec3(ground.x, 0.0, ground.y);
  gl_Position = clip_from_world * vec4(world_position, 1.0);
}
