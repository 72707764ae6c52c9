// Constants of one picture. Mirrors systems/visual/frame.h.

struct Lamp {  // a punctual light
  vec4 place;  // xyz: [1] direction to the light (w = 0), or [m] its position (w = 1)
  vec4 color;  // [lx] (place.w = 0) or [cd] (place.w = 1); w: [m] its range, 0: unlimited
  vec4 axis;   // xyz: [1] direction of a spot; w: scale of the cone's falloff, 0: not a spot
  vec4 more;   // x: offset of the cone's falloff
};

layout(std140, binding = 0) uniform Frame {
  mat4 view_projection;
  mat4 inverse_view_projection;
  mat4 shadow_from_world;  // to the shadow map's texture coordinates and depth, [0, 1]
  vec4 eye;                // [m] world
  vec4 irradiance[9];      // [lx] polynomial of the normal's components, panorama frame
  vec4 surroundings;       // cosine and sine of the rotation about +Y, intensity, the roughest level
  vec4 picture;            // exposure, brightness of the background, [1/m] height as colour (0: off), background's blur
  vec4 shadow;             // [m] width of a shadow map's texel in the scene, [1] its share of the map
  mat4 view;               // from world
  vec4 lens;               // [1] tangents of half the field of view, across and up; z, w: distance = w / (ndc depth + z)
  vec4 ground;             // [m] x, height and z of its middle, world; its radius
  vec4 nearby;             // [m] how far ambient occlusion reaches, and contact shadows
  Lamp lamps[4];           // the first casts the shadow
  vec4 balls[16];          // [m] middle and radius: of probes, which keep surroundings from what is below them
  uvec4 modes;             // number of lamps, enabled modes, number of balls
};

const uint kReflection = 1u, kRefraction = 2u, kBump = 4u, kShadows = 8u, kZones = 16u, kBehind = 32u, kLinear = 64u;
const uint kOccluded = 128u, kContact = 256u, kGround = 512u, kSteady = 1024u;

bool on(uint mode) { return (modes.y & mode) != 0u; }
