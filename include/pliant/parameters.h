// The authored parameters of surfaces, bodies, probes, tools and devices. Each struct is one extension of the level
// format; its members are the keys (docs/level-format.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pliant/math.h"

namespace pliant {

// Keys of PLIANT_simulation.
struct Simulation {
  double touch_rate = 1000.0;     // [Hz]
  double soft_step = 1.0 / 60.0;  // [s]
  dvec3 gravity{0, -9.81, 0};     // [m/s2]
};

// Values after the last of SpringLaw, Shape and SolverKind are those that have no enumerator, and registered ones
// (surface_law.h, linear_solver.h).
enum class SpringLaw : std::uint8_t {
  kLinear,
  kCubic,
  kExponential,
  kStandardLinearSolid,
  kTable,
  kQuasiLinearCubic,  // these three also relax (quasi-linear viscoelasticity)
  kQuasiLinearExponential,
  kQuasiLinearTable
};
enum class Shape : std::uint8_t { kPunch, kHertz, kGaussian, kWendland, kVolume, kKelvinlet };
enum class Response : std::uint8_t { kFollow, kLag };     // methods.md 1.8
enum class Distance : std::uint8_t { kChord, kSurface };  // methods.md 1.3

// The force of a sphere on tissue of known modulus (DeformableParameters::young).
enum class SphereForce : std::uint8_t {
  kHertz,    // of its osculating paraboloid; on a layer of `thickness`, too
  kSneddon,  // of the exact sphere on a half-space: 10 % less than Hertz's at a depth of one radius
};

// Force against depth, for the law `table`: a monotone cubic through the rows, linear beyond the last.
struct ForceTable {
  static constexpr std::size_t kMost = 16;
  std::size_t count = 0;                            // of rows, at least 2
  std::array<std::array<double, 2>, kMost> rows{};  // depth [m], ascending from 0; force [N], from 0, never falling
  bool operator==(const ForceTable&) const = default;
};

// Which meshes that are only drawn move with a deformable object.
enum class Carries : std::uint8_t {
  kNothing,
  kInside,  // those inside the object, or below its node
};

// A layer of a deformable surface that a probe breaks through (methods.md 1.14). The first one begins at the surface,
// every other one where the one above it ends. Below the last one is the surface's own law. An item of the key
// `layers`.
struct Layer {
  std::string name;
  double thickness = 0.002;  // [m]
  double stiffness = 300.0;  // [N/m] small-depth slope of its force against the depth below its top
  double force = 0.0;        // [N] its force at which it breaks; 0: not by force
  double energy = 0.0;       // [J] stored in it at which it breaks; 0: not by energy
  double remains = 0.0;      // [1] share of its force that stays where it is broken
  double grip = 0.0;         // [N/m] friction of a probe in its hole, per length inside
  bool operator==(const Layer&) const = default;
};

// The layers of a surface, from the surface down. Copies share them, so that a tick copies parameters without
// allocating.
class Layers {
 public:
  Layers() = default;
  Layers(std::vector<Layer> layers)
      : layers_(layers.empty() ? nullptr : std::make_shared<const std::vector<Layer>>(std::move(layers))) {}
  Layers(std::initializer_list<Layer> layers) : Layers(std::vector<Layer>(layers)) {}
  bool empty() const { return !layers_; }
  std::size_t size() const { return layers_ ? layers_->size() : 0; }
  const Layer& operator[](std::size_t i) const { return (*layers_)[i]; }
  const Layer* begin() const { return layers_ ? layers_->data() : nullptr; }
  const Layer* end() const { return begin() + size(); }

