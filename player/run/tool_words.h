// Notes about imperfect results of tools and of the soft clock.
#pragma once

#include <string>
#include <vector>

#include "components/soft_body.h"
#include "components/world.h"
#include "engine/run/soft_clock.h"
#include "player/record/keeper.h"

namespace pliant {

// A note, with its remedy, per deficiency of the tool's ticks. Valid when the clocks have stopped.
std::vector<Note> explain_tool(const World& world, const ProbeSummary& summary);
// The same for the soft clock's steps.
std::vector<Note> explain_soft_steps(const World& world, const SoftFigures& figures);

}  // namespace pliant
