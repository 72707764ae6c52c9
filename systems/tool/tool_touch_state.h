// A tool on the touch clock, and the buffers between its clocks. Writer: the touch clock, except for members marked as
// the soft clock's.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "components/soft_body.h"
#include "components/world.h"
#include "systems/safety/safety.h"
#include "systems/soft/body/body.h"
#include "systems/tool/handle_model.h"
#include "systems/tool/tool_tick.h"

namespace pliant {

// Tunables of the touch tick. Unit, usual value, and what changing it does.
inline constexpr double kFadeShare = 1.0 / 3.0;   // [1] of T: time constant with which a stale model fades
inline constexpr double kJoinShare = 3.0 / 8.0;   // [1] of T: duration of the cross-fade of models; shorter: steeper
inline constexpr int kSettleTicks = 3;            // ticks of a new model before its contacts act; fewer: jumps
inline constexpr double kStaleSteps = 3.0;        // [1] of T: a model older than this fades to zero
inline constexpr int kLateTicks = 3;              // successive ticks over budget before the linear model takes over
inline constexpr int kTickSweeps = 20;            // largest number of Gauss-Seidel sweeps in a tick; warm-started
inline constexpr double kTickTolerance = 1e-3;    // [1] of the fastest closing velocity: convergence criterion
inline constexpr int kStiffSweeps = 100;          // both, for stacks of rigid bodies: a looser solution sinks in
inline constexpr double kStiffTolerance = 1e-5;   // a little with every model
inline constexpr double kMostStretch = 2.0;       // [m] a handle farther from its device has got away,
inline constexpr double kRunaway = 50.0;          // [m/s] as has one that is faster,
inline constexpr double kRunawayTurn = 1000.0;    // [rad/s] or rotates faster
inline constexpr std::size_t kMostFollowed = 32;  // largest number of (merged) ticks by which a model is updated
inline constexpr int kMostCaughtUp = 8;   // missed ticks up to this are caught up one by one; more cost too long,
inline constexpr int kLongCatchUps = 16;  // and are caught up in this number of steps
inline constexpr double kEvenWay = 0.05;  // [s] interval over which a hand's acceleration is assumed constant
inline constexpr std::size_t kPathLength = 4096;  // ticks of the handle's path that can wait for the soft clock

// Whether the handle pushes against stiff contacts (stiff_contacts.h).
inline bool has_stiff(const CondensedContacts& contacts) {
  const auto end = contacts.stiff.begin() + contacts.count;
  return std::find(contacts.stiff.begin(), end, 1) != end;
}

// Accuracy of a tick's contacts, in the tick itself and where the soft clock follows it.
inline SweepLimits sweep_limits(const CondensedContacts& contacts, SweepLimits limits) {
  if (!has_stiff(contacts)) return limits;
  limits.sweeps = std::max(limits.sweeps, kStiffSweeps);
  limits.tolerance = std::min(limits.tolerance, kStiffTolerance);
  return limits;
}

// A tick of the handle's path, by which the soft clock updates its model.
struct HandleStep {
  double time = 0.0;  // [s] at its end
  Vector6 velocity = Vector6::Zero();
};

// The patch of a body that a probe pulls. Writer: the soft clock (pull.h).
struct Pull {
  struct Part {
    SurfacePoint point;
    double weight = 0.0;  // [1] they sum to 1
  };
  std::uint32_t number = 0;  // ProbeHold::number of this pull; 0: none so far
  std::uint32_t body = 0;    // into SoftState::bodies
  std::vector<Part> parts;   // empty: nothing to pull
  double held_for = 0.0;     // [s]
};

// Where the handle is in its life; adopt() in tool_feedback.cpp makes each step towards kFollows.
enum class HandleState : std::uint8_t {
  kNew,      // without a model, or with one that was not finite: the next model places it
  kFollows,  // placed: it moves in every tick
  kSetBack,  // too far from its device: waits until the soft clock has moved the tool there
  kReturns,  // of a probe that hovered or pulled: as kSetBack, then placed at its device's pose of that tick
};

struct ToolTouchState {
  Entity entity;  // has a Handle6 and a SoftBody or RigidBody; or a Probe
  bool is_probe = false;
  Handle6 settings;                    // of a probe; of a tool: its component's
  Entity device = kNoEntity;           // has a HapticDevice
  TripleBuffer<ToolInput> input;       // touch -> soft
  TripleBuffer<HandleModel> model;     // soft -> touch
  Ring<HandleStep> path{kPathLength};  // touch -> soft

