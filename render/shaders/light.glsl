// Blinn-Phong with one point light, in linear light; the framebuffer encodes to sRGB.
// J. Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977.

// What shines from everywhere: more from above than from below, so that the side away from the light keeps its shape.
const float kFromAbove = 1.3;
const float kFromBelow = 0.7;

// What the eye sees of a place of a surface.
// @param normal  unit, world space, towards the eye's side
// @param base    linear
vec3 lit(vec3 place, vec3 normal, vec3 base) {
  vec3 to_light = normalize(light_position.xyz - place);
  vec3 to_eye = normalize(eye.xyz - place);
  vec3 halfway = normalize(to_light + to_eye);

  float lambert = max(dot(normal, to_light), 0.0);
  float highlight = lambert > 0.0 ? pow(max(dot(normal, halfway), 0.0), light_terms.w) : 0.0;
  float hemisphere = mix(kFromBelow, kFromAbove, 0.5 + 0.5 * normal.y);
  return base * (light_terms.x * hemisphere + light_terms.y * lambert) + light_terms.z * highlight;
}
