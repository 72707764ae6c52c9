// Lines and dots in the world: grid, axes, normals, boxes.
layout(location = 0) in vec3 position;  // [m] world
layout(location = 1) in vec4 tint;      // encoded
layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform float nearer;  // [1] share of the depth, so that lines on a surface are not hidden by it

layout(location = 0) out vec4 line_tint;

void main() {
  line_tint = tint;
  gl_Position = clip_from_world * vec4(position, 1.0);
  gl_Position.z -= nearer * gl_Position.w;
}
