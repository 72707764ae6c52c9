// Tone mapping: exposure, then Narkowicz's fit of the ACES film curve (2015). Linear in and out; the framebuffer
// encodes sRGB.

vec3 tone_mapped(vec3 radiance) {
  if (on(kLinear)) return radiance;
  vec3 x = picture.x * radiance;
  return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}
