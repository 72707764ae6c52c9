// One triangle over the whole picture, behind everything.
#include "frame.glsl"

out vec3 direction;  // [1] from the eye, world; not unit

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  vec4 far = inverse_view_projection * vec4(corner, 1.0, 1.0);
  direction = far.xyz / far.w - eye.xyz;
  gl_Position = vec4(corner, 1.0, 1.0);
}
