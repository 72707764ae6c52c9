// Where a node is. LocalTransform is what the level says, WorldTransform what follows from the hierarchy.
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

// Node to world. Rate: touch, of what moves. Writer: content at spawn; move_objects, for drawables without a Pose.
struct WorldTransform {
  mat4 matrix{1};
};

// A rigid frame, in world. What touch systems use for objects: scale and shear are baked into the mesh at spawn.
// Rate: touch. Writer: content at spawn; move_objects, for what has a MovingPose.
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

// How a kinematic object moved in the last tick: from `previous` to its Pose, which is where it is at the tick's end.
// Only what a prescribed motion carries has one (components/kinematic.h).
// Rate: touch. Writer: move_objects. Lives from spawn on.
struct MovingPose {
  Pose previous;              // world, at the tick's begin
  dvec3 velocity{0};          // [m/s] of the object frame's origin, world, mean over the tick
  dvec3 angular_velocity{0};  // [rad/s] world, mean over the tick
  double dt = 1e-3;           // [s] of that tick
};

// Where an object was at the tick's begin: its previous pose, or the current one of what stands still.
inline Pose pose_before(const Registry& registry, Entity entity) {
  if (const MovingPose* moving = registry.find<MovingPose>(entity)) return moving->previous;
  return registry.get<Pose>(entity);
}

// Velocity of the material point of an object that is at `world_point` [m] now, the mean over the tick: by how much it
// has come here, as a probe's velocity is taken, so that a probe that rides along has no velocity against it. (v + w x
// r agrees only to first order: it leaves w^2 r dt / 2.) Zero for what stands still. Dents are not in it. [m/s] world
inline dvec3 surface_velocity(const Registry& registry, Entity entity, dvec3 world_point) {
  const MovingPose* moving = registry.find<MovingPose>(entity);
  if (!moving) return dvec3(0);
  return (world_point - moving->previous.to_world(registry.get<Pose>(entity).to_local(world_point))) / moving->dt;
}

}  // namespace pliant
