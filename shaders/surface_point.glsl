// A point of a surface, between the two stages.

struct SurfacePoint {
  vec3 position;  // [m] world
  vec3 normal;
  vec4 tangent;
  vec2 uv;
  float height;   // [m]
};
