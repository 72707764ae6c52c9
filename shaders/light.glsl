// How a surface answers light: a soft diffuse layer under a GGX coat (Walter et al., EGSR 2007; height-correlated
// shadowing as in Heitz, JCGT 2014).

struct Surface {
  vec3 position;      // [m] world
  vec3 normal;        // [1]
  vec3 to_eye;        // [1]
  vec3 diffuse;       // [1] albedo of what enters
  vec3 reflectance;   // [1] of the coat, seen straight on
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

// Soft tissue bleeds light a little past the terminator; the division keeps the total the same.
float wrapped(float n_l) {
  const float kWrap = 0.2;
  return max(0.0, n_l + kWrap) / ((1.0 + kWrap) * (1.0 + kWrap));
}

// The key light: unit direction towards it, and what arrives from there at `position` [lx].
vec3 key_light(vec3 position, out vec3 to_light) {
  vec3 way = key_place.xyz - key_place.w * position;
  float distance2 = max(dot(way, way), 1e-8);
  to_light = way * inversesqrt(distance2);
  float reach = key_color.w > 0.0 ? pow(max(0.0, 1.0 - pow(distance2 / (key_color.w * key_color.w), 2.0)), 2.0) : 1.0;
  float cone = key_axis.w > 0.0 ? clamp(dot(-to_light, key_axis.xyz) * key_axis.w + picture.y, 0.0, 1.0) : 1.0;
  return key_color.rgb * (key_place.w > 0.0 ? reach * cone * cone / distance2 : 1.0);
}

vec3 lit_by_key(Surface s) {
  vec3 l;
  vec3 arriving = key_light(s.position, l);
  vec3 h = normalize(l + s.to_eye);
  float n_l = dot(s.normal, l), n_v = max(dot(s.normal, s.to_eye), 1e-3);
  float alpha = s.roughness * s.roughness;
  vec3 coat = fresnel(s.reflectance, max(dot(l, h), 0.0)) * ggx(max(dot(s.normal, h), 0.0), alpha) *
              visibility(max(n_l, 0.0), n_v, alpha) * max(n_l, 0.0);
  return arriving * (s.diffuse / kPi * wrapped(n_l) + coat);
}

// Karis, Physically Based Shading on Mobile (2014): how much a rough coat returns of an even surrounding.
vec3 coat_of_surroundings(vec3 f0, float roughness, float n_v) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
  return f0 * (-1.04 * a + r.z) + (1.04 * a + r.w);
}

vec3 lit_by_surroundings(Surface s) {
  float n_v = max(dot(s.normal, s.to_eye), 1e-3);
  vec3 mirrored = radiance_from(reflect(-s.to_eye, s.normal), s.roughness * surroundings.w);
  return s.occlusion * (s.diffuse / kPi * irradiance_on(s.normal) +
                        mirrored * coat_of_surroundings(s.reflectance, s.roughness, n_v));
}