  // The soft clock's: the model under construction, and its working memory.
  HandleModel pending;
  std::vector<HandleStep> gone;  // of the path, since the model
  double heard_at = 0.0;         // [s] time of the last input with a placed handle; its `impulse`
  Vector6 heard = Vector6::Zero();
  Vector6 expected =
      Vector6::Zero();         // [N], [N m] mean wrench of tissue and contacts on the handle since the last input
  std::uint32_t set_back = 0;  // the last ToolInput::set_backs served
  CondensedState replay;
  Pull pull;  // of a probe

  ToolForce wanted = ToolForce::kContacts;  // Handle6::force
  SweepLimits limits;                       // of a tick; in lockstep budget_ns is 0: no wall time, always the same bits

  HandleState state = HandleState::kNew;
  bool placed() const { return state == HandleState::kFollows; }

  // Valid while placed.
  ToolForce used = ToolForce::kHeld;       // kContacts until late
  int late = 0;                            // ticks in a row
  RigidMotion handle;                      // of its centre
  Vector6 displacement = Vector6::Zero();  // d, relative to the model in use
  CondensedState contacts;
  Vector6 fade = Vector6::Zero();    // [N], [N m] added to the model's wrench, fading to zero
  double fade_left = 0.0;            // [1] ticks until it is zero
  Vector6 owed = Vector6::Zero();    // [N s], [N m s] HandleModel::owed times T, what is left of it
  double owed_left = 0.0;            // [1] ticks in which it is given
  bool joins = false;                // the next tick is the first with `used`, or with a new model
  int settling = 0;                  // remaining ticks in which the contacts do not act yet
  Vector6 gained = Vector6::Zero();  // [m/s], [rad/s] change of the handle's velocity over the last tick

  // For display and devices.
  RigidMotion sensed;                       // the device
  bool sensing = false;                     // `sensed` is valid
  double sensed_at = 0.0;                   // [s] beginning of the tick that sensed it
  Vector6 wrench = Vector6::Zero();         // [N], [N m] tissue and contacts on the handle, over the last tick
  Vector6 impulse = Vector6::Zero();        // [N s], [N m s] its sum over time
  bool aside = false;                       // of a probe: it hovers or pulls, without contacts with bodies
  std::uint32_t set_backs = 0;              // number of requests to be set back
  std::uint32_t models_set_back = 0;        // HandleModel::set_backs of the model in use
  Vector6 device_wrench = Vector6::Zero();  // [N], [N m] wanted, on the device at its origin
  SafetyState force_safety, torque_safety;
  double fed = 0.0;  // [J] HandleModel::fed that their account has
  dvec3 weight{0};   // [N] of the whole tool without weight compensation, else 0; constant
  dvec3 balance{0};  // [m] its centre of mass at rest, in the object frame
  dvec3 turned{0};   // [rad] sum of the device's small rotations
  std::uint64_t ticks_late = 0;
};

// World::tools. Sized by prepare_tools.
struct ToolTouch {
  std::vector<std::unique_ptr<ToolTouchState>> tools;
};

inline const Handle6& settings_of(const World& world, const ToolTouchState& tool) {
  return tool.is_probe ? tool.settings : world.registry.get<Handle6>(tool.entity);
}

// Of a tool or probe; null if there is none.
inline ToolTouchState* find_tool(const World& world, Entity entity) {
  if (!world.tools) return nullptr;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools)
    if (tool->entity == entity) return tool.get();
  return nullptr;
}

}  // namespace pliant
