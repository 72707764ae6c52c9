#include "devices/guard/passivity.h"

#include <algorithm>
#include <cmath>

namespace pliant {

// [N] Force of a spring with this stored energy.
static double force_of_spring(double energy, double spring) {
  return std::sqrt(2.0 * spring * std::max(0.0, energy));
}

// Outwards the force is at most the spring's. Inwards, or at rest, the withheld part returns as the spring is
// compressed. A force that was never too large is not changed.
dvec3 PassivityDamper::held_by_spring(dvec3 wanted, dvec3 moved, double budget, double spring) {
  const double size = length(wanted), way = length(moved);
  if (!(size > 0.0)) return held_ = 0.0, wanted;
  const double left = force_of_spring(budget, spring), out = way > 0.0 ? dot(wanted, moved) / way : 0.0;
  if (out > 0.0)
    held_ = std::max(0.0, out - left);
  else
    held_ = std::min(held_, std::max(0.0, size - std::max(left, length(last_) + spring * way)));
  return held_ > 0.0 ? wanted * (1.0 - std::min(1.0, held_ / size)) : wanted;
}

dvec3 PassivityDamper::damp(const EnergyAccount& account, dvec3 wanted, dvec3 weight, dvec3 moved, double most,
                            double slow, double stiffness, double spring) {
  const dvec3 change = wanted - weight - wanted_;
  wanted_ = wanted - weight;
  // The last force was constant over the displacement; the law's own change over it is integrated by the trapezoidal
  // rule. For a force switched by damping, the trapezoidal rule would count only half of the energy.
  work_ = dot(last_ + 0.5 * change, moved);
  const double way = length(moved);
  // If the hand enters or leaves a spring within a step, the trapezoidal rule has an error of up to |df| way / 8.
  const double sampling = 0.25 * length(change) * way;
  const double budget = kPassivityShare * account.stored + kGuardFloor + sampling - account.work - work_;
  if (stiffness > 0.0) spring = kSpentSpring * stiffness;
  if (const dvec3 kept = held_by_spring(wanted_, moved, budget, spring); held_ > 0.0) wanted = weight + kept;
  if (!(way > 0.0)) return wanted;
  const dvec3 along = moved / way, beside = wanted - weight;
  const double step = kPassivityReserve * way, size = length(wanted), total = dot(wanted, along);
  double allowed = budget / step;
  if (budget <= 0.0) allowed = -std::min(-budget / step, size * std::min(1.0, way / slow));
  // The damping force must not raise the total above its limit.
  const double across = std::max(0.0, size * size - total * total);
  const double room = total + std::sqrt(std::max(0.0, most * most - across));
  const double reduction = std::min({dot(beside, along) - allowed, size, room});
  return reduction > 0.0 ? wanted - reduction * along : wanted;
}

void PassivityDamper::book(EnergyAccount& account, dvec3 sent) {
  account.work += work_;
  account.stored = std::max(account.stored, -account.work);
  last_ = sent;
  work_ = 0.0;
}

void StoredInInput::follow(dvec3 wanted, dvec3 moved, double stiffness) {
  const double square = dot(wanted, wanted);
  given_ = square > 0.0 ? std::max(0.0, given_ - 0.5 * dot(last_ + wanted, moved)) : 0.0;
  energy_ = stiffness > 0.0 ? std::max(given_, 0.5 * square / stiffness) : given_;
  last_ = wanted;
}

}  // namespace pliant
