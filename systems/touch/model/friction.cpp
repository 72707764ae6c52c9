#include "systems/touch/model/friction.h"

namespace pliant {

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
