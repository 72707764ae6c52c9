// forces.png: depth and force of every probe and tool over time, as a figure for presentation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "player/record/trace.h"
#include "runtime/result.h"

namespace pliant {

struct PlotRow {
  std::string name;    // of the probe or tool
  std::string source;  // the source that moved it
  const Trace* trace = nullptr;
  bool tool = false;  // its depth is the offset of the device from the handle (systems/tool/tool_reading.h)
};

// Two panels per row: depth [mm], and normal and tangential force [N], over time [s], with captions for a probe or a
// tool. Contact is shaded, and bands along the time axis mark where the force was clipped or withheld. With more than
// kMaxPlotRows rows, the first ones are drawn and a line notes it. `dt` [s]: length of a tick; `seconds`: of the run.
inline constexpr std::size_t kMaxPlotRows = 8;
Status plot_forces(const std::filesystem::path& file, const std::string& title, const std::vector<PlotRow>& rows,
                   double dt, double seconds);

}  // namespace pliant
