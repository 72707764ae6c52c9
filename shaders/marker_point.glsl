// A point of a marker, between the two stages.

struct MarkerPoint {
  vec3 position;  // [m] world
  vec3 normal;
  vec4 tint;      // linear RGB; w: roughness
};
