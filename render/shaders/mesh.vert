layout(location = 12) in vec2 texcoord;

uniform mat4 world_from_model;
uniform mat3 world_from_model_normal;  // the inverse transpose

out vec3 world_position;
out vec3 world_normal;
out vec2 uv;

void main() {
  vec4 world = world_from_model * vec4(TWEENED_POSITION, 1.0);
  world_position = world.xyz;
  world_normal = world_from_model_normal * TWEENED_NORMAL;
  uv = vec2(texcoord.x, 1.0 - texcoord.y);  // textures begin with their top row
  gl_Position = clip_from_world * world;
}
