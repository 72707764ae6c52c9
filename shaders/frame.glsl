// What is the same for everything in one picture. Mirrors systems/visual/frame.h.

layout(std140, binding = 0) uniform Frame {
  mat4 view_projection;
  mat4 inverse_view_projection;
  vec4 eye;             // [m] world
  vec4 key_place;       // xyz: [1] direction to the light (w = 0), or [m] its position (w = 1)
  vec4 key_color;       // [lx] (w = 0) or [cd] (w = 1); w: how much more than the range [m] it may reach, 0: any
  vec4 key_axis;        // xyz: [1] where a spot points; w: scale of the cone's falloff, 0: not a spot
  vec4 irradiance[9];   // [lx] polynomial of the normal's components, panorama frame
  vec4 surroundings;    // cosine and sine of the rotation about +Y, intensity, sharpest-to-roughest mip levels
  vec4 picture;         // exposure, offset of the spot's falloff, [1/m] height as colour (0: off), background's blur
};
