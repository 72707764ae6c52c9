// The shaders of draw.js. Light: a sky with soft boxes, a wet coat over tissue, the colours of glTF's
// metallic-roughness.
export const kStreamWidth = 1024; // [texels] of the stream's texture

export const kVertex = `#version 300 es
layout(location = 0) in vec3 P0;
layout(location = 1) in vec3 N0;
layout(location = 2) in vec3 shading;
layout(location = 3) in vec2 uv;
layout(location = 4) in uint streamVertex;
uniform highp sampler2D stream;
uniform bool streamed;
uniform mat4 toWorld, viewProjection;
out vec3 position, normal;
out vec2 at;
out float height;
void main() {
  int i = int(streamVertex);
  vec4 s = streamed ? texelFetch(stream, ivec2(i % ${kStreamWidth}, i / ${kStreamWidth}), 0) : vec4(0.0);
  vec4 world = toWorld * vec4(P0 + s.w * N0, 1.0);  // P1's two lines
  normal = mat3(toWorld) * (shading + s.xyz);
  position = world.xyz;
  at = uv;
  height = s.w;
  gl_Position = viewProjection * world;
}`;

export const kFragment = `#version 300 es
precision highp float;
in vec3 position, normal;
in vec2 at;
in float height;
uniform vec3 eye, color, scatter;
uniform vec4 gloss;  // roughness, metallic, wet coat, opacity
uniform float sky, reach;
uniform bool hasColor, hasRelief;
uniform sampler2D colorMap, reliefMap;
out vec4 pixel;

float lobe(vec3 d, vec3 to, float r) {  // a round lamp, blurred by the roughness
  float k = 2.0 / (0.012 + 2.0 * r * r);
  return exp(k * (dot(d, to) - 1.0)) * min(k, 30.0) * 0.12;
}
float panel(vec3 d, float r) {  // a window above, in front
  vec2 p = d.xz / max(d.y, 0.05) - vec2(-0.35, 0.75);
  float soft = 0.04 + r;
  vec2 inside = smoothstep(vec2(0.42, 0.26) + soft, vec2(0.42, 0.26) - min(soft, 0.2), abs(p));
  return d.y > 0.0 ? inside.x * inside.y : 0.0;
}
vec3 surroundings(vec3 d, float r) {
  vec3 c = mix(vec3(0.13, 0.10, 0.10), vec3(0.40, 0.44, 0.52), smoothstep(-0.6 - r, 0.7 + r, d.y)) * sky;
  c += vec3(1.0, 0.93, 0.84) * (1.1 * lobe(d, normalize(vec3(0.7, 0.6, 0.5)), r) + 3.2 * panel(d, r) * (1.0 - 0.93 * sqrt(r)));
  return c + vec3(0.45, 0.6, 1.0) * 0.7 * lobe(d, normalize(vec3(-0.8, 0.25, -0.5)), r);
}
vec3 relief(vec3 n) {  // the normal map, in the frame of the picture's derivatives
  vec3 px = dFdx(position), py = dFdy(position);
  vec2 ux = dFdx(at), uy = dFdy(at);
  vec3 a = cross(py, n), b = cross(n, px);
  vec3 t = a * ux.x + b * uy.x, w = a * ux.y + b * uy.y;
  float size = inversesqrt(max(max(dot(t, t), dot(w, w)), 1e-20));
  vec3 m = texture(reliefMap, at).xyz * 2.0 - 1.0;
  return normalize(mat3(t * size, w * size, n) * m);
}
float fresnel(float c, float f0) { return f0 + (1.0 - f0) * pow(1.0 - c, 5.0); }
void main() {
  vec3 v = normalize(eye - position), smooth_n = normalize(gl_FrontFacing ? normal : -normal);
  vec3 n = hasRelief ? relief(smooth_n) : smooth_n;
  vec3 base = color * (hasColor ? texture(colorMap, at).rgb : vec3(1.0));
  float dent = reach > 0.0 ? clamp(-height / (0.35 * reach), 0.0, 1.0) : 0.0;
  base *= mix(vec3(1.0), vec3(0.80, 0.62, 0.60), dent);  // pressed tissue
  float shade = 1.0 - 0.35 * dent;
  vec3 light = surroundings(n, 1.0), wrapped = surroundings(normalize(n + 0.5 * v), 1.0);
  vec3 diffuse = base * (1.0 - gloss.y) * mix(light, wrapped, scatter) * shade;
  float c = max(dot(n, v), 0.0);
  vec3 f0 = mix(vec3(0.04), base, gloss.y);
  vec3 mirrored = f0 + (max(vec3(1.0 - gloss.x), f0) - f0) * pow(1.0 - c, 5.0);
  vec3 radiance = diffuse + mirrored * surroundings(reflect(-v, n), gloss.x) * shade;
  vec3 film = normalize(mix(smooth_n, n, 0.25));
  float coat = gloss.z * fresnel(max(dot(film, v), 0.0), 0.04);
  radiance = mix(radiance, surroundings(reflect(-v, film), 0.06), coat);
  float opacity = max(gloss.w, coat + pow(1.0 - c, 2.5) * (1.0 - gloss.w));
  vec3 x = 0.95 * radiance;
  x = clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  pixel = vec4(pow(x, vec3(1.0 / 2.2)) * opacity, opacity);
}`;
