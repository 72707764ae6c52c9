// Where an object stands, and which one it is.

layout(std140, binding = 1) uniform Placement {
  mat4 to_world;
  mat4 normal_to_world;  // inverse transpose
  uvec4 object;          // x: its number, counted from 1; y: 1 if its vertices ride on a skin (skin.glsl)
};
