// What one soft step says about a tool's handle, as a HandleModel (methods.md 2.6, 2.8): the linear model over the
// active set, and flesh, objects and contacts condensed for the touch tick. Pure arithmetic on a finished step.
#pragma once

#include <memory>
#include <vector>

#include "systems/tool/delassus.h"
#include "systems/tool/handle_model.h"

namespace pliant {

// Tunables of the reduction. Unit, usual value, and what changing it does.
inline constexpr double kExplained = 1e-6;      // [1] of the largest compliance: below it a direction is not a mode's
inline constexpr int kMostBodyModes = 48;       // of one body: cost of a step against modes at many contacts
inline constexpr double kHighestPerTick = 1.0;  // [rad] frequency x tick: faster modes are springs to the touch tick

inline constexpr int kShakes = 2;  // how well the tool's own vibration is followed: six modes each

// A step of T [s] after apply_impulses, before the bodies advance.
struct FinishedStep {
  const std::vector<std::unique_ptr<Body>>& bodies;
  const std::vector<ContactPoint>& contacts;  // with their impulses
  const Delassus& delassus;
  const ContactProblem& problem;
  double T = 0.0;
  double beta = 0.0;  // [1] share of a penetration that is undone in a step
};

// `tool`: index of a SoftBodyState with a handle. `tick` [s]: of the touch clock. Fills all of `out` but `time`.
void reduce_tool(const FinishedStep& step, std::uint32_t tool, double tick, HandleModel& out);

// The contacts that matter to a tool: its own, then those of what it touches, and so on; closest to penetrating first.
std::vector<int> contacts_of(const FinishedStep& step, std::uint32_t tool, int most);

}  // namespace pliant
