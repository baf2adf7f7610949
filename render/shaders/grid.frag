// Lines a pixel wide at any distance, every tenth one stronger, fading out before they would shimmer.
in vec3 world_position;

uniform vec2 center;

out vec4 color;

float line(vec2 place, vec2 width) {
  vec2 distance_px = abs(fract(place - 0.5) - 0.5) / width;
  float nearest_px = min(distance_px.x, distance_px.y);
  // Where a cell is but a few pixels wide its lines would merge into a veil.
  float cell_px = 1.0 / max(width.x, width.y);
  return (1.0 - min(nearest_px, 1.0)) * smoothstep(2.0, 8.0, cell_px);
}

void main() {
  vec2 place = world_position.xz / grid_terms.x;
  vec2 width = max(fwidth(place), vec2(1e-6));
  float strength = max(0.25 * line(place, width), 0.55 * line(place / 10.0, width / 10.0));
  float far = distance(world_position.xz, center) / grid_terms.y;
  color = vec4(grid_color.rgb, strength * (1.0 - smoothstep(0.25, 1.0, far)));
}
