// Events of touch: a layer that breaks, tissue that yields, a detent that is crossed.
#pragma once

#include <cstdint>
#include <string>

#include "pliant/math.h"

namespace pliant {

enum class FeltKind : std::uint8_t { kBroke, kYielded, kCrossed };

struct FeltEvent {
  FeltKind kind = FeltKind::kBroke;
  std::uint64_t tick = 0;
  double time = 0.0;       // [s]
  std::string probe;       // name of the effector
  std::string object;      // name of the surface, or of the node with the detents
  std::int32_t index = 0;  // of the layer that broke, from 0; of the detent reached, 0 at the node
  std::string layer;       // name of the layer that broke; "" if it has none
  dvec3 position{0};       // [m] world: on the undeformed surface; of detents, the probe's
  double value = 0.0;      // [N] normal force at which it broke or began to yield; of detents 0

  std::string sentence() const;  // "needle broke layer skin of organ at 0.420 s, 1.20 N"
};

}  // namespace pliant
