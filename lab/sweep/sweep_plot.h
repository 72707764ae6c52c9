// Plots of a sweep, as .png and .svg: a curve of each figure along each axis, and a map of each figure over each two
// axes.
#pragma once

#include <string>

#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "lab/sweep/table.h"
#include "runtime/result.h"

namespace pliant {

// Figures that are the same in every run are not drawn. How many plots were staged; `left_out` says what a picture had
// no room for. Ends early, with what was drawn, when that is requested.
Result<std::size_t> plot_sweep(const SweepTable& table, OutputFolder& out, const Interrupt& interrupt,
                               std::string& left_out);

}  // namespace pliant
