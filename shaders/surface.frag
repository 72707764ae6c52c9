// A glTF metallic-roughness surface under the key light and its surroundings.
#include "frame.glsl"
#include "environment.glsl"
#include "light.glsl"
#include "tone.glsl"

layout(std140, binding = 2) uniform MaterialOf {
  vec4 base_color;
  vec4 emissive;   // w: alpha below which nothing is drawn
  vec4 numbers;    // metallic, roughness, scale of the normal map, strength of the occlusion map
  vec4 modes;      // x: 1 if alpha blends; y: reflectance of the coat of a dielectric
};

layout(binding = 1) uniform sampler2D base_color_map;
layout(binding = 2) uniform sampler2D roughness_map;  // g: roughness, b: metallic
layout(binding = 3) uniform sampler2D normal_map;
layout(binding = 4) uniform sampler2D occlusion_map;  // r
layout(binding = 5) uniform sampler2D emissive_map;

in Varying {
  vec3 position;
  vec3 normal;
  vec4 tangent;
  vec2 uv;
  float height;
} from;

layout(location = 0) out vec4 color;

vec3 shading_normal() {
  vec3 n = normalize(gl_FrontFacing ? from.normal : -from.normal);
  vec3 t = from.tangent.xyz - n * dot(n, from.tangent.xyz);
  if (dot(t, t) < 1e-12) return n;
  t = normalize(t);
  vec3 m = texture(normal_map, from.uv).xyz * 2.0 - 1.0;
  return normalize(numbers.z * (m.x * t + m.y * from.tangent.w * cross(n, t)) + m.z * n);
}

// Height as colour: blue is pushed in, red stands out.
vec3 tinted(vec3 albedo) {
  float x = clamp(from.height * picture.z, -1.0, 1.0);
  return mix(albedo, x < 0.0 ? vec3(0.05, 0.2, 0.9) : vec3(0.9, 0.15, 0.05), sqrt(abs(x)));
}

void main() {
  vec4 base = base_color * texture(base_color_map, from.uv);
  if (base.a < emissive.w) discard;
  if (picture.z > 0.0) base.rgb = tinted(base.rgb);
  vec4 map = texture(roughness_map, from.uv);
  float metallic = numbers.x * map.b;

  Surface s;
  s.position = from.position;
  s.normal = shading_normal();
  s.to_eye = normalize(eye.xyz - from.position);
  s.diffuse = base.rgb * (1.0 - metallic);
  s.reflectance = mix(vec3(modes.y), base.rgb, metallic);
  s.roughness = clamp(numbers.y * map.g, 0.045, 1.0);
  s.occlusion = mix(1.0, texture(occlusion_map, from.uv).r, numbers.w);

  vec3 glow = emissive.rgb * texture(emissive_map, from.uv).rgb;
  color = vec4(tone_mapped(lit_by_key(s) + lit_by_surroundings(s) + glow), modes.x > 0.0 ? base.a : 1.0);
}
