// What a level's author says of surfaces, bodies, probes, tools and devices. Each struct is one extension of the level
// format: the keys are its members, with their units, ranges and defaults (docs/level-format.md, docs/reference.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pliant/math.h"

namespace pliant {

// Keys of PLIANT_simulation.
struct Simulation {
  double touch_rate = 1000.0;     // [Hz]
  double soft_step = 1.0 / 60.0;  // [s]
  dvec3 gravity{0, -9.81, 0};     // [m/s2]
};

// Values behind the last of SpringLaw, Shape and SolverKind are registered ones (surface_law.h, linear_solver.h).
enum class SpringLaw : std::uint8_t { kLinear, kCubic, kExponential, kStandardLinearSolid };
enum class Shape : std::uint8_t { kPunch, kHertz, kGaussian, kWendland, kVolume, kKelvinlet };
enum class Response : std::uint8_t { kFollow, kLag };     // methods.md 1.8
enum class Distance : std::uint8_t { kChord, kSurface };  // methods.md 1.3

// Which of the meshes that are only drawn go with what they lie in.
enum class Carries : std::uint8_t {
  kNothing,
  kInside,  // those that lie inside of it, or below its node
};

// A deformable surface: P1's local model, authored by what a person can feel. Keys of PLIANT_deformable.
struct DeformableParameters {
  SpringLaw spring = SpringLaw::kLinear;
  double stiffness = 300.0;               // [N/m] slope of the normal force against depth at depth 0
  double cubic = 3e6;                     // [N/m3] k3 of the cubic law
  double stiffening = 100.0;              // [1/m] alpha of the exponential law; < 0: it softens
  double relaxation_stiffness = 300.0;    // [N/m] the arm of the standard linear solid
  double relaxation_time = 0.5;           // [s] tau of that arm
  double damping_ratio = 1.0;             // [1] zeta of the free surface
  double settling_time = 0.05;            // [s] 2 % settling time of the free surface
  double contact_damping = 0.0;           // [N s/m] rate term of the probe's force
  bool contact_damping_material = false;  // take b of the local model instead, as P1 does
  Response response = Response::kFollow;
  Shape shape = Shape::kVolume;
  Distance distance = Distance::kChord;
  double reach = 0.0;             // [m] radius R of the field; 0: 0.08 of the object's diagonal
  double volume = 1.0;            // [1] chi: share of the volume that the shape `volume` conserves
  double contact_radius = 0.0;    // [m] a of the shapes punch, hertz, kelvinlet; 0: a fifth of the reach
  double friction_static = 0.4;   // [1] mu_s
  double friction_sliding = 0.3;  // [1] mu_d <= mu_s
  double crease_angle = 0.0;      // [rad] edges that turn by more are creases; 0: the file's normals, else 0.7
  double young = 0.0;             // [Pa] with thickness: calibrates stiffness instead of `stiffness`; 0: not given
  double poisson = 0.45;          // [1]
  double thickness = 0.0;         // [m] 0: deep
  double error = 0.0;             // [1] budget: what is not said of the model is chosen by it; 0: none
  Carries carries = Carries::kNothing;
};

// What solves a soft body's linear systems (P2: black boxes).
enum class SolverKind : std::uint8_t {
  kAuto,               // by size and by how many right-hand sides come, as measured
  kBlockCholesky,      // sparse 3x3 blocks
  kEigenCholesky,      // Eigen's SimplicialLDLT
  kCholmod,            // SuiteSparse's, where the build has it
  kConjugateGradient,  // preconditioned; for large bodies
  kDense,              // for tests
};

// What of a surface is filled with tissue.
enum class Fill : std::uint8_t {
  kSolid,  // what it encloses; of a thin wall (inner and outer sheet close to each other) its cavity, too
  kWall,   // only the wall: as it is, or a layer of `thickness` behind the surface
};

// What a soft body's mesh is to gravity, and how it begins.
enum class UnderGravity : std::uint8_t {
  kFalls,     // the shape without weight, in which it begins, and from which it falls
  kSettled,   // the same, but it begins where it rests on what is pinned
  kModelled,  // the shape under its weight, in which it begins and stays; the shape without weight is found
};

// Tissue: co-rotational FEM on tetrahedra (P2). Keys of PLIANT_soft_body.
struct SoftBodyParameters {
  double young = 5e3;                    // [Pa]
  double poisson = 0.45;                 // [1]
  double density = 1000.0;               // [kg/m3]
  std::array<double, 2> rayleigh{0, 0};  // alpha [1/s], beta [s]
  double cell = 0.0;                     // [m] lattice cell; 0: sized for some 2,000 tetrahedra
  Box focus;                             // [m] object frame: where cells are that large; they grow away from it
  Fill fill = Fill::kSolid;              // what the lattice fills
  double thickness = 0.0;                // [m] of a wall, inwards from the surface; 0: the wall as the surface has it
  std::string mesh;                      // tetrahedra file, instead of `cell`
  Box pinned;                            // [m] object frame; empty: nothing (or the attribute _PINNED)
  double friction_static = 0.4;          // [1]
  double friction_sliding = 0.3;         // [1]
  SolverKind solver = SolverKind::kAuto;
  double error = 0.0;  // [1] budget: what is not said of the model is chosen by it; 0: none
  UnderGravity under_gravity = UnderGravity::kFalls;
  Carries carries = Carries::kNothing;
};

enum class Attachment : std::uint8_t { kSpring, kSlave };

// How a tool's 1 kHz force is made, in rising order of truth and cost.
enum class ToolForce : std::uint8_t {
  kHeld,      // the last soft step's force, unchanged
  kLinear,    // LinearModel, as P2 has it
  kContacts,  // CondensedContacts, solved again every tick; kLinear when late
};

// What a person holds a body by: its rigid part, and the coupling between device and tool. Keys of PLIANT_handle.
struct HandleParameters {
  Box box;  // [m] object frame: what is rigid; empty: the attribute _HANDLE
  Attachment attachment = Attachment::kSlave;
  std::array<double, 2> translation{200.0, 2.0};  // [N/m], [N s/m]
  std::array<double, 2> rotation{0.5, 0.005};     // [N m/rad], [N m s/rad]
  double max_force = 3.3;                         // [N] saturation: max_force tanh(spring / max_force)
  double max_torque = 0.3;                        // [N m] the same
  bool carried = true;                            // the tool's weight is held up, and not felt
  ToolForce force = ToolForce::kContacts;         // how the touch clock makes its force
};

// Keys of PLIANT_rigid_body.
struct RigidBodyParameters {
  double mass = 0.0;                                     // [kg] 0: from density
  double density = 1000.0;                               // [kg/m3]
  double friction_static = 0.4, friction_sliding = 0.3;  // [1]
  bool fixed = false;
};

// What a probe meets. Yielding surfaces (Deformable) it meets where it is, by their own law. Among soft and rigid
// bodies it is a small rigid tool on a coupling (systems/soft/body/probe_tool.h).
enum class ProbeMeets : std::uint8_t { kAll, kSurfaces, kBodies };

// Keys of PLIANT_probe.
struct ProbeParameters {
  double radius = 0.0;       // [m] of every tip; 0: a point
  double length = 0.0;       // [m] of a capsule's axis, from the origin along +Y of the probe's frame; 0: none
  std::vector<vec3> points;  // [m] places of the tips, probe frame; empty: one at the origin, or the capsule's
  ProbeMeets meets = ProbeMeets::kAll;
  std::array<double, 2> coupling{1000.0, 5.0};  // [N/m, N s/m] between device and what meets bodies
  vec3 color{0.9f, 0.35f, 0.1f};                // linear RGB
};

// What may leave for the hand that holds the device. Keys of PLIANT_haptic_device.
struct DeviceParameters {
  double scale = 1.0;      // [1] a driver's workspace -> world
  double max_force = 3.3;  // [N] norm of the force sent
  // [N/m] per metre of the world: the force may not rise faster with displacement than this; 0: no limit. What a driver
  // says of itself (DeviceCapabilities) is per metre of its own workspace.
  double max_stiffness = 0.0;
  double max_slew = 1000.0;  // [N/s] of the norm of the change; force that is let go falls by 1000 N/s at least
};

// A path in time: script files and orbits. Linear between rows, slerp for rotation; holds the last row.
struct PathRow {
  double time = 0.0;  // [s] ascending
  dvec3 position{0};  // [m] world
  dquat rotation{1, 0, 0, 0};
};
struct Path {
  std::vector<PathRow> rows;
  bool turns = false;    // the rows say rotations too; else every rotation is the identity
  bool repeats = false;  // starts over after the last row (whose position equals the first's)
};

}  // namespace pliant
