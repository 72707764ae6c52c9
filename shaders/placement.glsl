// Where an object stands.

layout(std140, binding = 1) uniform Placement {
  mat4 to_world;
  mat4 normal_to_world;  // inverse transpose
};
