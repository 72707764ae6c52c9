// forces.png: depth and force of every probe and tool over time, as one would show it in a talk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "player/record/trace.h"
#include "runtime/result.h"

namespace pliant {

struct PlotRow {
  std::string name;    // of the probe or tool
  std::string source;  // what moved it
  const Trace* trace = nullptr;
  bool tool = false;  // its depth is how far the device is led past the handle (systems/tool/tool_reading.h)
};

// Two panels each: depth [mm], and normal and tangential force [N], over time [s], captioned as they are meant for a
// probe and for a tool; contact is shaded, and bands along the time axis show where the force was clipped or withheld.
// More than kMaxPlotRows: the first ones, and a line that says so. `dt` [s] is the length of a tick, `seconds` of the
// run.
inline constexpr std::size_t kMaxPlotRows = 8;
Status plot_forces(const std::filesystem::path& file, const std::string& title, const std::vector<PlotRow>& rows,
                   double dt, double seconds);

}  // namespace pliant
