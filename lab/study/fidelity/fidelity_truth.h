// The truth of the study: block presses on finer and finer grids, and their limit.
#pragma once

#include <string>
#include <vector>

#include "lab/console/interrupt.h"
#include "lab/console/progress.h"
#include "lab/study/fidelity/study_fidelity.h"

namespace pliant {

// A press at one depth, on finer and finer grids, and the limit.
struct DepthTruth {
  double depth = 0.0;               // [m]
  std::vector<double> force;        // [N] per grid
  GridLimit limit;                  // of the force
  double sure = 0.0;                // [1] relative change of the limit by the last grid; NaN with three grids
  std::vector<PressTruth> surface;  // per grid
  PressTruth limit_surface() const { return limit_truth(surface[surface.size() - 2], surface.back(), limit); }
};

using GridPresses = std::vector<std::vector<PressedBlock>>;  // per grid, per depth

// The limit at each of the depths [m], ascending, from grids of these cells per punch radius; appends the presses to
// `all`. Reports progress over `part` of the study, `from` a share of it on.
Result<std::vector<DepthTruth>> limits_of(const Indented& what, const std::vector<int>& cells,
                                          const std::vector<double>& depths, GridPresses& all,
                                          const Interrupt& interrupt, Progress& progress, double from, double part);

std::string truth_csv(const std::vector<int>& cells, const std::vector<DepthTruth>& truths, const GridPresses& all);

}  // namespace pliant
