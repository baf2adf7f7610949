// What all draws of one picture share; render/renderer.cpp fills it in (std140).
layout(std140, binding = 0) uniform Frame {
  mat4 clip_from_world;
  vec4 eye;             // world space, metres
  vec4 light_position;  // world space, metres
  vec4 light_terms;     // ambient, diffuse, specular, shininess
  vec4 grid_terms;      // cell (metres), where it has faded (metres), 0, 0
  vec4 grid_color;      // linear
};
