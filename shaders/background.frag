// The surroundings, behind all objects.
#include "frame.glsl"
#include "environment.glsl"
#include "tone.glsl"

in vec3 direction;
layout(location = 0) out vec4 color;

void main() { color = vec4(tone_mapped(picture.y * radiance_from(normalize(direction), picture.w)), 1.0); }
