// Placement and number of an object.

layout(std140, binding = 1) uniform Placement {
  mat4 to_world;
  mat4 normal_to_world;  // inverse transpose
  uvec4 object;          // x: its number, counted from 1; y: 1 if its vertices are in the skin buffer (skin.glsl)
};
