// A surface, given way.
#include "frame.glsl"
#include "deform.glsl"
#include "placement.glsl"

layout(location = 0) in vec3 position;      // [m] P0, object frame
layout(location = 1) in vec3 touch_normal;  // [1] N0
layout(location = 2) in vec3 normal;        // [1] to shade with
layout(location = 3) in vec4 tangent;
layout(location = 4) in vec2 uv;
layout(location = 5) in uint touch_vertex;

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
  vec4 s = stream[touch_vertex];
  vec4 world = to_world * vec4(deformed_position(position, touch_normal, s), 1.0);
  to.position = world.xyz;
  to.normal = mat3(normal_to_world) * deformed_normal(normal, s);
  to.tangent = vec4(mat3(to_world) * tangent.xyz, tangent.w);
  to.uv = uv;
  to.height = s.w;
  to.zone = touch_vertex / kZoneSize;
  gl_Position = view_projection * world;
}
