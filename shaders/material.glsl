// Material constants. Mirrors systems/visual/material.cpp.

layout(std140, binding = 2) uniform MaterialOf {
  vec4 base_color;
  vec4 emissive;   // w: alpha cutoff
  vec4 numbers;    // metallic, roughness, scale of the normal map, strength of the occlusion map
  vec4 coat;       // x: 1 if alpha blends; y: clear coat; z: [m] height of white in the height map; w: coat's roughness
  vec4 volume;     // transmission, index of refraction, [m] thickness
  vec4 absorption; // [1/m]
  vec4 specular;   // rgb: reflectance at normal incidence of a dielectric; w: share of diffuse light that is not returned
  vec4 scatter;    // rgb: how far diffuse light wraps around the body; w: 1 if the tissue pales where it is pressed
  vec4 behind;     // rgb: share of the light on the far side that comes through
};

layout(binding = 1) uniform sampler2D base_color_map;

vec4 base_color_at(vec2 uv) { return base_color * texture(base_color_map, uv); }
