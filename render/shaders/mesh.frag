in vec3 world_position;
in vec3 world_normal;
in vec2 uv;
in vec4 tint;
#ifdef POSED
in float side;
#endif

uniform bool textured;
uniform bool unlit;
#ifdef CUTOUT
uniform float alpha_cutoff;
#endif
layout(binding = 0) uniform sampler2D base_color_texture;

out vec4 color;

void main() {
  vec4 base = tint;
  if (textured) base *= texture(base_color_texture, uv);
#ifdef CUTOUT
  if (base.a < alpha_cutoff) discard;
#endif
  if (unlit) {
    color = vec4(base.rgb, 1.0);
    return;
  }
  bool front = gl_FrontFacing;
#ifdef POSED
  if (side < 0.0) front = !front;
#endif
  color = vec4(lit(world_position, normalize(front ? world_normal : -world_normal), base.rgb), 1.0);
}
