// Occlusion and soft shadows of the balls of probes, in closed form; they are not among the surfaces.

// Share of the surroundings that no ball covers (Quilez, Sphere ambient occlusion: exact above the horizon).
float open_to_balls(vec3 position, vec3 n) {
  float open = 1.0;
  for (uint i = 0u; i < modes.z; ++i) {
    vec3 way = balls[i].xyz - position;
    float r2 = balls[i].w * balls[i].w, d2 = max(dot(way, way), 1e-12), up = dot(n, way);
    float covered = up * inversesqrt(d2) * r2 / d2;
    if (up * up < r2) covered = pow(clamp(0.5 * (up / balls[i].w + 1.0) * r2 / d2, 0.0, 1.0), 1.5);  // partly below it
    open *= 1.0 - clamp(covered, 0.0, 1.0);
  }
  return open;
}

// Unblocked share of the first lamp's light, whose disc is as wide as the sun's through thin cloud (Quilez, Sphere soft
// shadow). The shadow map begins a few of its texels away from a contact; this does not.
float open_past_balls(vec3 position) {
  float open = 1.0;
  if (!on(kContact)) return open;
  vec3 way = normalize(lamps[0].place.xyz - lamps[0].place.w * position);
  for (uint i = 0u; i < modes.z; ++i) {
    vec3 from = position - balls[i].xyz;
    float along = -dot(from, way), r = balls[i].w;
    if (along <= 0.0) continue;
    float beside = sqrt(max(dot(from, from) - along * along, 0.0)) - r;  // < 0: behind the ball
    open = min(open, smoothstep(-0.5, 0.5, beside / (0.12 * along + 0.02 * r)));
  }
  return open;
}
