// A stage (scenes.h) with soft and rigid bodies, and the soft clock beside the touch clock, in lockstep.
#pragma once

#include "components/soft_body.h"
#include "scenes/scenes.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/soft_state.h"

namespace pliant::scenes {

// The boundary of the tetrahedra as an outward-facing surface.
Primitive border(const TetMesh& tets);
// A closed box about `centre` with two triangles per face, as required for the ground under a body. [m]
Primitive box(dvec3 size, dvec3 centre = dvec3(0));

class ToolStage : public Stage {
 public:
  explicit ToolStage(double soft_step, double rate_hz = 1000.0);

  // The collision mesh is the boundary. With `handle` it is a tool with a separate unlimited device.
  Entity add_soft(TetMesh tets, SoftBody body, Pose pose, const Handle6* handle = nullptr);
  Entity add_rigid(const Primitive& primitive, RigidBody body, Pose pose, const Handle6* handle = nullptr);
  void prepare();

  void step();               // of the soft clock alone
  void run(double seconds);  // both clocks
  // Moves a tool's device along a straight line while both clocks run, calling `each` after every tick.
  void lead(Entity tool, dvec3 to, double seconds, const std::function<void()>& each = {});

  SoftState& soft() { return *world.soft; }
  Body& body(Entity entity);
  SoftBodyState& tissue(Entity entity) { return dynamic_cast<SoftBodyState&>(body(entity)); }
  HapticDevice& device_of(Entity tool) { return world.registry.get<HapticDevice>(tool); }
  double soft_step() const { return world.simulation.soft_step; }

  // [N] Sum of all contacts between two bodies in the last step, acting on `on`.
  dvec3 contact_force(Entity on, Entity other);
  double kinetic_energy();  // [J] of all soft bodies, tissue and handles
  double elastic_energy();  // [J]

 private:
  Schedule<World> soft_schedule_;
  std::uint64_t steps_ = 0;
};

}  // namespace pliant::scenes
