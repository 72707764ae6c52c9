// What the tissue of a tool does to a P1 surface: the soft clock says which points of it press where
// (systems/soft/body/yielding_body.h), and the touch tick holds the surface down under them, as it does under probes.
// They are contacts without a probe: the field follows them, nobody feels them here - their force is the soft step's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

inline constexpr std::uint32_t kMaxPresses = 16;  // points an object: more look no different, and cost a tick each

// One point of tissue at a P1 surface. Object frame of that surface.
struct PressPoint {
  std::uint64_t key = 0;       // the same contact has the same key in the next step
  std::uint32_t triangle = 0;  // where on the surface
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
  double soft_step = 0.0;              // [s] how long the tissue took to get there: the surface follows in as long
  std::vector<ObjectPresses> objects;  // as TouchState::objects
};

// Presses -> Contact (geometry), where `collision` does it for probes.
void press(World& world, Tick tick);

}  // namespace pliant
