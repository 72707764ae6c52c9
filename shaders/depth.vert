// A deformed surface in the picture's view: its depth and normal, for ambient occlusion.
#include "frame.glsl"
#include "vertex.glsl"

out vec2 at;
out vec3 outward;

void main() {
  at = uv;
  outward = mat3(view) * world_normal();
  gl_Position = view_projection * world_position();
}
