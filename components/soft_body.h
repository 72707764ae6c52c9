// The second system's authoring (P2): flesh, its rigid handle, and rigid bodies. Keys of PLIANT_soft_body,
// PLIANT_handle and PLIANT_rigid_body. Rate: soft (read). Writer: content at spawn.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "components/math.h"
#include "components/mesh.h"
#include "components/tet_mesh.h"

namespace pliant {

struct SoftBody {
  double young = 5e3;                    // [Pa]
  double poisson = 0.45;                 // [1]
  double density = 1000.0;               // [kg/m3]
  std::array<double, 2> rayleigh{0, 0};  // alpha [1/s], beta [s]
  double cell = 0.0;                     // [m] lattice cell; 0: sized from the bounds
  std::string mesh;                      // tetrahedra file, instead of `cell`
  Box pinned;                            // [m] object frame; empty: nothing (or the attribute _PINNED)
  double friction_static = 0.4;          // [1]
  double friction_sliding = 0.3;         // [1]

  Handle<TetMesh> tets;  // set at spawn
  Handle<Mesh> skin;     // set at spawn: the embedded surface, which collides and is drawn
};

enum class Attachment : std::uint8_t { kSpring, kSlave };

// How a tool's 1 kHz force is made, in rising order of truth and cost.
enum class ToolForce : std::uint8_t {
  kHeld,      // the last soft step's force, unchanged
  kLinear,    // LinearModel, as P2 has it
  kContacts,  // CondensedContacts, solved again every tick; kLinear when late
};

struct Handle6 {
  Box box;  // [m] object frame: what is rigid; empty: the attribute _HANDLE
  Attachment attachment = Attachment::kSlave;
  std::array<double, 2> translation{200.0, 2.0};  // [N/m], [N s/m]
  std::array<double, 2> rotation{0.5, 0.005};     // [N m/rad], [N m s/rad]
  double max_force = 3.3;                         // [N]
  double max_torque = 0.3;                        // [N m]
  bool carried = true;                            // the tool's weight is held up, and not felt
  ToolForce force = ToolForce::kContacts;         // how the touch clock makes its force
  std::string device;                             // node with PLIANT_haptic_device
};

struct RigidBody {
  double mass = 0.0;                                     // [kg] 0: from density
  double density = 1000.0;                               // [kg/m3]
  double friction_static = 0.4, friction_sliding = 0.3;  // [1]
  bool fixed = false;

  Handle<Mesh> skin;  // set at spawn
};

}  // namespace pliant
