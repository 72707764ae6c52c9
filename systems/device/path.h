// Motion along a Path: script files and orbits.
#pragma once

#include "components/haptic_device.h"

namespace pliant {

// Linear in between, slerp for rotation; before the first row the first, after the last the last (or from the start
// again where the path repeats). The path has at least one row.
PathRow sample_path(const Path& path, double time);

}  // namespace pliant
