// The deformed surface in the first lamp's view.
#include "frame.glsl"
#include "vertex.glsl"

out vec2 at;

void main() {
  at = uv;
  vec4 p = shadow_from_world * world_position();  // texture coordinates, back to the clip cube
  gl_Position = vec4(2.0 * p.xyz - p.w, p.w);
}
