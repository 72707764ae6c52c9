// End points of lines.
#include "frame.glsl"

layout(location = 0) in vec3 position;  // [m] world

void main() { gl_Position = view_projection * vec4(position, 1.0); }
