// The finished picture for a target without sRGB encoding, where blits would convert to linear light (OpenGL ES).
layout(binding = 15) uniform sampler2D picture_map;

layout(location = 0) out vec4 color;

void main() {
  vec4 linear = texelFetch(picture_map, ivec2(gl_FragCoord.xy), 0);
  vec3 low = 12.92 * linear.rgb, high = 1.055 * pow(linear.rgb, vec3(1.0 / 2.4)) - 0.055;
  color = vec4(mix(high, low, vec3(lessThanEqual(linear.rgb, vec3(0.0031308)))), linear.a);
}
