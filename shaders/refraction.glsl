// Refraction through a body. A thick body bends the ray twice, like a ball whose diameter is the local thickness. This
// needs no second surface, and it inverts the image as a drop does. A body without thickness is a pane: the ray
// continues straight. If the scene has an object behind the exit point, its colour is sampled from a picture of the
// opaque objects; else the surroundings are seen.

layout(binding = 11) uniform sampler2D behind_map;        // linear radiance; a: 1 where an object was drawn
layout(binding = 12) uniform sampler2D behind_depth_map;

struct Through {
  float ior;         // [1]
  float thickness;   // [m] 0: a pane
  vec3 absorption;   // [1/m] Beer's law
};

// Colour of the picture at the projection of world point `p`, farther than depth `nearest`; a: coverage. Each of the
// four neighbouring pixels is tested by its depth. Filtered colour with a single depth test would draw outlines of
// objects in front of the body, as dotted lines.
vec4 standing_behind(vec3 p, float nearest) {
  if (!on(kBehind)) return vec4(0.0);
  vec4 clip = view_projection * vec4(p, 1.0);
  vec2 uv = 0.5 + 0.5 * clip.xy / max(clip.w, 1e-6);
  if (any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec4(0.0);
  ivec2 size = textureSize(behind_map, 0);
  vec2 place = uv * vec2(size) - 0.5, share = fract(place);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1), texel = clamp(ivec2(floor(place)) + corner, ivec2(0), size - 1);
    vec2 weight = mix(1.0 - share, share, vec2(corner));
    if (texelFetch(behind_depth_map, texel, 0).r > nearest)
      sum += weight.x * weight.y * texelFetch(behind_map, texel, 0);
  }
  return sum;
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
    way = refract(inside, -far_normal, t.ior);          // never totally reflected: exit and entry angles are equal
  }
  // The blur of a rough surface fades as its index approaches that of air.
  vec3 surrounding = radiance_from(way, s.roughness * clamp(2.0 * t.ior - 2.0, 0.0, 1.0));
  vec4 standing = standing_behind(leaves, depth);
  return remains * (surrounding * (1.0 - standing.a) + standing.rgb);
}
