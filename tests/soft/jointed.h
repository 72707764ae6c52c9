// Rigid bodies and joints between them.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "components/joint.h"
#include "systems/soft/body/rigid_state.h"
#include "tests/soft/box_pile.h"

namespace pliant::test {

inline constexpr double kG = 9.81;  // [m/s2]

struct Jointed {
  scenes::ToolStage stage;
  explicit Jointed(double step) : stage(step) { stage.world.simulation.gravity = dvec3(0, -kG, 0); }

  Entity box(dvec3 size, dvec3 at, dquat turned = kUpright) {
    return stage.add_rigid(scenes::box(size), RigidBody{}, Pose{at, turned});
  }
  void join(JointParameters parameters, Entity a, Entity b, dvec3 at, dquat turned = kUpright,
            Entity hand = kNoEntity) {
    Joint joint;
    static_cast<JointParameters&>(joint) = parameters;
    joint.body_a = a, joint.body_b = b, joint.hand = hand;
    const Entity entity = stage.world.registry.create();
    stage.world.registry.add<Pose>(entity, Pose{at, turned});
    stage.world.registry.add<Joint>(entity, joint);
  }
  RigidState& rigid(Entity entity) { return dynamic_cast<RigidState&>(stage.body(entity)); }
  Joints& joints() { return stage.soft().joints; }
  void run(double seconds) {
    if (!stage.world.soft) stage.prepare();
    const int steps = int(std::lround(seconds / stage.soft_step()));
    for (int i = 0; i < steps; ++i) stage.step();
  }
  double energy(const std::vector<Entity>& bodies) {
    double sum = 0.0;
    for (const Entity e : bodies) sum += rigid(e).kinetic_energy() + rigid(e).mass().mass * kG * rigid(e).centre().y;
    return sum;
  }
};

inline JointParameters of_kind(JointKind kind) {
  JointParameters out;
  out.kind = kind;
  return out;
}
// Turns +Y to +Z: a hinge in the picture's plane.
inline const dquat kAcross = glm::angleAxis(0.5 * std::numbers::pi, dvec3(1, 0, 0));

}  // namespace pliant::test
