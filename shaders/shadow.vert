// The surface as the first lamp sees it, given way like the one that the eye sees.
#include "frame.glsl"
#include "deform.glsl"
#include "placement.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 touch_normal;
layout(location = 4) in vec2 uv;
layout(location = 5) in uint touch_vertex;

out vec2 at;

void main() {
  vec4 world = to_world * vec4(deformed_position(position, touch_normal, stream[touch_vertex]), 1.0);
  at = uv;
  vec4 p = shadow_from_world * world;  // texture coordinates, back to the clip cube
  gl_Position = vec4(2.0 * p.xyz - p.w, p.w);
}
