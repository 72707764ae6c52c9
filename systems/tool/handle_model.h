// Data exchanged between the soft clock and the touch clock about a tool (methods.md 2.6-2.9), both ways by
// TripleBuffer (tool_touch_state.h). Everything has a fixed capacity, so that filling and copying allocate nothing.
//
// A twist or wrench is six numbers: linear first, then angular, world axes, about the handle's centre (handle.h).
// d: displacement of the handle since the model's pose; w: its twist; w0: the model's; w': its rate.
//
// Two descriptions of the wrench of tissue and contacts on the handle:
// - LinearModel, as in P2: F = force - K d - B (w - w0) - M w'. One step's matrix C = M + T B + T^2 K is split by the
//   shape in which the step moves all that follows the handle. M, B and K are projections on that shape, so each of
//   them is passive.
//   Contacts without compliance have none (reduce/stiff_contacts.h): with them, the other description is used.
// - CondensedContacts, beyond P2: tissue and objects as a few vibration modes, the rest of their flexibility without
//   inertia, and the contacts between them. The touch tick solves Signorini and Coulomb again with them.
#pragma once

#include <array>
#include <vector>

#include "components/haptic_device.h"
#include "components/probe.h"
#include "systems/soft/body/handle.h"

namespace pliant {

inline constexpr int kMaxCondensed = 64;  // contacts that the touch tick solves again
inline constexpr int kMaxModes = 128;     // of tissue and objects together

using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

struct LinearModel {
  Vector6 force = Vector6::Zero();      // [N], [N m] at d = 0, w = w0, w' = 0
  Matrix6 stiffness = Matrix6::Zero();  // K [N/m ...] symmetric, eigenvalues >= 0; so are the other two
  Matrix6 damping = Matrix6::Zero();    // B [N s/m ...]
  Matrix6 mass = Matrix6::Zero();       // M [kg ...] of tissue and of the bodies that stick to it
};

// Tissue moves as Phi w + modes q'. Phi is the shape of one soft step per unit of w. Each mode belongs to one body (the
// tissue with the handle pinned, or an object) and has mass 1: q'' + damping q' + frequency2 q = load + from_modes^T f
// + coupling to the handle. q = 0 and d = 0 at the model's time. Rows of a contact: normal, first tangent, second
// tangent. All arrays have capacity beyond `count` and `modes`; only the leading parts are valid.
struct CondensedContacts {
  int count = 0;  // contacts
  int modes = 0;
  Vector6 tissue_force = Vector6::Zero();  // [N], [N m] on the handle at q = 0, d = 0: elasticity and weight alone
  Matrix6 tissue_mass = Matrix6::Zero();   // of Phi
  Matrix6 tissue_damping = Matrix6::Zero();
  Matrix6 tissue_stiffness = Matrix6::Zero();

  Vector frequency2;  // [1/s2]
  Vector damping;     // [1/s]
  Vector rate;        // q' at the model's time
  Vector load;        // of elasticity and weight at q = 0, d = 0
  Rows6 modal_mass;   // modes x 6: between mode and handle; zero for modes of objects
  Rows6 modal_damping, modal_stiffness;

  Rows6 from_handle;                         // 3 count x 6: contact velocity per w, modes fixed
  Rows from_modes;                           // 3 count x modes: contact velocity per q'
  std::array<Rows6, 2> from_handle_by_slip;  // [1/m] their derivatives by slip along either tangent: a sliding
  std::array<Rows, 2> from_modes_by_slip;    // contact acts at another point (contact_geometry.h: find_turning)
  Eigen::MatrixXd flexibility;               // [m/N] 3 count x 3 count: residual flexibility, without inertia
  double flexibility_lag = 0.0;              // [s] its damping: stretch + lag stretch' = flexibility f
  Vector force;                              // [N] 3 count, at the model's time
  Vector drift;                              // [m/s] 3 count: by the prescribed motion of kinematic bodies
  Vector gap;                                // [m] count: > 0: still open; < 0: penetration being corrected
  Vector push;                               // [m/s] count: <= 0: rate of that correction
  std::vector<double> mu_static, mu_sliding;
  std::vector<std::uint8_t> sliding;
  std::vector<std::uint8_t> held;   // bits of the axes along which it is a joint (ContactProblem::held)
  std::vector<double> most;         // [N] bound of a joint's force along its first axis (JointHold::most)
  std::vector<double> unbounded;    // [N] that force without the bound
  std::vector<dvec2> lean;          // [1] tilt of the normal against the model's axes
  std::vector<dmat2> turning;       // [1/m] change of that tilt with slip (contact_point.h)
  std::vector<std::uint64_t> key;   // the same contact has the same key in the next model (contact_point.h)
  std::vector<double> farthest;     // [m] of slip: validity limit of those derivatives
  std::vector<double> reach;        // [m] of slip: beyond it an open contact no longer exists (contact_point.h)
  std::vector<dvec2> slip;          // [m] along the tangents, since the axes were set
  std::vector<std::uint8_t> stiff;  // contact without compliance: its force is found by the tick (stiff_contacts.h)

