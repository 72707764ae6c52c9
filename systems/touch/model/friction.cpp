#include "systems/touch/model/friction.h"

#include <cmath>

namespace pliant {

double SlidingFriction::at(double speed) const {
  double mu = sliding_value;
  if (stribeck > 0) mu += (static_value - sliding_value) * std::exp(-(speed / stribeck) * (speed / stribeck));
  if (viscous > 0) mu += viscous * speed;
  return mu;
}

double SlidingFriction::slope(double speed) const {
  double slope = viscous;
  if (stribeck > 0) {
    const double u = speed / stribeck;
    slope -= 2 * u / stribeck * (static_value - sliding_value) * std::exp(-u * u);
  }
  return slope;
}

dvec3 step_bristle(Bristle& bristle, dvec3 v, double K, double B, double static_limit, double sliding_limit, double T) {
  const dvec3 e = bristle.deflection;
  const dvec3 trial = K * e + (K * T + B) * v;
  const double size = length(trial);
  if (size <= (bristle.sliding ? sliding_limit : static_limit)) {
    bristle.sliding = false;
    bristle.deflection = e + T * v;
    return trial;
  }
  bristle.sliding = true;
  const dvec3 f = trial * (sliding_limit / size);
  // The deflection for which the bristle's force is exactly f at the end of the step.
  bristle.deflection = (B * e + T * f) / (B + K * T);
  return f;
}

}  // namespace pliant
