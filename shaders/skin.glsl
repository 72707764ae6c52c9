// The deformed collision mesh of a soft body, for every pass that draws a surface. It moves with its tetrahedra, so
// there is no rest normal for a height. Position and normal themselves are uploaded, 16 bytes per vertex, as for P1's
// stream.

// By touch vertex; xyz: bits of the position [m], w: the normal, folded; both in world.
#ifdef PLIANT_ES
#include "table.glsl"
layout(binding = 14) uniform usampler2D skin_map;
uvec4 skin_at(uint vertex) { return texelFetch(skin_map, texel_of(vertex), 0); }
#else
layout(std430, binding = 1) readonly buffer Skin { uvec4 skin[]; };
uvec4 skin_at(uint vertex) { return skin[vertex]; }
#endif

// A unit vector from its octahedral mapping (Cigolle et al., A Survey of Efficient Representations for Independent Unit
// Vectors, JCGT 3(2), 2014).
vec3 unfolded(vec2 f) {
  vec3 n = vec3(f, 1.0 - abs(f.x) - abs(f.y));
  float below = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -below : below;
  n.y += n.y >= 0.0 ? -below : below;
  return normalize(n);
}

vec3 skin_position(uint vertex) { return uintBitsToFloat(skin_at(vertex).xyz); }
vec3 skin_normal(uint vertex) { return unfolded(unpackSnorm2x16(skin_at(vertex).w)); }

// `t` rotated by the shortest rotation from unit vector `a` to unit vector `b`.
vec3 turned(vec3 t, vec3 a, vec3 b) {
  vec3 axis = cross(a, b);
  return dot(a, b) * t + cross(axis, t) + axis * (dot(axis, t) / max(1.0 + dot(a, b), 1e-4));
}
