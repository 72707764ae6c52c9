// Ambient occlusion and contact shadows from the depth of the picture, at half its resolution. Visibility is that of
// Jimenez et al., Practical Realtime Strategies for Accurate Indirect Occlusion, 2016, algorithm 1: in each slice
// through the view direction the horizons h on both sides, and the cosine-weighted arc between them. The samples of
// 4 x 4 pixels interleave; occlusion_mean.frag averages such blocks.
#include "frame.glsl"
#include "seen.glsl"

layout(location = 0) out vec4 found;  // bent normal's x and y in the view, 0.5 + 0.5 n; unshadowed share; visibility

const int kSlices = 2, kContactSteps = 8;
const float kHalfPi = 1.57079633;

// Within 7e-3 of acos.
float angle_of(float cosine) {
  float x = min(abs(cosine), 1.0), a = (kHalfPi - 0.156583 * x) * sqrt(1.0 - x);
  return cosine < 0.0 ? 2.0 * kHalfPi - a : a;
}

// Cosine of the highest angle at which something is seen along `way` [pixels, its whole reach] about the eye's side.
// Occluders fade with distance, towards the tangent plane's horizon `least`.
float horizon(vec3 p, vec3 to_eye, vec2 way, float least, float shift) {
  float highest = least;
  int steps = on(kContact) ? 8 : 4;
  for (int i = 0; i < steps; ++i) {
    float along = (float(i) + shift) / float(steps);
    vec3 d = place_at(gl_FragCoord.xy + way * along * along + sign(way)) - p;
    float length2 = max(dot(d, d), 1e-20);
    float near = clamp(1.5 - 1.5 * length2 / (nearby.x * nearby.x), 0.0, 1.0);
    highest = max(highest, mix(least, dot(d, to_eye) * inversesqrt(length2), near));
  }
  return highest;
}

// 0 where something lies within nearby.y on the way to the first lamp.
float open_nearby(vec3 p, vec3 n, float shift) {
  vec3 way = (view * lamps[0].place).xyz - lamps[0].place.w * p;
  way = normalize(way);
  float rise = dot(n, way);
  if (rise <= 0.0) return 1.0;
  vec3 from = p + 0.06 * nearby.y * n;
  for (int i = 0; i < kContactSteps; ++i) {
    float along = (float(i) + shift) / float(kContactSteps);
    vec3 q = from + nearby.y * along * way;
    vec2 pixel = (0.5 + 0.5 * q.xy / (-q.z * lens.xy)) * vec2(seen_size());
    float below = -q.z - distance_at(ivec2(floor(pixel)));
    if (below > 0.03 * nearby.y && below < nearby.y) return smoothstep(0.6, 1.0, along);
  }
  return 1.0;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  found = vec4(0.5, 0.5, 1.0, 1.0);
  if (texelFetch(depth_seen_map, texel, 0).r >= 1.0) return;
  vec3 p = place_at(gl_FragCoord.xy);
  vec3 n = normalize(2.0 * texelFetch(normal_seen_map, texel, 0).xyz - 1.0);
  vec3 to_eye = normalize(-p);
  float turn = 0.25 * float(texel.x & 3);  // of a slice's share
  float shift = 0.125 + 0.25 * float(texel.y & 3);
  float reach = min(0.5 * nearby.x * float(seen_size().y) / (lens.y * -p.z), 0.25 * float(seen_size().y));  // [pixels]
  float open = 0.0;
  vec3 bent = vec3(0.0);
  for (int i = 0; i < kSlices; ++i) {
    float phi = (float(i) + turn) * 2.0 * kHalfPi / float(kSlices);
    vec2 way = vec2(cos(phi), sin(phi));
    vec3 across = vec3(way, 0.0), sideways = across - dot(across, to_eye) * to_eye;
    vec3 axis = normalize(cross(across, to_eye)), flat_n = n - dot(n, axis) * axis;
    float share = max(length(flat_n), 1e-4), cos_n = clamp(dot(flat_n, to_eye) / share, -1.0, 1.0);
    float g = sign(dot(sideways, flat_n)) * angle_of(cos_n);  // of the projected normal
    float sin_g = sin(g);
    float h1 = angle_of(horizon(p, to_eye, reach * way, -sin_g, shift));
    float h0 = -angle_of(horizon(p, to_eye, -reach * way, sin_g, shift));
    h1 = g + min(h1 - g, kHalfPi);
    h0 = g + max(h0 - g, -kHalfPi);
    float arc = 0.25 * (2.0 * cos_n - cos(2.0 * h0 - g) - cos(2.0 * h1 - g) + 2.0 * (h0 + h1) * sin_g);
    float middle = 0.5 * (h0 + h1);
    open += share * arc;
    bent += share * arc * (cos(middle) * to_eye + sin(middle) * normalize(sideways));
  }
  bent = normalize(bent + 1e-3 * n);
  found = vec4(0.5 + 0.5 * bent.xy, on(kContact) ? open_nearby(p, n, shift) : 1.0, open / float(kSlices));
}
