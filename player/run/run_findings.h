// Findings of a run with their remedies: clipped or withheld forces, probes without contact, imperfect soft steps.
#pragma once

#include <string>
#include <vector>

#include "engine/run/device_links.h"
#include "player/run/report.h"

namespace pliant {

// Also fills `figures.misses`. Call after the clocks have stopped.
std::vector<Note> explain_run(RunFigures& figures, DeviceLinks& devices);

}  // namespace pliant
