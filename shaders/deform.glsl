// P1's two lines, for every pass that draws a surface: colour, shadow and picking.
//
//   position = P0 + h N0
//   normal   = N0 + (nx, ny, nz)
//
// P0 and N0 are constant, in vertex buffers; (nx, ny, nz, h) is read from the stream of the touch vertex. The height
// acts along the touch normal. The correction is a gradient in the object frame and applies to any unit shading normal.

#ifdef PLIANT_ES
#include "table.glsl"
layout(binding = 13) uniform sampler2D stream_map;
vec4 stream_at(uint touch_vertex) { return texelFetch(stream_map, texel_of(touch_vertex), 0); }
#else
layout(std430, binding = 0) readonly buffer Stream { vec4 stream[]; };  // [1,1,1,m] by touch vertex
vec4 stream_at(uint touch_vertex) { return stream[touch_vertex]; }
#endif

vec3 deformed_position(vec3 P0, vec3 N0, vec4 s) { return P0 + s.w * N0; }
vec3 deformed_normal(vec3 N0, vec4 s) { return normalize(N0 + s.xyz); }
