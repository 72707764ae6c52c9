// The object at this pixel, and its position. Numbers as bits: an integer target keeps them exactly.
#include "placement.glsl"
#include "material.glsl"

in vec2 at;
in vec3 place;
in vec3 rest;
in vec3 rest_outward;

layout(location = 0) out uvec4 seen;  // the object's number; bits of the place [m] as drawn
layout(location = 1) out uvec4 home;  // bits of the place [m] at rest
layout(location = 2) out uvec4 outward;

void main() {
  if (emissive.w > 0.0 && base_color_at(at).a < emissive.w) discard;
  seen = uvec4(object.x, floatBitsToUint(place));
  home = uvec4(0u, floatBitsToUint(rest));
  outward = uvec4(0u, floatBitsToUint(rest_outward));
}
