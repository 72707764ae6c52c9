// Advice for authors: which pinned side of a soft body supports it under gravity.
#pragma once

#include <stop_token>
#include <vector>

#include "content/author/object_frame.h"
#include "systems/soft/body/equilibrium.h"

namespace pliant {

struct PinAdvice {
  Side side = Side::kBottom;
  double share = 0.15;     // [1] of the body's extent from that side
  double sag = 0.0;        // [m] of a coarse lattice of it
  double sag_share = 0.0;  // [1] of its size
};
// Tries every side with two shares and returns those that support the body: it comes to rest, does not turn over and
// sags by less than kMuchSag of its size. Sorted by share, then by sag. Takes some seconds.
std::vector<PinAdvice> advise_pins(const Level& level, std::int32_t node, const std::stop_token& stop = {});

}  // namespace pliant
