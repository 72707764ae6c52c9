// The surface seen through one pixel: its position, and the rest position of the same point.
#include "vertex.glsl"

uniform mat4 clip_from_world;  // of the view, narrowed to the pixel

out vec2 at;
out vec3 place;         // [m] world, as drawn
out vec3 rest;          // [m] world, at rest
out vec3 rest_outward;  // [1] world, not unit

void main() {
  vec4 world = world_position();
  at = uv;
  place = world.xyz;
  rest = rides() ? world.xyz : (to_world * vec4(position, 1.0)).xyz;
  rest_outward = rides() ? world_normal() : mat3(normal_to_world) * touch_normal;
  gl_Position = clip_from_world * world;
}
