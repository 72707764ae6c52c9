// The editor's view of a level: a mesh at its node, in its edited state.
layout(location = 0) in vec3 position;  // [m] mesh frame
layout(location = 1) in vec3 normal;    // [1] mesh frame
layout(location = 2) in float value;    // displayed painted value

layout(location = 0) uniform mat4 clip_from_world;
layout(location = 1) uniform mat4 world_from_mesh;
layout(location = 2) uniform mat3 normal_frame;

layout(location = 0) out vec3 world_position;  // [m]
layout(location = 1) out vec3 world_normal;
layout(location = 2) out float shown_value;

void main() {
  vec4 world = world_from_mesh * vec4(position, 1.0);
  world_position = world.xyz;
  world_normal = normal_frame * normal;
  shown_value = value;
  gl_Position = clip_from_world * world;
}
