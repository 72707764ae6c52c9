// Markers: lit like everything else, so that they sit in the scene.
#include "frame.glsl"
#include "environment.glsl"
#include "light.glsl"
#include "tone.glsl"

in Varying {
  vec3 position;
  vec3 normal;
  vec4 tint;
} from;

layout(location = 0) out vec4 color;

void main() {
  Surface s;
  s.position = from.position;
  s.normal = normalize(from.normal);
  s.to_eye = normalize(eye.xyz - from.position);
  s.diffuse = from.tint.rgb;
  s.reflectance = vec3(0.04);
  s.roughness = from.tint.w;
  s.occlusion = 1.0;
  s.wrap = s.behind = vec3(0.0);
  s.coat = vec2(0.0);
  s.coat_normal = s.normal;
  color = vec4(tone_mapped(lit_by_lamps(s, 1.0) + lit_by_surroundings(s)), 1.0);
}
