// A ball, a rod or an arrow's head: one unit shape, placed many times.
#include "frame.glsl"
#include "marker_place.glsl"
#include "marker_point.glsl"

out MarkerPoint point;

void main() {
  vec4 world = marker_position();
  // Rotation times scale: its inverse transpose divides each column by its squared length.
  mat3 columns = transpose(mat3(row_x.xyz, row_y.xyz, row_z.xyz));
  vec3 squared = vec3(dot(columns[0], columns[0]), dot(columns[1], columns[1]), dot(columns[2], columns[2]));
  point.position = world.xyz;
  point.normal = columns * (normal / squared);
  point.tint = tint;
  gl_Position = view_projection * world;
}
