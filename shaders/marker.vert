// A ball, a rod or an arrow's head: one unit shape, placed many times.
#include "frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 row_x;    // of the placement, world
layout(location = 3) in vec4 row_y;
layout(location = 4) in vec4 row_z;
layout(location = 5) in vec4 tint;     // linear RGB; w: roughness

out Varying {
  vec3 position;
  vec3 normal;
  vec4 tint;
} to;

void main() {
  vec4 p = vec4(position, 1.0);
  vec4 world = vec4(dot(row_x, p), dot(row_y, p), dot(row_z, p), 1.0);
  // Rotation times scale: its inverse transpose divides each column by its squared length.
  mat3 columns = transpose(mat3(row_x.xyz, row_y.xyz, row_z.xyz));
  vec3 squared = vec3(dot(columns[0], columns[0]), dot(columns[1], columns[1]), dot(columns[2], columns[2]));
  to.position = world.xyz;
  to.normal = columns * (normal / squared);
  to.tint = tint;
  gl_Position = view_projection * world;
}
