// A ball in the first lamp's view.
#include "frame.glsl"
#include "marker_place.glsl"

void main() {
  vec4 p = shadow_from_world * marker_position();  // texture coordinates, back to the clip cube
  gl_Position = vec4(2.0 * p.xyz - p.w, p.w);
}
