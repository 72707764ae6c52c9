// Motion along a Path: script files and orbits.
#pragma once

#include "components/haptic_device.h"

namespace pliant {

// Linear interpolation, slerp for rotation. Clamped to the first and last row; a repeating path starts over. The path
// has at least one row.
PathRow sample_path(const Path& path, double time);

}  // namespace pliant
