// Occlusion of a point of the picture: the mean of the nearest pixels of occlusion_mean.frag that are of its surface.

#include "seen.glsl"

layout(binding = 18) uniform sampler2D nearby_map;

struct Nearby {
  vec3 bent;   // [1] mean direction in which the surroundings are seen, world
  float open;  // [1] share of them that is seen, weighted by the cosine
  float lit;   // [1] share of the first lamp's light that nothing near blocks
};

// `position` of the fragment [m] and its normal, world.
Nearby nearby_at(vec3 position, vec3 n) {
  if (!on(kOccluded)) return Nearby(n, 1.0, 1.0);
  vec3 p = (view * vec4(position, 1.0)).xyz, n_seen = mat3(view) * n;
  ivec2 corner = ivec2(floor(0.5 * gl_FragCoord.xy - 0.5));
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 texel = clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), seen_size() - 1);
    float weight = same_surface(p, n_seen, texel);
    sum += weight * texelFetch(nearby_map, texel, 0);
    weights += weight;
  }
  if (weights < 1e-3) return Nearby(n, 1.0, 1.0);
  sum /= weights;
  vec2 xy = 2.0 * sum.xy - 1.0;
  vec3 bent = vec3(xy, sqrt(max(1.0 - dot(xy, xy), 0.0))) * mat3(view);
  return Nearby(bent, sum.w, sum.z);
}

// Light that arrives after several bounces between surfaces of this albedo (Jimenez et al. 2016, equation 10).
vec3 bounced(float open, vec3 albedo) {
  if (open >= 1.0) return vec3(1.0);
  vec3 a = 2.0404 * albedo - 0.3324, b = 0.6417 - 4.7951 * albedo, c = 2.7552 * albedo + 0.6903;
  return max(vec3(open), ((open * a + b) * open + c) * open);
}

// Share of a mirrored lobe that sees the surroundings (Lagarde and de Rousiers, Moving Frostbite to Physically Based
// Rendering, SIGGRAPH 2014, listing 26).
float open_to_lobe(float n_v, float open, float roughness) {
  if (open >= 1.0) return 1.0;
  return clamp(pow(max(n_v, 0.0) + open, exp2(-16.0 * roughness - 1.0)) - 1.0 + open, 0.0, 1.0);
}
