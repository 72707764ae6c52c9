// A tool as the touch clock has it, and what travels between its clocks. Writer: the touch clock, but for
// what is marked as the soft clock's.
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
inline constexpr double kFadeShare = 1.0 / 3.0;  // [1] of T: a model that is too old fades with this time constant
inline constexpr double kJoinShare = 3.0 / 8.0;  // [1] of T: what two models differ by fades evenly; shorter: steeper
inline constexpr int kSettleTicks = 3;           // of a new model, its contacts unfelt; fewer: its impacts jump
inline constexpr double kStaleSteps = 3.0;       // [1] of T: a model older than this fades to nothing
inline constexpr int kLateTicks = 3;             // ticks in a row over budget, then the linear model takes over
inline constexpr int kTickSweeps = 20;           // a tick's Gauss-Seidel sweeps at most; they start warm
inline constexpr double kTickTolerance = 1e-3;   // [1] of the fastest closing: good enough, stop
inline constexpr int kStiffSweeps = 100;  // both, where rigid bodies stand on each other: a looser solution sinks
inline constexpr double kStiffTolerance = 1e-5;   // in, a little with every model
inline constexpr double kMostStretch = 2.0;       // [m] a handle farther from its device has got away from the hand,
inline constexpr double kRunaway = 50.0;          // [m/s] and so has one that is faster,
inline constexpr double kRunawayTurn = 1000.0;    // [rad/s] or turns faster
inline constexpr std::size_t kMostFollowed = 32;  // of them, joined, that a model is brought up to date by
inline constexpr int kMostCaughtUp = 8;   // ticks that could not begin are made up for one by one; more cost too long,
inline constexpr int kLongCatchUps = 16;  // and are made up for in so many steps
inline constexpr double kEvenWay = 0.05;  // [s] in which a hand is taken to gather speed evenly
inline constexpr std::size_t kPathLength = 4096;  // ticks of the handle's path that may wait for the soft clock

// Somewhere only the contacts know what the handle pushes against (stiff_contacts.h).
inline bool has_stiff(const CondensedContacts& contacts) {
  const auto end = contacts.stiff.begin() + contacts.count;
  return std::find(contacts.stiff.begin(), end, 1) != end;
}

// How far a tick's contacts are solved, in the tick itself and where the soft clock follows it.
inline SweepLimits sweep_limits(const CondensedContacts& contacts, SweepLimits limits) {
  if (!has_stiff(contacts)) return limits;
  limits.sweeps = std::max(limits.sweeps, kStiffSweeps);
  limits.tolerance = std::min(limits.tolerance, kStiffTolerance);
  return limits;
}

// A tick of the handle's path, for the soft clock to bring its model up to date with.
struct HandleStep {
  double time = 0.0;  // [s] at its end
  Vector6 velocity = Vector6::Zero();
};

// What a probe holds of a body, and pulls. Writer: the soft clock (pull.h).
struct Pull {
  struct Part {
    SurfacePoint point;
    double weight = 0.0;  // [1] they sum to 1
  };
  std::uint32_t number = 0;  // ProbeHold::number that this is of; 0: none so far
  std::uint32_t body = 0;    // into SoftState::bodies
  std::vector<Part> parts;   // empty: there is nothing to hold
  double held_for = 0.0;     // [s]
};

struct ToolTouchState {
  Entity entity;  // has a Handle6 and a SoftBody or RigidBody; or a Probe
  bool is_probe = false;
  Handle6 settings;                    // of a probe; of a tool: its component's
  Entity device = kNoEntity;           // has a HapticDevice
  TripleBuffer<ToolInput> input;       // touch -> soft
  TripleBuffer<HandleModel> model;     // soft -> touch
  Ring<HandleStep> path{kPathLength};  // touch -> soft

  // The soft clock's: the model it is making, and its working memory.
  HandleModel pending;
  std::vector<HandleStep> gone;  // of the path, since the model
  double heard_at = 0.0;         // [s] of the last input with a placed handle; its `impulse`
  Vector6 heard = Vector6::Zero();
  Vector6 expected =
      Vector6::Zero();         // [N], [N m] what tissue and contacts did to the handle, mean since the last input
  std::uint32_t set_back = 0;  // ToolInput::set_backs done
  CondensedState replay;
  Pull pull;  // of a probe

  ToolForce wanted = ToolForce::kContacts;  // Handle6::force
  SweepLimits limits;  // of a tick; in lockstep budget_ns is 0: never wall time, always the same bits

  // Since the first model.
  bool placed = false;
  ToolForce used = ToolForce::kHeld;       // kContacts until late
  int late = 0;                            // ticks in a row
  RigidMotion handle;                      // of its centre
  Vector6 displacement = Vector6::Zero();  // d, of the model in use
  CondensedState contacts;
  Vector6 fade = Vector6::Zero();    // [N], [N m] added to the model's wrench, fading
  double fade_left = 0.0;            // [1] ticks until it is nothing
  bool joins = false;                // the next tick is the first by `used`, or by a new model
  int settling = 0;                  // ticks for which the contacts still go along unseen
  Vector6 gained = Vector6::Zero();  // [m/s], [rad/s] of the handle's velocity, over the last tick

  // For display and devices.
  RigidMotion sensed;                       // the device
  bool sensing = false;                     // `sensed` means something
  double sensed_at = 0.0;                   // [s] beginning of the tick that sensed it
  Vector6 wrench = Vector6::Zero();         // [N], [N m] tissue and contacts on the handle, over the last tick
  Vector6 impulse = Vector6::Zero();        // [N s], [N m s] its sum over time
  bool away = false;                        // it waits to be set back into the hand
  bool aside = false;                       // a probe's: it hovers or pulls, and meets no body
  bool returns = false;                     // it did, and comes in where its device is by then
  std::uint32_t set_backs = 0;              // how often it has asked for that
  std::uint32_t models_set_back = 0;        // and how often the model in use had been
  Vector6 device_wrench = Vector6::Zero();  // [N], [N m] wanted, on the device at its own origin
  SafetyState force_safety, torque_safety;
  dvec3 weight{0};   // [N] of the whole tool where nothing carries it, else 0; constant
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

// A tool's or a probe's; null where there is none.
inline ToolTouchState* find_tool(const World& world, Entity entity) {
  if (!world.tools) return nullptr;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools)
    if (tool->entity == entity) return tool.get();
  return nullptr;
}

}  // namespace pliant
