// Condenses every body at the chosen contacts for the touch tick. Input: the contacts and each body's response. Output:
// a few vibration modes per body (modal.h), and the residual flexibility without inertia.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kExplained = 1e-6;      // [1] of the largest compliance: stiffer directions get no mode
inline constexpr int kMostBodyModes = 48;       // of one body: cost of a step against accuracy at many contacts
inline constexpr double kHighestPerTick = 1.0;  // [rad] frequency x tick: faster modes become springs
inline constexpr double kDentLag = 0.5;         // [1] of T: damping of dents in the tick; less: it gives out energy

// Called after describe_contacts, to whose flexibility it adds. `tick` [s]: of the touch clock. Fills the modes
// (everything with as many rows or columns), flexibility and flexibility_lag. Returns W_a [1/kg]: the Delassus operator
// of tool tissue, objects and yielding surfaces, the handle fixed.
Eigen::MatrixXd condense_bodies(const ToolContacts& contacts, double tick, CondensedContacts& out);

}  // namespace pliant