 private:
  std::shared_ptr<const std::vector<Layer>> layers_;
};

// A deformable surface: P1's local model, specified by properties that can be felt. Keys of PLIANT_deformable.
struct DeformableParameters {
  SpringLaw spring = SpringLaw::kLinear;
  double stiffness = 300.0;               // [N/m] slope of the normal force against depth at depth 0
  double cubic = 3e6;                     // [N/m3] k3 of the cubic law
  double stiffening = 100.0;              // [1/m] alpha of the exponential law; < 0: softening
  ForceTable table;                       // of the law `table`; its slope at 0 replaces `stiffness`
  double relaxation_stiffness = 300.0;    // [N/m] small-depth slope of a relaxing law's arm
  double relaxation_time = 0.5;           // [s] tau of that arm
  double damping_ratio = 1.0;             // [1] zeta of the free surface
  double settling_time = 0.05;            // [s] 2 % settling time of the free surface
  double contact_damping = 0.0;           // [N s/m] rate term of the probe's force
  bool contact_damping_material = false;  // use b of the local model instead, as in P1
  Response response = Response::kFollow;
  Shape shape = Shape::kVolume;
  Distance distance = Distance::kChord;
  double reach = 0.0;                  // [m] radius R of the field; 0: 0.08 of the object's diagonal
  double volume = 1.0;                 // [1] chi: share of the volume that the shape `volume` conserves
  double contact_radius = 0.0;         // [m] a of the shapes punch, hertz, kelvinlet; 0: a fifth of the reach
  double friction_static = 0.4;        // [1] mu_s
  double friction_sliding = 0.3;       // [1] mu_d <= mu_s
  double friction_stribeck = 0.0;      // [m/s] v_s: speed over which friction falls from static to sliding; 0: at once
  double friction_viscous = 0.0;       // [s/m] rise of the coefficient of sliding friction with speed
  double texture_amplitude = 0.0;      // [m] root mean square of the roughness felt; 0: smooth
  double texture_wavelength = 1e-3;    // [m] of its waves
  double texture_seed = 1.0;           // [1] another number: another roughness of the same kind
  double transient_amplitude = 0.0;    // [N s/m] a knock's force per speed of the impact; 0: none
  double transient_frequency = 200.0;  // [Hz]
  double transient_decay = 80.0;       // [1/s]
  double relief = 0.0;                 // [1] share of the drawn relief that is felt: 1 as drawn, 0 none
  double crease_angle = 0.0;           // [rad] edges with a larger angle are creases; 0: the file's normals, else 0.7
  double young = 0.0;                  // [Pa] with thickness: calibrates the stiffness, replaces `stiffness`; 0: unset
  double poisson = 0.45;               // [1]
  double thickness = 0.0;              // [m] 0: half-space
  SphereForce sphere = SphereForce::kHertz;  // with `young`
  double error = 0.0;                        // [1] error budget from which unset model parameters are chosen; 0: none
  Carries carries = Carries::kNothing;
  Layers layers;
  double hole_radius = 0.002;    // [m] of the hole that a probe leaves in a layer, at least the probe's
  double yield_force = 0.0;      // [N] above which the dent stays; 0: never
  double yield_hardening = 0.0;  // [N/m] rise of that force with the depth that stays
};

// The solver of a soft body's linear systems (P2: black boxes).
enum class SolverKind : std::uint8_t {
  kAuto,               // chosen by size and number of right-hand sides, from measurements
  kBlockCholesky,      // sparse 3x3 blocks
  kEigenCholesky,      // Eigen's SimplicialLDLT
  kCholmod,            // SuiteSparse's, if compiled in
  kConjugateGradient,  // preconditioned; for large bodies
  kDense,              // for tests
};

// The region of a surface that is filled with tissue.
enum class Fill : std::uint8_t {
  kSolid,  // its interior; for a thin wall (inner and outer sheet close together) its cavity, too
  kWall,   // only the wall: as modelled, or a layer of `thickness` behind the surface
};

// How a soft body's mesh relates to gravity, and its initial state.
enum class UnderGravity : std::uint8_t {
  kFalls,     // the mesh is the weightless shape and the initial state; the body then falls
  kSettled,   // the mesh is the weightless shape; the body starts in equilibrium on its pins
  kModelled,  // the mesh is the equilibrium under gravity and the initial state; the weightless shape is computed
};

// How tissue bears a contact.
enum class SoftContact : std::uint8_t {
  kLattice,  // the lattice's nodes beside it: too stiff where it is small against the cells
  kSplit,    // the lattice with its force smeared, and in series an analytic dent (systems/soft/local)
  kAuto,     // kSplit where it is proved, else kLattice (content/level/soft_contact.h)
};

// The elastic law of tissue. All have the same slope at rest; methods.md 2.11.
enum class TissueLaw : std::uint8_t {
  kCorotational,  // linear in the strain: cheap; too soft when squashed, too stiff when pulled or sheared
  kNeoHookean,    // stable Neo-Hookean: large strain
  kFung,          // exponential: stiffens with strain
};

// How tissue moves over a step.
enum class StepMethod : std::uint8_t {
  kEuler,        // implicit Euler: first order, damps all motion
  kSecondOrder,  // two stages of one matrix (systems/soft/body/two_stages.h)
  kQuasiStatic,  // the equilibrium of every step: no inertia
};

// Elements of a lattice.
enum class Elements : std::uint8_t {
  kTetrahedra,  // fitted to the surface
  kHexahedra,   // whole cells, weighted by their part inside the surface (content/tets/lattice_cells.h)
};

// A part of the tissue with a material of its own: a physical group of the tetrahedra file, or what a mesh inside
// encloses.
struct TissuePart {
  std::string name;         // of the group, or of the node with the mesh
  double young = 0.0;       // [Pa] 0: the body's
  double density = 0.0;     // [kg/m3] 0: the body's
  double damping = 1.0;     // [1] factor on rayleigh's beta
  double relaxation = 1.0;  // [1] factor on the shares of `prony`; 0: it does not relax
  bool operator==(const TissuePart&) const = default;
};

// Relaxation of tissue: after a step of strain its stress is
//   1 - sum_i share_i (1 - e^(-t / time_i))
// of that at once (a Prony series relative to the modulus at once).
struct Prony {
  static constexpr std::size_t kMost = 3;
  struct Arm {
    double share = 0.3;  // [1] of the stress at once, which relaxes
    double time = 0.5;   // [s]
    bool operator==(const Arm&) const = default;
  };
  std::size_t count = 0;
  std::array<Arm, kMost> arms{};
  double remains() const {  // [1] of the stress at once, that stays
    double left = 1.0;
    for (std::size_t i = 0; i < count; ++i) left -= arms[i].share;
    return left;
  }
  bool operator==(const Prony&) const = default;
};

// A closed hollow in tissue, filled with gas or liquid. Its pressure is `pressure` + `bulk` (1 - volume / that at
// rest).
struct Cavity {
  std::string name;       // of a node whose closed mesh encloses the hollow; "": every hollow of the tissue
  double pressure = 0.0;  // [Pa] over that outside
  double bulk = 0.0;      // [Pa] large: its volume stays
  bool operator==(const Cavity&) const = default;
};

// A rigid part of a soft body besides its handle: a bone. Tissue, contacts and joints move it.
struct RigidPart {
  std::string name;  // for joints
  DBox box;          // [m] object frame
  bool operator==(const RigidPart&) const = default;
};

// Fibres in tissue, along one direction: a stress young (stretch - rest) along them, besides that of the law.
struct Fibres {
  double young = 0.0;         // [Pa] 0: none
  dvec3 direction{1, 0, 0};   // object frame, of any length
  bool only_tension = false;  // they do not resist shortening
  double contraction = 0.0;   // [1] rest = 1 - contraction
  double period = 0.0;        // [s] of a contraction that comes and goes as (1 - cos) / 2; 0: it is constant
  bool operator==(const Fibres&) const = default;
};

// Tissue: co-rotational FEM on tetrahedra or hexahedra (P2). Keys of PLIANT_soft_body.
struct SoftBodyParameters {
  TissueLaw law = TissueLaw::kCorotational;
  double young = 5e3;                    // [Pa] at small strain
  double poisson = 0.45;                 // [1] at small strain
  double stiffening = 1.0;               // [1] exponent of the law `fung`
  double density = 1000.0;               // [kg/m3]
  std::array<double, 2> rayleigh{0, 0};  // alpha [1/s], beta [s]
  Prony prony;                           // none: elastic
  Fibres fibres;
  std::vector<Cavity> cavities;
  std::vector<RigidPart> rigid;
  double cell = 0.0;  // [m] lattice cell; 0: sized for some 2,000 tetrahedra
  Elements elements = Elements::kTetrahedra;
  std::vector<TissuePart> materials;  // of parts of the tissue; a later one counts where two overlap
  Box focus;                          // [m] object frame: cells have this size here and grow away from it
  Fill fill = Fill::kSolid;           // what the lattice fills
  double thickness = 0.0;             // [m] of a wall, inwards from the surface; 0: as modelled
  std::string mesh;                   // tetrahedra file, instead of `cell`
  Box pinned;                         // [m] object frame; empty: none (or the attribute _PINNED)
  double friction_static = 0.4;       // [1]
  double friction_sliding = 0.3;      // [1]
  SolverKind solver = SolverKind::kAuto;
  double error = 0.0;  // [1] error budget from which unset model parameters are chosen; 0: none
  UnderGravity under_gravity = UnderGravity::kFalls;
  Carries carries = Carries::kNothing;
  SoftContact contact = SoftContact::kAuto;
  StepMethod integrator = StepMethod::kEuler;
  dvec3 velocity{0, 0, 0};  // [m/s] world, at the beginning; not of a tool
};

enum class Attachment : std::uint8_t { kSpring, kSlave };

// How a tool's 1 kHz force is computed, in order of increasing accuracy and cost.
enum class ToolForce : std::uint8_t {
  kHeld,      // zero-order hold of the last soft step's force
  kLinear,    // LinearModel, as in P2
  kContacts,  // CondensedContacts, solved every tick; kLinear when late
};

// The handle of a body: its rigid part, and the virtual coupling between device and tool. Keys of PLIANT_handle.
struct HandleParameters {
  Box box;  // [m] object frame: the rigid region; empty: the attribute _HANDLE
  Attachment attachment = Attachment::kSlave;
  std::array<double, 2> translation{200.0, 2.0};  // [N/m], [N s/m]
  std::array<double, 2> rotation{0.5, 0.005};     // [N m/rad], [N m s/rad]
  double max_force = 3.3;                         // [N] saturation: max_force tanh(spring / max_force)
  double max_torque = 0.3;                        // [N m] the same
  bool carried = true;                            // the tool's weight is compensated, and not felt
  ToolForce force = ToolForce::kContacts;         // how the touch clock computes its force
};

// Keys of PLIANT_rigid_body.
struct RigidBodyParameters {
  double mass = 0.0;                                     // [kg] 0: from density
  double density = 1000.0;                               // [kg/m3]
  double friction_static = 0.4, friction_sliding = 0.3;  // [1]
  bool fixed = false;
  dvec3 velocity{0, 0, 0};  // [m/s] world, at the beginning; not of a tool
};

// Objects that a probe touches. A Deformable is touched at its actual position, by its own law. For soft and rigid
// bodies, the probe is a small rigid tool on a virtual coupling (systems/soft/body/probe_tool.h).
enum class ProbeMeets : std::uint8_t { kAll, kSurfaces, kBodies };

// Keys of PLIANT_probe.
struct ProbeParameters {
  double radius = 0.0;       // [m] of every tip; 0: a point
  double length = 0.0;       // [m] length of a capsule's axis, from the origin along +Y of the probe's frame; 0: none
  std::vector<vec3> points;  // [m] positions of the tips, probe frame; empty: one at the origin, or the capsule's
  ProbeMeets meets = ProbeMeets::kAll;
  std::array<double, 2> coupling{1000.0, 5.0};  // [N/m, N s/m] between device and the tool that touches bodies
  vec3 color{0.9f, 0.35f, 0.1f};                // linear RGB
};

// Force limits for the device. Keys of PLIANT_haptic_device.
struct DeviceParameters {
  double scale = 1.0;      // [1] device workspace -> world
  double max_force = 3.3;  // [N] norm of the rendered force
  // [N/m] per metre of the world: largest rise of force with displacement; 0: no limit. The driver's value
  // (DeviceCapabilities) is per metre of its own workspace.
  double max_stiffness = 0.0;
  double max_slew = 1000.0;  // [N/s] of the norm of the change; released force falls by at least 1000 N/s
};

// Effect on a probe, without a surface (methods.md 1.13).
enum class EffectKind : std::uint8_t {
  kViscosity,   // drag
  kGravity,     // constant force
  kAttraction,  // magnet
  kGuidance,    // rail
  kForbidden,   // wall
  kDetents,     // rests along or around an axis
};

enum class EffectRegion : std::uint8_t {
  kEverywhere,
  kSphere,     // of `radius` around the node
  kBox,        // `box`, in the node's frame
  kHalfSpace,  // below the plane through the node, whose normal is the node's +Y
};

enum class EffectTarget : std::uint8_t {
  kPoint,    // the node
  kSegment,  // of `length`, from the node along its +Y
  kPlane,    // the node's XZ plane, of `size` around the node
};

enum class DetentAxis : std::uint8_t { kAlong, kAround };  // the node's +Y

// Acts on probes in space. All in its own frame, whose scale does not count. Keys of PLIANT_effect.
struct EffectParameters {
  EffectKind kind = EffectKind::kAttraction;
  EffectRegion region = EffectRegion::kSphere;
  double radius = 0.05;                        // [m] of the sphere
  DBox box;                                    // [m] of the box
  double edge = 0.01;                          // [m] inside of the region's border, in which the effect comes in
  double damping = 2.0;                        // [N s/m] viscosity
  dvec3 force{0, -1, 0};                       // [N] gravity
  EffectTarget target = EffectTarget::kPoint;  // attraction
  double length = 0.1;                         // [m] of the segment
  std::array<double, 2> size{0, 0};            // [m] of the plane along X and Z; 0: without end
  double stiffness = 200.0;                    // [N/m] attraction, guidance: at the target; forbidden: of the penalty
  double range = 0.02;                         // [m] attraction, guidance: no force beyond
  std::string path;                            // guidance: CSV of points, in the node's frame, relative to the level
  DetentAxis detents = DetentAxis::kAlong;
  double spacing = 0.01;            // [m] of detents along the axis
  double count = 12.0;              // [1] of detents around the axis, per turn; a whole number
  double peak = 0.5;                // [N] largest force along the detents
  std::vector<std::string> probes;  // names of those that feel it; empty: all
};

enum class JointKind : std::uint8_t {
  kFixed,   // holds position and direction
  kBall,    // holds a point
  kHinge,   // turns about the node's +Y alone
  kSlider,  // slides along the node's +Y alone
  kRope,    // pulls alone: the ends are at most `length` apart
};

inline constexpr const char* kHandlePart = "handle";  // JointParameters::part_a of a tool's handle

// Connects two soft or rigid bodies, or a body and the world, at the node's frame. Keys of PLIANT_joint.
struct JointParameters {
  JointKind kind = JointKind::kBall;
  std::string a, b;                    // names of the bodies; b empty: the world
  std::string part_a, part_b;          // rigid parts of soft bodies a, b; "handle": the handle; empty: the tissue
  std::array<double, 2> limits{0, 0};  // [rad] of a hinge, [m] of a slider, from where it begins; equal: none
  double stiffness = 0.0;  // hinge [N m/rad], slider [N/m]: of a spring to `rest`; rope [N/m]: 0, it does not stretch
  double damping = 0.0;    // [N m s/rad], [N s/m] of that spring
  double rest = 0.0;       // [rad], [m] from where it begins
  double closed = 0.0;     // [rad], [m] the same, at a closed grip
  std::string grip;        // name of a tool or probe: its device's grip moves that spring's rest to `closed`
  double max_force = 0.0;  // [N m], [N] bound of that spring; 0: none
  dvec3 end{0, -0.1, 0};   // [m] node's frame: where a rope is tied to b; to a at the node
  double length = 0.0;     // [m] of a rope; 0: the distance at the beginning
  double strength = 0.0;   // [N] a larger force breaks the joint; 0: none does
};

// A path in time: script files and orbits. Linear between rows, slerp for rotation; stays at the last row.
struct PathRow {
  double time = 0.0;  // [s] ascending
  dvec3 position{0};  // [m] world
  dquat rotation{1, 0, 0, 0};
  double grip = 0.0;  // [1] 0: open, 1: closed
};
struct Path {
  std::vector<PathRow> rows;
  bool turns = false;    // the rows contain rotations; else every rotation is the identity
  bool repeats = false;  // restarts after the last row (whose position equals the first's)
  bool grips = false;    // the rows contain grips; else the grip is unknown
};

}  // namespace pliant
