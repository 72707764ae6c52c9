// Relief finer than the mesh: a tangent-space normal map, or the slope of a height map. For the latter screen
// derivatives replace tangents (Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU, 2010).

layout(binding = 3) uniform sampler2D normal_map;
layout(binding = 6) uniform sampler2D height_map;  // r

vec3 normal_mapped(vec3 n, vec4 tangent, vec2 uv, float scale) {
  vec3 t = tangent.xyz - n * dot(n, tangent.xyz);
  if (dot(t, t) < 1e-12) return n;
  t = normalize(t);
  vec3 m = texture(normal_map, uv).xyz * 2.0 - 1.0;
  return normalize(scale * (m.x * t + m.y * tangent.w * cross(n, t)) + m.z * n);
}

// `height` [m]: of white above black.
vec3 height_mapped(vec3 n, vec3 position, vec2 uv, float height) {
  vec3 along_x = dFdx(position), along_y = dFdy(position);
  vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
  float h = texture(height_map, uv).r;
  float rise_x = height * (texture(height_map, uv + uv_x).r - h);
  float rise_y = height * (texture(height_map, uv + uv_y).r - h);
  vec3 across_x = cross(along_y, n), across_y = cross(n, along_x);
  float area = dot(along_x, across_x);
  vec3 slope = sign(area) * (rise_x * across_x + rise_y * across_y);
  return normalize(abs(area) * n - slope);
}

// A roughness that holds the spread of the normal within a pixel, so that highlights do not flicker (Tokuyoshi and
// Kaplanyan, Improved Geometric Specular Antialiasing, I3D 2019).
float steadied(float roughness, vec3 n) {
  vec3 along_x = dFdx(n), along_y = dFdy(n);
  if (!on(kSteady)) return roughness;
  float spread = min(0.5 * (dot(along_x, along_x) + dot(along_y, along_y)), 0.18), alpha = roughness * roughness;
  return sqrt(sqrt(min(alpha * alpha + spread, 1.0)));
}
