// The ground's normal in the picture's view.
#include "frame.glsl"

layout(location = 0) out vec4 seen;

void main() { seen = vec4(0.5 + 0.5 * view[1].xyz, 1.0); }
