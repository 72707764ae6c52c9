// A deformed surface.
#include "frame.glsl"
#include "vertex.glsl"

out Varying {
  vec3 position;  // [m] world
  vec3 normal;
  vec4 tangent;
  vec2 uv;
  float height;   // [m]
  flat uint zone;
} to;

const uint kZoneSize = 128u;

void main() {
  vec4 world = world_position();
  to.position = world.xyz;
  to.normal = world_normal();
  to.tangent = vec4(world_tangent(), tangent.w);
  to.uv = uv;
  to.height = height();
  to.zone = touch_vertex / kZoneSize;
  gl_Position = view_projection * world;
}
