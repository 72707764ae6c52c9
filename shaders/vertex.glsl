// Deformed vertex of a surface in world: displaced by the stream, or read from the skin buffer. Used by the colour,
// shadow and picking passes.
#include "deform.glsl"
#include "placement.glsl"
#include "skin.glsl"

layout(location = 0) in vec3 position;      // [m] P0, object frame
layout(location = 1) in vec3 touch_normal;  // [1] N0
layout(location = 2) in vec3 normal;        // [1] to shade with
layout(location = 3) in vec4 tangent;
layout(location = 4) in vec2 uv;
layout(location = 5) in uint touch_vertex;

bool rides() { return object.y != 0u; }

vec4 world_position() {
  if (rides()) return vec4(skin_position(touch_vertex), 1.0);
  return to_world * vec4(deformed_position(position, touch_normal, stream_at(touch_vertex)), 1.0);
}

// Not unit.
vec3 world_normal() {
  if (rides()) return skin_normal(touch_vertex);
  return mat3(normal_to_world) * deformed_normal(normal, stream_at(touch_vertex));
}

// Not unit, and perpendicular to the normal only at rest.
vec3 world_tangent() {
  vec3 t = mat3(to_world) * tangent.xyz;
  return rides() ? turned(t, normalize(mat3(normal_to_world) * normal), skin_normal(touch_vertex)) : t;
}

// [m] along the normal, of a deformable surface.
float height() { return rides() ? 0.0 : stream_at(touch_vertex).w; }
