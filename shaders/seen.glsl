// Places of the pixels of the depth that nearby.cpp draws, in the picture's view.

layout(binding = 16) uniform sampler2D normal_seen_map;  // 0.5 + 0.5 n, view
layout(binding = 17) uniform sampler2D depth_seen_map;

ivec2 seen_size() { return textureSize(depth_seen_map, 0); }

float distance_at(ivec2 texel) {
  texel = clamp(texel, ivec2(0), seen_size() - 1);
  return lens.w / (2.0 * texelFetch(depth_seen_map, texel, 0).r - 1.0 + lens.z);
}

vec3 place_at(vec2 pixel) {
  ivec2 texel = ivec2(floor(pixel));
  float d = distance_at(texel);
  return vec3((2.0 * (vec2(texel) + 0.5) / vec2(seen_size()) - 1.0) * lens.xy * d, -d);
}

// 1 for a pixel of the surface through `p` with this normal.
float same_surface(vec3 p, vec3 n, ivec2 texel) {
  return clamp(2.0 - 20.0 * abs(dot(n, place_at(vec2(texel) + 0.5) - p)) / nearby.x, 0.0, 1.0);
}
