// Tools and the soft clock in words: what was left imperfect.
#pragma once

#include <string>
#include <vector>

#include "components/soft_body.h"
#include "components/world.h"
#include "engine/run/soft_clock.h"
#include "player/record/keeper.h"

namespace pliant {

// A sentence for each thing that the tool's ticks had to do without, with its cure. Valid when the clocks have stopped.
std::vector<std::string> explain_tool(const World& world, const ProbeSummary& summary);
// The same of the soft clock's steps.
std::vector<std::string> explain_soft_steps(const World& world, const SoftFigures& figures);

}  // namespace pliant
