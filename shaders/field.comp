// The whole height field from the list of sources, on the GPU: stream[v] = sum of the sources' targets at v. No other
// data is uploaded, and nothing is kept from frame to frame (P1 section 5).
layout(local_size_x = 128) in;

#define SHARED
#include "shared/shape.glsl"
#include "shared/field.glsl"
#include "shape_list.glsl"

layout(std430, binding = 0) writeonly buffer Stream { vec4 stream[]; };
layout(std430, binding = 1) readonly buffer Rest { vec4 rest[]; };        // per vertex (P0 [m], N0.x), (N0.y, N0.z) packed:
layout(std430, binding = 2) readonly buffer RestNormal { vec2 rest_yz[]; };  // 24 bytes a vertex
struct Source {
  vec4 place, push, kind;
};
layout(std430, binding = 3) readonly buffer Sources { Source sources[]; };

uniform int source_count;
uniform uint vertex_count;

void main() {
  uint v = gl_GlobalInvocationID.x;
  if (v >= vertex_count) return;
  vec4 a = rest[v];
  vec3 P = a.xyz;
  vec3 N = vec3(a.w, rest_yz[v]);
  vec4 sum = vec4(0);
  for (int i = 0; i < source_count; ++i) {
    // A source has no effect on a vertex out of reach: skip its arithmetic.
    vec3 d = P - sources[i].place.xyz;
    if (dot(d, d) * sources[i].place.w >= 1.0) continue;
    sum += field_target(sources[i].place, sources[i].push, sources[i].kind, P, N);
  }
  stream[v] = sum;
}
