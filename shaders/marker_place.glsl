// A unit shape, drawn as instances.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 row_x;    // of the placement, world
layout(location = 3) in vec4 row_y;
layout(location = 4) in vec4 row_z;
layout(location = 5) in vec4 tint;     // linear RGB; w: roughness

vec4 marker_position() {
  vec4 p = vec4(position, 1.0);
  return vec4(dot(row_x, p), dot(row_y, p), dot(row_z, p), 1.0);
}
