// Environment light: a cube map whose levels are filtered for increasing roughness (systems/visual/cube.h), and its
// irradiance as a quadratic polynomial (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance
// Environment Maps, SIGGRAPH 2001, equation 13).

layout(binding = 0) uniform samplerCube surroundings_map;

const float kPi = 3.14159265;

vec3 to_panorama(vec3 d) {
  return vec3(surroundings.x * d.x - surroundings.y * d.z, d.y, surroundings.y * d.x + surroundings.x * d.z);
}

// Radiance about world direction `d`, filtered for a coat of this roughness; roughness 0 is sharp.
vec3 radiance_from(vec3 d, float roughness) {
  return surroundings.z * textureLod(surroundings_map, to_panorama(d), roughness * surroundings.w).rgb;
}

// Irradiance on a surface that faces world direction `n`.
vec3 irradiance_on(vec3 n) {
  vec3 p = to_panorama(n);
  vec3 e = irradiance[0].rgb + irradiance[1].rgb * p.y + irradiance[2].rgb * p.z + irradiance[3].rgb * p.x +
           irradiance[4].rgb * p.x * p.y + irradiance[5].rgb * p.y * p.z +
           irradiance[6].rgb * (3.0 * p.z * p.z - 1.0) + irradiance[7].rgb * p.x * p.z +
           irradiance[8].rgb * (p.x * p.x - p.y * p.y);
  return surroundings.z * max(e, vec3(0.0));
}
