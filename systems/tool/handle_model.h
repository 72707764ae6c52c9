// What the soft clock and the touch clock tell each other about a tool (methods.md 2.6-2.9). Both travel by
// TripleBuffer (tool_touch_state.h); everything has a fixed capacity, so that filling and copying allocate nothing.
//
// A twist or wrench is six numbers: linear first, then angular, world axes, about the handle's origin.
// d: displacement of the handle since the model's pose, w: its twist, both six numbers.
//
// Two descriptions of the wrench that flesh and contacts put on the handle:
// - LinearModel, as P2 has it: F = force - K d - B (w - w0) - M w'. The matrices of the implicit step, C = M + T B +
//   T^2 K, split exactly by the shape that one step gives to everything that moves with the handle.
// - CondensedContacts, beyond P2: flesh and objects as a few vibration modes plus residual flexibility at the contacts,
//   between handle and contacts; the touch tick solves Signorini and Coulomb again with them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "components/haptic_device.h"
#include "components/math.h"
#include "systems/tool/block_matrix.h"

namespace pliant {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline constexpr int kMaxCondensed = 64;        // contacts that the touch tick solves again, deepest first
inline constexpr int kMaxModes = 128;           // of flesh and objects together
inline constexpr std::size_t kHandlePast = 64;  // ticks of the handle's path that the soft clock gets to see

struct LinearModel {
  Vector6 force = Vector6::Zero();      // [N], [N m] at d = 0, w = w0, w' = 0
  Matrix6 stiffness = Matrix6::Zero();  // K [N/m ...] symmetric, eigenvalues >= 0; so are the other two
  Matrix6 damping = Matrix6::Zero();    // B [N s/m ...]
  Matrix6 mass = Matrix6::Zero();       // M [kg ...] of flesh and of what sticks to it
};

// Rows of a contact: normal, first tangent, second tangent. Modes are mass-normalised: M = 1, D = damping, K =
// frequency2, each with displacement q (0 at the model's time) and rate q'. Leading parts count.
struct CondensedContacts {
  int count = 0;  // contacts
  int modes = 0;
  Eigen::MatrixXd from_handle;  // 3 count x 6: contact velocity per twist of the handle, modes held
  Rows from_modes;              // 3 count x modes: contact velocity per mode rate
  Eigen::MatrixXd flexibility;  // [m/N] 3 count x 3 count: what the modes leave out, without inertia
  Vector force;                 // [N] 3 count, at the model's time
  Vector gap;                   // [m] count: >= 0, what is left to close; 0 where they touch
  Vector push;                  // [m/s] count: <= 0, rate at which penetration is being undone
  std::vector<double> mu_static, mu_sliding;
  std::vector<std::uint8_t> sliding;

  Vector frequency2;                                     // [1/s2]
  Vector damping;                                        // [1/s]
  Vector rate;                                           // q' at the model's time
  Vector load;                                           // q'' of flesh and gravity alone, at the model's time
  Eigen::Matrix<double, 6, Eigen::Dynamic> handle_mass;  // 6 x modes: inertia between handle and mode
  Eigen::Matrix<double, 6, Eigen::Dynamic> handle_damping, handle_stiffness;

  Vector6 flesh_force = Vector6::Zero();  // [N], [N m] on the handle at the model's time, without contacts and inertia
  Matrix6 flesh_mass = Matrix6::Zero(), flesh_damping = Matrix6::Zero(), flesh_stiffness = Matrix6::Zero();

  void resize(int most_contacts, int most_modes);  // before the clocks start
};

// Soft clock -> touch clock, per tool.
struct HandleModel {
  std::uint64_t step = 0;  // 0: nothing has been published yet
  double time = 0.0;       // [s] that pose, twist and forces belong to
  double soft_step = 0.0;  // [s] T
  dvec3 position{0};       // [m] world, of the handle's origin
  dquat rotation{1, 0, 0, 0};
  Vector6 velocity = Vector6::Zero();     // w0
  Matrix6 handle_mass = Matrix6::Zero();  // of the handle alone, world axes, about its origin
  Vector6 handle_load = Vector6::Zero();  // [N], [N m] gravity on the handle alone
  Vector6 force = Vector6::Zero();        // [N], [N m] on the handle at `time`: for display
  LinearModel linear;
  CondensedContacts contacts;
};

// Touch clock -> soft clock, per tool.
struct ToolInput {
  DeviceStatus status = DeviceStatus::kLost;
  double time = 0.0;  // [s] that the poses belong to
  double dt = 1e-3;   // [s] of a touch tick
  dvec3 position{0};  // [m] world, device
  dquat rotation{1, 0, 0, 0};
  dvec3 velocity{0}, angular_velocity{0};    // [m/s], [rad/s] world, device
  std::uint64_t ticks = 0;                   // past ticks: the twist of tick n stands at n % kHandlePast
  std::array<Vector6, kHandlePast> twist{};  // of the 1 kHz handle
};

}  // namespace pliant
