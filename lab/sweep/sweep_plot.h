// Plots of a sweep, as .png and .svg: a curve of each figure along each axis, and a map of each figure over each pair
// of axes.
#pragma once

#include <string>

#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "lab/sweep/table.h"
#include "runtime/result.h"

namespace pliant {

// Figures equal in every run are not drawn. Returns the number of staged plots; `left_out` names what did not fit.
// Stops early on interruption, with what was drawn.
Result<std::size_t> plot_sweep(const SweepTable& table, OutputFolder& out, const Interrupt& interrupt,
                               std::string& left_out);

}  // namespace pliant
