// Transforms of a node. LocalTransform is authored in the level; WorldTransform follows from the hierarchy.
#pragma once

#include "components/math.h"
#include "runtime/registry.h"

namespace pliant {

// Relative to the parent node. Rate: visual. Writer: content at spawn; the editor between ticks.
struct LocalTransform {
  vec3 translation{0};  // [m]
  quat rotation{1, 0, 0, 0};
  vec3 scale{1};  // [1]
};

// Node to world. Rate: touch, for moving nodes. Writer: content at spawn; move_objects, for drawables without a Pose.
struct WorldTransform {
  mat4 matrix{1};
};

// A rigid frame, in world. Touch systems use it for objects: scale and shear are baked into the mesh at spawn. Rate:
// touch. Writer: content at spawn; move_objects, for entities with a MovingPose.
struct Pose {
  dvec3 position{0};  // [m]
  dquat rotation{1, 0, 0, 0};
  dvec3 to_world(dvec3 p) const { return position + rotation * p; }
  dvec3 to_local(dvec3 p) const { return glm::conjugate(rotation) * (p - position); }
  mat4 matrix() const {
    mat4 m(glm::mat4_cast(quat(rotation)));
    m[3] = vec4(vec3(position), 1.0f);
    return m;
  }
};

// Motion of a kinematic object in the last tick: from `previous` to its Pose, which is the pose at the end of the tick.
// Only objects with prescribed motion have one (components/kinematic.h).
// Rate: touch. Writer: move_objects. Lives from spawn on.
struct MovingPose {
  Pose previous;              // world, at the beginning of the tick
  dvec3 velocity{0};          // [m/s] of the object frame's origin, world, mean over the tick
  dvec3 angular_velocity{0};  // [rad/s] world, mean over the tick
  double dt = 1e-3;           // [s] of that tick
};

// Pose of an object at the beginning of the tick: its previous pose, or the current one if it does not move.
inline Pose pose_before(const Registry& registry, Entity entity) {
  if (const MovingPose* moving = registry.find<MovingPose>(entity)) return moving->previous;
  return registry.get<Pose>(entity);
}

// Velocity of the material point of an object that is at `world_point` [m] now: its displacement in the tick over dt. A
// probe's velocity is computed in the same way, so a probe that rides along has zero relative velocity. (v + w x r
// agrees only to first order: it leaves w^2 r dt / 2.) Zero for fixed objects. Dents are excluded. [m/s] world
inline dvec3 surface_velocity(const Registry& registry, Entity entity, dvec3 world_point) {
  const MovingPose* moving = registry.find<MovingPose>(entity);
  if (!moving) return dvec3(0);
  return (world_point - moving->previous.to_world(registry.get<Pose>(entity).to_local(world_point))) / moving->dt;
}

}  // namespace pliant
