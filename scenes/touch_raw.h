// The raw force of a touch before safety, the stored energy, and the work on a hand.
#pragma once

#include <algorithm>
#include <cmath>

#include "scenes/scenes.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

using scenes::Stage;

inline dvec3 raw_force(const Stage& stage, Entity probe) {
  return stage.world.registry.get<Probe>(probe).force;
}
inline double stored(const Stage& stage) {
  double sum = 0.0;
  for (const ObjectState& object : stage.world.touch->objects) sum += object.stored;
  return sum;
}

// Work on the hand by the raw force before safety, by the trapezoidal rule, and the largest stored energy.
struct RawMeter {
  double work = 0.0, most = 0.0;
  dvec3 force{0}, position{0};
  bool started = false;
  void add(const Stage& stage, Entity probe, dvec3 x) {
    const dvec3 f = raw_force(stage, probe);
    if (started) work += 0.5 * dot(f + force, x - position);
    force = f;
    position = x;
    started = true;
    most = std::max(most, stored(stage));
  }
};

inline Primitive painted_sheet(int cells, double size) {
  Primitive p = scenes::sheet(cells, size);
  for (const vec3& x : p.position) {  // stiffness from 100 to 600 N/m over 16 mm
    const double s = std::clamp((static_cast<double>(x.x) + 0.008) / 0.016, 0.0, 1.0);
    p.stiffness.push_back(static_cast<float>(1.0 + 5.0 * s));
  }
  return p;
}

}  // namespace pliant
