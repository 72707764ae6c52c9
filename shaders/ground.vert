// The ground's square, for ambient occlusion.
#include "frame.glsl"

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  gl_Position = view_projection * vec4(ground.xyz + ground.w * vec3(corner.x, 0.0, -corner.y), 1.0);
}
