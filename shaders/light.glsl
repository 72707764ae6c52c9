// Reflection model: Lambert's diffuse layer under a GGX coat, as in glTF (Walter et al., EGSR 2007; height-correlated
// shadowing as in Heitz, JCGT 2014).

#include "nearby.glsl"

struct Surface {
  vec3 position;      // [m] world
  vec3 normal;        // [1]
  vec3 to_eye;        // [1]
  vec3 diffuse;       // [1] diffuse albedo
  vec3 reflectance;   // [1] of the coat, at normal incidence
  float roughness;    // [1] perceptual
  vec3 wrap;          // [1] how far diffuse light wraps around the body, per channel
  vec3 behind;        // [1] share of the light on the far side that comes through
  vec3 coat_normal;   // [1] of the clear coat, which fills the relief
  vec2 coat;          // [1] clear coat and its roughness (KHR_materials_clearcoat)
  float occlusion;    // [1] 1: open to the sky
  vec3 facing;        // [1] where most of the surroundings' light comes from
  Nearby nearby;
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

// A glossy layer of this reflectance: light of direction `l` towards the eye, for one unit of irradiance.
float gloss(vec3 n, vec3 l, vec3 to_eye, float roughness) {
  float n_l = dot(n, l);
  if (n_l <= 0.0) return 0.0;
  float alpha = roughness * roughness;
  return n_l * ggx(max(dot(n, normalize(l + to_eye)), 0.0), alpha) * visibility(n_l, max(dot(n, to_eye), 1e-3), alpha);
}

// Cosine of the angle of incidence, wrapped around the body: the same light in all, spread beyond the edge of shade.
// The body's own shadow does not cover that edge; shadows of others have soft, coloured borders.
vec3 wrapped(float n_l, vec3 wrap, float open) {
  if (wrap == vec3(0.0)) return vec3(open * max(n_l, 0.0));
  float edge = max(open, 1.0 - smoothstep(0.0, 0.25, n_l));
  return pow(vec3(edge), 1.0 / (1.0 + 2.0 * wrap)) * max(n_l + wrap, 0.0) / ((1.0 + wrap) * (1.0 + wrap));
}

const vec3 kCoat = vec3(0.04);  // reflectance of a clear coat at normal incidence

// `open`: the lamp's unshadowed share.
vec3 lit_by(Lamp lamp, Surface s, float open) {
  vec3 l;
  vec3 arriving = arriving_from(lamp, s.position, l);
  float n_l = dot(s.normal, l);
  if (n_l <= 0.0 && s.coat.x == 0.0 && s.wrap == vec3(0.0) && s.behind == vec3(0.0)) return vec3(0.0);
  vec3 h = normalize(l + s.to_eye);
  vec3 mirrored = fresnel(s.reflectance, max(dot(l, h), 0.0));
  vec3 light = (1.0 - mirrored) * s.diffuse / kPi * wrapped(n_l, s.wrap, open);  // mirrored light does not enter
  light += open * mirrored * gloss(s.normal, l, s.to_eye, s.roughness);
  light += s.behind / kPi * max(-n_l, 0.0);
  if (s.coat.x > 0.0) {
    vec3 film = s.coat.x * fresnel(kCoat, max(dot(l, h), 0.0));
    light = (1.0 - film) * light + open * film * gloss(s.coat_normal, l, s.to_eye, s.coat.y);
  }
  return arriving * light;
}

// All lamps; `open` is the first one's unshadowed share.
vec3 lit_by_lamps(Surface s, float open) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < modes.x; ++i) sum += lit_by(lamps[i], s, i == 0u ? open : 1.0);
  return sum;
}

// The coat's directional reflectance, the second factor of the split sum (systems/visual/coat.h).
layout(binding = 8) uniform sampler2D coat_map;
vec3 mirrored_by(vec3 n, vec3 to_eye, vec3 reflectance, float roughness) {
  vec2 ab = textureLod(coat_map, vec2(max(dot(n, to_eye), 0.0), roughness), 0.0).rg;
  return reflectance * ab.x + ab.y;
}
vec3 coat_of_surroundings(Surface s) { return mirrored_by(s.normal, s.to_eye, s.reflectance, s.roughness); }

// Surroundings mirrored in a layer of this normal, as far as nothing near occludes them.
vec3 mirrored_from(Surface s, vec3 n, float roughness) {
  return open_to_lobe(dot(n, s.to_eye), s.nearby.open, roughness) * radiance_from(reflect(-s.to_eye, n), roughness);
}

vec3 lit_by_surroundings(Surface s) {
  vec3 coat = coat_of_surroundings(s);
  vec3 light = (1.0 - coat) * s.diffuse / kPi * irradiance_on(s.facing) * bounced(s.nearby.open, s.diffuse);
  if (s.behind != vec3(0.0)) light += s.behind / kPi * irradiance_on(-s.normal);
  if (on(kReflection)) light += coat * mirrored_from(s, s.normal, s.roughness);
  if (s.coat.x > 0.0) {
    vec3 film = s.coat.x * mirrored_by(s.coat_normal, s.to_eye, kCoat, s.coat.y);
    light *= 1.0 - film;
    if (on(kReflection)) light += film * mirrored_from(s, s.coat_normal, s.coat.y);
  }
  return s.occlusion * light;
}
