in vec3 world_position;
in vec3 world_normal;
flat in float bone;

uniform vec3 bone_color;   // linear
uniform vec3 joint_color;  // linear

out vec4 color;

void main() { color = vec4(lit(world_position, normalize(world_normal), bone > 0.5 ? bone_color : joint_color), 1.0); }
