// The surroundings, behind all objects. Their floor is solid below the scene: as bright as they are, but bodies on it
// keep light from it.
#include "frame.glsl"
#include "environment.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "balls.glsl"
#include "tone.glsl"

in vec3 direction;
layout(location = 0) out vec4 color;

// Light on the ground at `p`, of that on bare ground; the floor's own colour is of both lights.
float left_on_ground(vec3 p) {
  const vec3 kUp = vec3(0.0, 1.0, 0.0);
  vec3 l, lamp = arriving_from(lamps[0], p, l);
  lamp *= max(l.y, 0.0);
  Nearby near = nearby_at(p, kUp);
  float open = min(min(near.lit, open_past_balls(p)), open_to_lamp_behind(p));
  vec3 rest = vec3(0.0);
  for (uint i = 1u; i < modes.x; ++i) {
    vec3 arriving = arriving_from(lamps[i], p, l);
    rest += arriving * max(l.y, 0.0);
  }
  vec3 sky = irradiance_on(kUp), all = lamp + rest + sky;
  vec3 left = open * lamp + rest + near.open * open_to_balls(p, kUp) * sky;
  const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
  return dot(left, kLuminance) / max(dot(all, kLuminance), 1e-9);
}

void main() {
  vec3 seen = radiance_from(normalize(direction), picture.w);
  float below = eye.y - ground.y;
  if (on(kGround) && below > 0.0 && direction.y < 0.0) {
    vec3 p = eye.xyz - below / direction.y * direction;
    float away = length(p.xz - ground.xz) / ground.w;
    if (away < 1.0) seen *= mix(left_on_ground(p), 1.0, smoothstep(0.6, 1.0, away));
  }
  color = vec4(tone_mapped(picture.y * seen), 1.0);
}
