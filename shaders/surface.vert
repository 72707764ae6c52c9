// A deformed surface.
#include "frame.glsl"
#include "surface_point.glsl"
#include "vertex.glsl"

out SurfacePoint point;
flat out uint zone;

const uint kZoneSize = 128u;

void main() {
  vec4 world = world_position();
  point.position = world.xyz;
  point.normal = world_normal();
  point.tangent = vec4(world_tangent(), tangent.w);
  point.uv = uv;
  point.height = height();
  zone = touch_vertex / kZoneSize;
  gl_Position = view_projection * world;
}
