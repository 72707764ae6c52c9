#include "components/varying.h"

#include <algorithm>

namespace pliant {

void vary(const Varying& varying, double time, DeformableParameters& now) {
  PrescribedMotion clock;
  clock.repeats = varying.repeats;
  clock.speed = varying.speed;
  for (const ParameterTrack& each : varying.tracks) {
    const double value = sample_vector(each.track, track_time(each.track, clock, time).time).x;
    now.*each.member = std::clamp(value, each.range.min, each.range.max);
  }
  now.friction_sliding = std::min(now.friction_sliding, now.friction_static);
}

}  // namespace pliant
