// The surroundings, out of focus.
#include "frame.glsl"
#include "environment.glsl"
#include "tone.glsl"

in vec3 direction;
layout(location = 0) out vec4 color;

// A binomial kernel of 5 x 5 directions, a texel of the blurred level apart, hides its bilinear squares.
void main() {
  vec3 d = normalize(direction);
  vec3 side = normalize(cross(d, abs(d.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0))), up = cross(side, d);
  const float kWeight[5] = float[](1.0, 4.0, 6.0, 4.0, 1.0);
  float step = kPi * exp2(picture.w - surroundings.w);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      sum += kWeight[i] * kWeight[j] * radiance_from(normalize(d + step * (float(i - 2) * side + float(j - 2) * up)),
                                                     picture.w);
  color = vec4(tone_mapped(sum / 256.0), 1.0);
}
