// Blinn-Phong with one point light, in linear light; the framebuffer encodes to sRGB.
// J. Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977.
in vec3 world_position;
in vec3 world_normal;
in vec2 uv;

uniform vec3 base_color;  // linear
uniform bool textured;
layout(binding = 0) uniform sampler2D base_color_texture;

out vec4 color;

// What shines from everywhere: more from above than from below, so that the side away from the light keeps its shape.
const float kFromAbove = 1.3;
const float kFromBelow = 0.7;

void main() {
  vec3 base = base_color;
  if (textured) base *= texture(base_color_texture, uv).rgb;
  vec3 normal = normalize(gl_FrontFacing ? world_normal : -world_normal);
  vec3 to_light = normalize(light_position.xyz - world_position);
  vec3 to_eye = normalize(eye.xyz - world_position);
  vec3 halfway = normalize(to_light + to_eye);

  float lambert = max(dot(normal, to_light), 0.0);
  float highlight = lambert > 0.0 ? pow(max(dot(normal, halfway), 0.0), light_terms.w) : 0.0;
  float hemisphere = mix(kFromBelow, kFromAbove, 0.5 + 0.5 * normal.y);
  color = vec4(base * (light_terms.x * hemisphere + light_terms.y * lambert) + light_terms.z * highlight, 1.0);
}
