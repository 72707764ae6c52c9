#include "systems/touch/feed/touch_events.h"

#include <fmt/format.h>

#include "systems/touch/prepare/touch_state.h"

namespace pliant {

void add_event(TouchState& touch, const TouchEvent& event) {
  if (touch.events.size() < kMostEventsInATick)
    touch.events.push_back(event);
  else
    ++touch.events_over, ++touch.events_lost;
}

std::optional<Note> explain_events(const World& world) {
  const std::uint64_t lost = world.touch ? world.touch->events_lost : 0;
  if (lost == 0) return {};
  return Note{fmt::format("{} events came where a tick had {} already: they are felt, but not recorded", lost,
                          kMostEventsInATick),
              "use fewer probes, or wider `spacing` of detents",
              "dropped.events",
              {}};
}

}  // namespace pliant
