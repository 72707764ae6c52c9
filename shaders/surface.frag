// A glTF metallic-roughness surface under the lamps and its surroundings.
#include "frame.glsl"
#include "environment.glsl"
#include "light.glsl"
#include "refraction.glsl"
#include "balls.glsl"
#include "shadow.glsl"
#include "material.glsl"
#include "bump.glsl"
#include "surface_point.glsl"
#include "tone.glsl"

layout(binding = 2) uniform sampler2D roughness_map;  // g: roughness, b: metallic
layout(binding = 4) uniform sampler2D occlusion_map;  // r
layout(binding = 5) uniform sampler2D emissive_map;
layout(binding = 9) uniform sampler2D transmission_map;  // r
layout(binding = 10) uniform sampler2D thickness_map;    // g

in SurfacePoint point;
flat in uint zone;

layout(location = 0) out vec4 color;

vec3 with_relief(vec3 n) {
  if (!on(kBump)) return n;
  n = normal_mapped(n, point.tangent, point.uv, numbers.z);
  return coat.z > 0.0 ? height_mapped(n, point.position, point.uv, coat.z) : n;
}

// Height as colour: blue is pushed in, red is raised.
vec3 tinted(vec3 albedo) {
  float x = clamp(point.height * picture.z, -1.0, 1.0);
  return mix(albedo, x < 0.0 ? vec3(0.05, 0.2, 0.9) : vec3(0.9, 0.15, 0.05), sqrt(abs(x)));
}

// Pressed tissue is pale: blood is pushed out of a dent within some two millimetres of depth.
vec3 blanched(vec3 albedo) {
  float pressed = scatter.w * (1.0 - exp(500.0 * min(point.height, 0.0)));
  float most = max(albedo.r, max(albedo.g, albedo.b));
  return mix(albedo, most * vec3(1.0, 0.82, 0.72), 0.6 * pressed);
}

// A colour per zone, distinct from its neighbours': steps of the golden ratio around the colour circle.
vec3 zone_color(uint number) {
  vec3 hue = fract(float(number) * 0.61803399 + vec3(0.0, 1.0 / 3.0, 2.0 / 3.0));
  return 0.1 + 0.7 * smoothstep(0.15, 0.85, abs(2.0 * hue - 1.0));
}

void main() {
  vec4 base = base_color_at(point.uv);
  if (base.a < emissive.w) discard;
  float through = on(kRefraction) ? volume.x * texture(transmission_map, point.uv).r : 0.0;
  if (on(kZones)) base.rgb = zone_color(zone), through = 0.0;
  base.rgb = blanched(base.rgb);
  if (picture.z > 0.0) base.rgb = tinted(base.rgb);
  vec4 map = texture(roughness_map, point.uv);
  float metallic = numbers.x * map.b;
  vec3 normal = normalize(gl_FrontFacing ? point.normal : -point.normal);

  Surface s;
  s.position = point.position;
  s.normal = with_relief(normal);
  s.to_eye = normalize(eye.xyz - point.position);
  s.diffuse = base.rgb * (1.0 - metallic) * (1.0 - through) * (1.0 - specular.w);
  s.reflectance = mix(specular.rgb, base.rgb, metallic);
  s.roughness = steadied(clamp(numbers.y * map.g, 0.045, 1.0), s.normal);
  s.wrap = scatter.rgb;
  s.behind = behind.rgb * (1.0 - metallic) * (1.0 - through);
  s.coat_normal = normal;
  s.coat = vec2(coat.y, steadied(clamp(coat.w, 0.045, 1.0), normal));
  s.nearby = nearby_at(point.position, normal);
  s.facing = on(kOccluded) ? normalize(s.normal + s.nearby.bent - normal) : s.normal;
  s.occlusion = mix(1.0, texture(occlusion_map, point.uv).r, numbers.w) * open_to_balls(point.position, normal);

  float open = min(min(s.nearby.lit, open_past_balls(point.position)), open_to_lamp(point.position, normal));
  vec3 light = lit_by_lamps(s, open) + lit_by_surroundings(s);
  if (through > 0.0) {
    vec3 entering = base.rgb * (1.0 - metallic) * through * (1.0 - coat_of_surroundings(s));
    float thickness = volume.z * texture(thickness_map, point.uv).g;
    light += entering * seen_through(s, Through(volume.y, thickness, absorption.rgb), gl_FragCoord.z);
  }
  light += emissive.rgb * texture(emissive_map, point.uv).rgb;
  color = vec4(tone_mapped(light), coat.x > 0.0 ? base.a : 1.0);
}
