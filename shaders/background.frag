// The surroundings, out of focus.
#include "frame.glsl"
#include "environment.glsl"
#include "tone.glsl"

in vec3 direction;
layout(location = 0) out vec4 color;

const float kDimmed = 0.6;  // so that the scene stands out

void main() { color = vec4(tone_mapped(kDimmed * smooth_radiance_from(normalize(direction), int(picture.w))), 1.0); }
