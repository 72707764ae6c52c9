// What kept a run from what its laws say, in sentences with their cures: forces that were clipped or withheld, probes
// that touched nothing, soft steps that were left imperfect.
#pragma once

#include <string>
#include <vector>

#include "engine/run/device_links.h"
#include "player/run/report.h"

namespace pliant {

// Fills `figures.misses`, too. After the clocks have stopped.
std::vector<std::string> explain_run(RunFigures& figures, DeviceLinks& devices);

}  // namespace pliant
