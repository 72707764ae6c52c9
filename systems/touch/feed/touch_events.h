// Events of a touch tick (components/touch_event.h): their list has a fixed size, and what it has no room for is
// counted.
#pragma once

#include <optional>

#include "components/touch_event.h"
#include "runtime/result.h"

namespace pliant {

struct TouchState;

// Of this tick. Does not allocate.
void add_event(TouchState& touch, const TouchEvent& event);
// Parts that the run had to drop so far. Not while the touch clock runs.
std::optional<Note> explain_events(const World& world);

}  // namespace pliant
