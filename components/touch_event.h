// An event of a touch tick (pliant/felt_event.h), by entities. Rate: touch. Writer: friction_feedback, effects. Reader:
// journals, after the tick.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/math.h"
#include "pliant/felt_event.h"
#include "runtime/entity.h"

namespace pliant {

struct World;

struct TouchEvent {
  FeltKind kind = FeltKind::kBroke;
  std::int32_t index = 0;  // as in FeltEvent
  std::uint64_t tick = 0;
  double time = 0.0;  // [s]
  Entity probe, object;
  dvec3 position{0};   // [m] world
  double value = 0.0;  // [N]
};

// Of one tick; more are lost, and counted (systems/touch/feed/touch_events.h).
inline constexpr std::size_t kMostEventsInATick = 64;
// Those that wait for a journal's owner.
inline constexpr std::size_t kMostEventsWaiting = 4096;

const char* word_of(FeltKind kind);
FeltEvent named(const World& world, const TouchEvent& event);
// Whether anything in the world can cause an event.
bool has_events(const World& world);

}  // namespace pliant
