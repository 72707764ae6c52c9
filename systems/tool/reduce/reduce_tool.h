// Reduces one soft step to a tool's HandleModel (methods.md 2.6, 2.8): the linear model over the active set, and
// tissue, objects and contacts condensed for the touch tick. Pure arithmetic on a finished step. Its parts, in order of
// the data: reduce/tool_contacts.h, handle_and_tissue.h, body_answers.h, condense_bodies.h and linear_model.h.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

// `tool`: index of a ToolBody with a handle. `tick` [s]: of the touch clock. Fills all of `out` except `step` and
// `time`.
void reduce_tool(const FinishedStep& step, std::uint32_t tool, double tick, HandleModel& out);

// The same for a touch clock that keeps the step's force constant: neither linear model nor modes.
void describe_tool(const FinishedStep& step, std::uint32_t tool, double tick, HandleModel& out);

}  // namespace pliant
