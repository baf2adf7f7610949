layout(location = 12) in vec2 texcoord;
layout(location = 13) in vec4 vertex_color;  // linear; all 1 where the mesh has none

uniform mat4 world_from_model;
uniform mat3 world_from_model_normal;  // the inverse transpose
uniform vec4 base_color;               // linear

out vec3 world_position;
out vec3 world_normal;
out vec2 uv;
out vec4 tint;
#ifdef POSED
out float side;
#endif

void main() {
  vec3 position = TWEENED_POSITION;
  vec3 normal = TWEENED_NORMAL;
#ifdef POSED
  side = deform(position, normal);
#endif
  vec4 world = world_from_model * vec4(position, 1.0);
  world_position = world.xyz;
  world_normal = world_from_model_normal * normal;
  uv = vec2(texcoord.x, 1.0 - texcoord.y);  // textures begin with their top row
  tint = base_color * vertex_color;
  gl_Position = clip_from_world * world;
}
