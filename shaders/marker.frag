// Markers: lit like everything else, so that they sit in the scene.
#include "frame.glsl"
#include "environment.glsl"
#include "light.glsl"
#include "marker_point.glsl"
#include "tone.glsl"

in MarkerPoint point;

layout(location = 0) out vec4 color;

void main() {
  Surface s;
  s.position = point.position;
  s.normal = normalize(point.normal);
  s.to_eye = normalize(eye.xyz - point.position);
  s.diffuse = point.tint.rgb;
  s.reflectance = vec3(0.04);
  s.roughness = point.tint.w;
  s.occlusion = 1.0;
  s.wrap = s.behind = vec3(0.0);
  s.coat = vec2(0.0);
  s.coat_normal = s.facing = s.normal;
  s.nearby = Nearby(s.normal, 1.0, 1.0);
  color = vec4(tone_mapped(lit_by_lamps(s, 1.0) + lit_by_surroundings(s)), 1.0);
}
