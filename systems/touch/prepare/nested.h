// Surfaces inside of others: a probe that presses through the outer one feels both.
#pragma once

#include <vector>

#include "components/world.h"

namespace pliant {

// One note per pair of closed surfaces of which one is inside of the other at the start. Needs prepare_touch.
std::vector<Note> explain_nested(const World& world);

}  // namespace pliant
