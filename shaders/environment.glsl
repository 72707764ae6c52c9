// Light from all around: a latitude-longitude panorama, and its irradiance as a quadratic polynomial (Ramamoorthi and
// Hanrahan, An Efficient Representation for Irradiance Environment Maps, SIGGRAPH 2001, equation 13).

layout(binding = 0) uniform sampler2D panorama;

const float kPi = 3.14159265;

vec3 to_panorama(vec3 d) {
  return vec3(surroundings.x * d.x - surroundings.y * d.z, d.y, surroundings.y * d.x + surroundings.x * d.z);
}

// The middle column of the panorama lies towards -Z.
vec2 panorama_place(vec3 d) {
  vec3 p = to_panorama(d);
  return vec2(0.5 + atan(p.x, -p.z) / (2.0 * kPi), acos(clamp(p.y, -1.0, 1.0)) / kPi);
}

// Radiance from world direction `d`, blurred: lod 0 is sharpest.
vec3 radiance_from(vec3 d, float lod) { return surroundings.z * textureLod(panorama, panorama_place(d), lod).rgb; }

// The same from one level, through a cubic B-spline instead of bilinear squares: four taps placed so that the card's
// own filter does the inner sums (Sigg and Hadwiger, GPU Gems 2, chapter 20).
vec3 smooth_radiance_from(vec3 d, int level) {
  vec2 size = vec2(textureSize(panorama, level));
  vec2 place = panorama_place(d) * size - 0.5, t = fract(place), cell = floor(place);
  vec2 w0 = (1.0 - t) * (1.0 - t) * (1.0 - t) / 6.0, w1 = (4.0 + 3.0 * t * t * (t - 2.0)) / 6.0;
  vec2 w3 = t * t * t / 6.0, low = w0 + w1, high = 1.0 - low;
  vec2 a = (cell - 0.5 + w1 / low) / size, b = (cell + 1.5 + w3 / high) / size;
  vec3 top = mix(textureLod(panorama, b, level).rgb, textureLod(panorama, vec2(a.x, b.y), level).rgb, low.x);
  vec3 bottom = mix(textureLod(panorama, vec2(b.x, a.y), level).rgb, textureLod(panorama, a, level).rgb, low.x);
  return surroundings.z * mix(top, bottom, low.y);
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
