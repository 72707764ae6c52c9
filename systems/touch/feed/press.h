// Presses of a tool's tissue on a P1 surface. The soft clock sends the pressing points
// (systems/soft/body/yielding_body.h); the touch tick presses the surface down under them, as under probes. They are
// contacts without a probe: the field follows them, but they give no force here; their force is the soft step's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

inline constexpr std::uint32_t kMaxPresses = 16;  // points per object: more look the same, and cost time

// One point of tissue at a P1 surface. Object frame of that surface.
struct PressPoint {
  std::uint64_t key = 0;       // the same contact has the same key in the next step
  std::uint32_t triangle = 0;  // place on the surface
  dvec3 barycentric{1, 0, 0};  // [1]
  dvec3 position{0};           // [m] of the tissue, at the end of the soft step
  dvec3 velocity{0};           // [m/s] over that step
};

struct ObjectPresses {
  std::uint32_t count = 0;
  std::array<PressPoint, kMaxPresses> points;
};

// Soft clock -> touch clock.
struct Presses {
  double soft_step = 0.0;              // [s] duration of the tissue's motion; the surface follows in the same time
  std::vector<ObjectPresses> objects;  // parallel to TouchState::objects
};

// Presses -> Contact (geometry), as `collision` does for probes.
void press(World& world, Tick tick);

}  // namespace pliant
