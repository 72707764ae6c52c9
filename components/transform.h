// Where a node is. LocalTransform is what the level says, WorldTransform what follows from the hierarchy.
#pragma once

#include "components/math.h"

namespace pliant {

// Relative to the parent node. Rate: visual. Writer: content at spawn; the editor between ticks.
struct LocalTransform {
  vec3 translation{0};  // [m]
  quat rotation{1, 0, 0, 0};
  vec3 scale{1};  // [1]
};

// Node to world. Rate: visual. Writer: update_transforms.
struct WorldTransform {
  mat4 matrix{1};
};

// A rigid frame, in world. What touch systems use for objects: scale and shear are baked into the mesh at spawn.
// Rate: touch. Writer: content at spawn (later: the soft clock, for what moves).
struct Pose {
  dvec3 position{0};  // [m]
  dquat rotation{1, 0, 0, 0};
  dvec3 to_world(dvec3 p) const { return position + rotation * p; }
  dvec3 to_local(dvec3 p) const { return glm::conjugate(rotation) * (p - position); }
};

}  // namespace pliant
