#include "devices/guard/passivity.h"

#include <algorithm>
#include <cmath>

namespace pliant {

dvec3 PassivityDamper::damp(const EnergyAccount& account, dvec3 wanted, dvec3 weight, dvec3 moved, double most,
                            double slow) {
  const dvec3 before = wanted_;
  wanted_ = wanted - weight;
  const double way = length(moved);
  if (!(way > 0.0)) return wanted;
  const dvec3 along = moved / way;
  const double step = kGuardReserve * way, size = length(wanted), total = dot(wanted, along);
  // The trapezoid of a spring that the hand enters or leaves in the middle of a step is off by up to |df| way / 8.
  const double sampling = 0.25 * length(wanted_ - before) * way;
  const double given = account.work + 0.5 * dot(last_, moved);
  const double budget = kGuardShare * account.stored + kGuardFloor + sampling - given;
  // The trapezoid counts half of the new force.
  double allowed = 2.0 * budget / step;
  if (budget <= 0.0) allowed = -std::min(-budget / step, size * std::min(1.0, way / slow));
  // What is added against the motion may not make the whole larger than it may be.
  const double across = std::max(0.0, size * size - total * total);
  const double room = total + std::sqrt(std::max(0.0, most * most - across));
  const double reduction = std::min({dot(wanted_, along) - allowed, size, room});
  return reduction > 0.0 ? wanted - reduction * along : wanted;
}

void PassivityDamper::book(EnergyAccount& account, dvec3 force, dvec3 weight, dvec3 way) {
  account.work += 0.5 * dot(last_ + force - weight, way);
  account.stored = std::max(account.stored, -account.work);
  last_ = force - weight;
}

}  // namespace pliant
