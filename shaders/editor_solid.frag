// Light that falls from the camera's upper left: form is legible from everywhere, and nothing is black. Colours are
// encoded (sRGB) all along.
layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in float shown_value;

layout(location = 3) uniform vec3 base;        // the material's colour, encoded
layout(location = 4) uniform mat3 eye_frame;   // world -> eye
layout(location = 5) uniform int shows_value;  // 0: no; 1: a factor; 2: a share
layout(location = 6) uniform vec2 value_range;
layout(location = 7) uniform vec4 clip_plane;  // dot(xyz, position) > w is cut away; 0: nothing is
layout(location = 8) uniform uint number;      // of the node, for picking
layout(location = 9) uniform float flat_tint;  // > 0: lines, in one colour
layout(location = 10) uniform vec4 line_color;

layout(location = 0) out vec4 color;
layout(location = 1) out uint picked;

// Perceptually even colour ramp, dark to light, so that it is legible without the hue.
vec3 ramp(float t) {
  const vec3 c0 = vec3(0.2777, 0.0054, 0.3341), c1 = vec3(0.1051, 1.4046, 1.3846), c2 = vec3(-0.3309, 0.2148, 0.0951),
             c3 = vec3(-4.6342, -5.7991, -19.3324), c4 = vec3(6.2283, 14.1799, 56.6906),
             c5 = vec3(4.7764, -13.7451, -65.3530), c6 = vec3(-5.4355, 4.6459, 26.3124);
  return clamp(c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * (c5 + t * c6))))), 0.0, 1.0);
}

void main() {
  if (dot(clip_plane.xyz, clip_plane.xyz) > 0.0 && dot(clip_plane.xyz, world_position) > clip_plane.w) discard;
  picked = number;
  if (flat_tint > 0.0) {
    color = line_color;
    return;
  }
  vec3 n = normalize(eye_frame * world_normal);
  if (!gl_FrontFacing) n = -n;
  vec3 surface = base;
  if (shows_value != 0) {
    float t = shows_value == 1 ? (log2(max(shown_value, 1e-6)) - value_range.x) / (value_range.y - value_range.x)
                               : (shown_value - value_range.x) / (value_range.y - value_range.x);
    surface = ramp(clamp(t, 0.0, 1.0));
    // Contour lines, so that steps are visible without the hue. Offset from 0, 1 and the powers of two, which are
    // common on large areas.
    float lines = t * 10.0, slope = fwidth(lines), near_line = abs(fract(lines + 0.25) - 0.5) / max(slope, 1e-6);
    if (slope > 1e-4 && slope < 0.35) surface *= mix(0.72, 1.0, clamp(near_line, 0.0, 1.0));
  }
  if (!gl_FrontFacing) surface = mix(surface, vec3(0.45, 0.32, 0.42), 0.6);  // a visible inside is marked by its colour
  float key = max(dot(n, normalize(vec3(-0.4, 0.65, 0.65))), 0.0), fill = max(dot(n, normalize(vec3(0.7, -0.1, 0.4))), 0.0);
  float rim = pow(1.0 - max(n.z, 0.0), 3.0);
  color = vec4(surface * (0.36 + 0.58 * key + 0.16 * fill) + 0.10 * rim * vec3(0.8, 0.9, 1.0), 1.0);
}
