// Every body that the chosen contacts push, condensed for the touch tick. Takes the contacts and how each body answers
// to them; gives a few vibration modes per body (modal.h) and what they leave as flexibility without inertia.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kExplained = 1e-6;      // [1] of the largest compliance: below it a direction is not a mode's
inline constexpr int kMostBodyModes = 48;       // of one body: cost of a step against modes at many contacts
inline constexpr double kHighestPerTick = 1.0;  // [rad] frequency x tick: faster modes are springs to the touch tick

// After describe_contacts, whose flexibility it adds to. `tick` [s]: of the touch clock. Fills the modes (all that has
// as many rows or columns), flexibility and flexibility_lag.
// Returns W_a [1/kg]: the Delassus operator of tool tissue, objects and yielding surfaces, the handle held.
Eigen::MatrixXd condense_bodies(const ToolContacts& contacts, double tick, CondensedContacts& out);

}  // namespace pliant
