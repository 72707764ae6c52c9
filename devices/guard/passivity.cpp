#include "devices/guard/passivity.h"

#include <algorithm>
#include <cmath>

namespace pliant {

dvec3 PassivityDamper::damp(const EnergyAccount& account, dvec3 wanted, dvec3 weight, dvec3 moved, double most,
                            double slow) {
  const dvec3 change = wanted - weight - wanted_;
  wanted_ = wanted - weight;
  // The last force was held over the way; what a law's own change over it is counted as is the trapezoid's. Of a force
  // that damping switches, the trapezoid would count half of what the hand got.
  work_ = dot(last_ + 0.5 * change, moved);
  const double way = length(moved);
  if (!(way > 0.0)) return wanted;
  const dvec3 along = moved / way;
  const double step = kGuardReserve * way, size = length(wanted), total = dot(wanted, along);
  // The trapezoid of a spring that the hand enters or leaves in the middle of a step is off by up to |df| way / 8.
  const double sampling = 0.25 * length(change) * way;
  const double budget = kGuardShare * account.stored + kGuardFloor + sampling - account.work - work_;
  double allowed = budget / step;
  if (budget <= 0.0) allowed = -std::min(-budget / step, size * std::min(1.0, way / slow));
  // What is added against the motion may not make the whole larger than it may be.
  const double across = std::max(0.0, size * size - total * total);
  const double room = total + std::sqrt(std::max(0.0, most * most - across));
  const double reduction = std::min({dot(wanted_, along) - allowed, size, room});
  return reduction > 0.0 ? wanted - reduction * along : wanted;
}

void PassivityDamper::book(EnergyAccount& account, dvec3 sent) {
  account.work += work_;
  account.stored = std::max(account.stored, -account.work);
  last_ = sent;
  work_ = 0.0;
}

}  // namespace pliant
