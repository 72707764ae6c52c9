// What is seen through a body. A body of some thickness bends the ray twice, as if it were, right here, a ball whose
// diameter is the thickness: that alone needs no second surface, and it turns the world upside down as a drop does. A
// body without thickness is a pane: the ray goes straight on. Where something of the scene stands behind the place at
// which the ray leaves, it is taken from a picture of what does not transmit; else the surroundings are seen.

layout(binding = 11) uniform sampler2D behind_map;        // linear radiance; a: 1 where something stands
layout(binding = 12) uniform sampler2D behind_depth_map;

struct Through {
  float ior;         // [1]
  float thickness;   // [m] 0: a pane
  vec3 absorption;   // [1/m] Beer's law
};

// What stands in the picture where world point `p` would, farther than depth `nearest`; a: how much of it.
vec4 standing_behind(vec3 p, float nearest) {
  if (!on(kBehind)) return vec4(0.0);
  vec4 clip = view_projection * vec4(p, 1.0);
  vec2 uv = 0.5 + 0.5 * clip.xy / max(clip.w, 1e-6);
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec4(0.0);
  return texture(behind_depth_map, uv).r > nearest ? texture(behind_map, uv) : vec4(0.0);
}

vec3 seen_through(Surface s, Through t, float depth) {
  vec3 way = -s.to_eye, leaves = s.position;
  vec3 remains = vec3(1.0);
  if (t.thickness > 0.0) {
    vec3 inside = refract(way, s.normal, 1.0 / t.ior);
    float along = dot(s.normal, inside);               // < 0
    vec3 far_normal = s.normal - 2.0 * along * inside;  // of the ball, where the chord ends
    leaves -= t.thickness * along * inside;
    remains = exp(t.absorption * t.thickness * along);
    way = refract(inside, -far_normal, t.ior);          // never totally reflected: the angles are those of entry
  }
  // The blur of a rough surface fades as its index nears that of air.
  vec3 surrounding = radiance_from(way, s.roughness * clamp(2.0 * t.ior - 2.0, 0.0, 1.0));
  vec4 standing = standing_behind(leaves, depth);
  return remains * (surrounding * (1.0 - standing.a) + standing.rgb);
}