  // Precomputed for ticks of `tick` seconds (methods.md 2.4 with modes for tissue).
  double tick = 1e-3;
  Vector inverse;                     // modes: 1 / (1 + tick damping + tick^2 frequency2)
  Rows6 border;                       // modes x 6: modal_mass + tick modal_damping + tick^2 modal_stiffness
  Matrix6 reduced = Matrix6::Zero();  // tissue_mass + tick ... - border^T inverse border
  Rows6 reduced_handle;               // 3 count x 6: contact velocity per w, modes following
  Eigen::MatrixXd delassus;           // [1/kg] 3 count x 3 count, handle fixed

  void resize(int most_contacts, int most_modes);  // sets the capacity; before the clocks start
  void prepare_tick(double seconds);               // fills the members after `tick`
};

// A body pulled by a probe, from the soft step (pull.h).
struct PullModel {
  std::uint32_t number = 0;     // ProbeHold::number; 0: none
  double time = 0.0;            // [s]
  dvec3 point{0}, velocity{0};  // [m], [m/s] world, of the pulled patch
  double share = 0.0;           // [1] of the spring: ramped up over some steps
};

// Soft clock -> touch clock, per tool.
struct HandleModel {
  std::uint64_t step = 0;                 // 0: nothing published yet
  double time = 0.0;                      // [s] time of the motion and the forces
  double soft_step = 0.0;                 // [s] T
  std::uint32_t set_backs = 0;            // number of times that the soft clock has set the tool back to the device
  RigidMotion handle;                     // of its centre
  dvec3 centre{0};                        // [m] of the handle, in the tool's object frame
  Matrix6 handle_mass = Matrix6::Zero();  // of the handle alone
  Vector6 handle_load = Vector6::Zero();  // [N], [N m] its weight, and the force that supports the tool
  Vector6 force = Vector6::Zero();        // [N], [N m] of tissue and contacts on the handle, from the soft step
  double fed = 0.0;                       // [J] to all bodies since the beginning: by drives, SoftTally::fed
  Vector6 owed = Vector6::Zero();         // [N], [N m] over T, to be given (catch_up.h)
  double owed_steps = 2.0;                // [1] over how many T
  Vector6 passed_on = Vector6::Zero();    // [N], [N m] less the handle's inertia; with handle_load: on the device
  LinearModel linear;
  CondensedContacts contacts;
  PullModel pull;      // of a probe
  bool aside = false;  // of a probe: without contacts with bodies in that step (ProbeHold)
};

// Touch clock -> soft clock, per tool.
struct ToolInput {
  DeviceStatus status = DeviceStatus::kLost;
  double time = 0.0;    // [s] time of the motion
  double tick = 1e-3;   // [s] length of a touch tick
  RigidMotion device;   // of the device's frame
  bool placed = false;  // `handle` is valid: the soft clock's handle follows it, so that there is only one path;
                        // never with ToolForce::kHeld: the soft step couples its handle to `device` itself
  RigidMotion handle;   // the 1 kHz handle's centre
  std::uint32_t set_backs = 0;  // number of requests by the touch clock to set the tool back to the device
  std::uint32_t seen = 0;       // HandleModel::set_backs of the model in use
  double grip = 0.0;            // [1] of its device
  ProbeHold hold;               // of a probe
  double max_force = 0.0;       // [N] of its device: upper bound of a pull
  // [N s], [N m s] Impulse of tissue and contacts on the handle, summed over all ticks so far.
  Vector6 impulse = Vector6::Zero();
};

}  // namespace pliant
