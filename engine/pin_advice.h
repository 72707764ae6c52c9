// Which side of a soft body, pinned, holds it under gravity: for whoever authors it.
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
// Of every side and two shares, those that hold it: it finds rest, does not turn over and sags by less than kMuchSag of
// its size. The smallest share first, then the least sag. Some seconds.
std::vector<PinAdvice> advise_pins(const Level& level, std::int32_t node, const std::stop_token& stop = {});

}  // namespace pliant
