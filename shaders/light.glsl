// Reflection model: Lambert's diffuse layer under a GGX coat, as in glTF (Walter et al., EGSR 2007; height-correlated
// shadowing as in Heitz, JCGT 2014).

struct Surface {
  vec3 position;      // [m] world
  vec3 normal;        // [1]
  vec3 to_eye;        // [1]
  vec3 diffuse;       // [1] diffuse albedo
  vec3 reflectance;   // [1] of the coat, at normal incidence
  float roughness;    // [1] perceptual
  float occlusion;    // [1] 1: open to the sky
};

vec3 fresnel(vec3 f0, float cos_angle) { return f0 + (1.0 - f0) * pow(1.0 - cos_angle, 5.0); }

float ggx(float n_h, float alpha) {
  float a2 = alpha * alpha, d = n_h * n_h * (a2 - 1.0) + 1.0;
  return a2 / (kPi * d * d);
}

// Shadowing and masking, already divided by 4 (n.l)(n.v).
float visibility(float n_l, float n_v, float alpha) {
  float a2 = alpha * alpha;
  float v = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2), l = n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
  return 0.5 / max(v + l, 1e-5);
}

// One lamp: unit direction towards it, and its illuminance at `position` [lx].
vec3 arriving_from(Lamp lamp, vec3 position, out vec3 to_light) {
  vec3 way = lamp.place.xyz - lamp.place.w * position;
  float distance2 = max(dot(way, way), 1e-8);
  to_light = way * inversesqrt(distance2);
  float reach = lamp.color.w > 0.0 ? pow(max(0.0, 1.0 - pow(distance2 / (lamp.color.w * lamp.color.w), 2.0)), 2.0) : 1.0;
  float cone = lamp.axis.w > 0.0 ? clamp(dot(-to_light, lamp.axis.xyz) * lamp.axis.w + lamp.more.x, 0.0, 1.0) : 1.0;
  return lamp.color.rgb * (lamp.place.w > 0.0 ? reach * cone * cone / distance2 : 1.0);
}

vec3 lit_by(Lamp lamp, Surface s) {
  vec3 l;
  vec3 arriving = arriving_from(lamp, s.position, l);
  float n_l = dot(s.normal, l), n_v = max(dot(s.normal, s.to_eye), 1e-3);
  if (n_l <= 0.0) return vec3(0.0);
  vec3 h = normalize(l + s.to_eye);
  float alpha = s.roughness * s.roughness;
  vec3 mirrored = fresnel(s.reflectance, max(dot(l, h), 0.0));
  vec3 coat = mirrored * ggx(max(dot(s.normal, h), 0.0), alpha) * visibility(n_l, n_v, alpha);
  return arriving * n_l * ((1.0 - mirrored) * s.diffuse / kPi + coat);  // light mirrored by the coat does not enter
}

// All lamps; the first is scaled by `open`, its unshadowed share.
vec3 lit_by_lamps(Surface s, float open) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < modes.x; ++i) sum += (i == 0u ? open : 1.0) * lit_by(lamps[i], s);
  return sum;
}

// The coat's directional reflectance, the second factor of the split sum (systems/visual/coat.h).
layout(binding = 8) uniform sampler2D coat_map;
vec3 coat_of_surroundings(Surface s) {
  vec2 ab = textureLod(coat_map, vec2(max(dot(s.normal, s.to_eye), 0.0), s.roughness), 0.0).rg;
  return s.reflectance * ab.x + ab.y;
}

vec3 lit_by_surroundings(Surface s) {
  vec3 coat = coat_of_surroundings(s);
  vec3 light = (1.0 - coat) * s.diffuse / kPi * irradiance_on(s.normal);
  if (on(kReflection)) light += coat * radiance_from(reflect(-s.to_eye, s.normal), s.roughness);
  return s.occlusion * light;
}
