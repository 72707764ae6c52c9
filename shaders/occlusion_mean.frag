// Mean of what occlusion.frag found in 4 x 4 pixels, those of the same surface.
#include "frame.glsl"
#include "seen.glsl"

layout(binding = 18) uniform sampler2D found_map;

layout(location = 0) out vec4 mean;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  mean = vec4(0.5, 0.5, 1.0, 1.0);
  if (texelFetch(depth_seen_map, texel, 0).r >= 1.0) return;
  vec3 p = place_at(gl_FragCoord.xy), n = normalize(2.0 * texelFetch(normal_seen_map, texel, 0).xyz - 1.0);
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      ivec2 other = clamp(texel + ivec2(x, y), ivec2(0), seen_size() - 1);
      float weight = same_surface(p, n, other) + 1e-6;
      sum += weight * texelFetch(found_map, other, 0);
      weights += weight;
    }
  mean = sum / weights;
}
