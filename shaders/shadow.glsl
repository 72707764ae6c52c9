// Unblocked share of the first lamp's light: nine filtered comparisons in the depth map, which the shadow pass drew of
// the same deformed surfaces.

layout(binding = 7) uniform sampler2DShadow shadow_map;

// Share of the light at a place of the map: xy [1], z its depth.
float open_at(vec3 p) {
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += float((2 - abs(x)) * (2 - abs(y))) * texture(shadow_map, p + vec3(1.5 * shadow.y * vec2(x, y), 0.0));
  return sum / 16.0;
}

// `normal` is the geometric normal, without bump mapping. The sample point is offset along it, farther at grazing
// light, so that a surface does not shadow itself by the width of a texel.
float open_to_lamp(vec3 position, vec3 normal) {
  if (!on(kShadows)) return 1.0;
  vec3 to_light = normalize(lamps[0].place.xyz - lamps[0].place.w * position);
  float n_l = dot(normal, to_light);
  float lift = shadow.x * (1.0 + 2.5 * sqrt(max(0.0, 1.0 - n_l * n_l)));
  vec4 p = shadow_from_world * vec4(position + lift * normal, 1.0);
  p.xyz /= p.w;
  if (p.w <= 0.0 || any(lessThan(p.xyz, vec3(0.0))) || any(greaterThan(p.xyz, vec3(1.0)))) return 1.0;
  return open_at(p.xyz);
}

// The same for a point that may lie behind everything in the map, such as the ground.
float open_to_lamp_behind(vec3 position) {
  vec4 p = shadow_from_world * vec4(position, 1.0);
  p.xyz /= p.w;
  if (!on(kShadows) || p.w <= 0.0 || any(lessThan(p.xy, vec2(0.0))) || any(greaterThan(p.xy, vec2(1.0)))) return 1.0;
  return open_at(vec3(p.xy, min(p.z, 1.0)));
}
