// Scheme and length of the soft step against a converged solution: tissue alone, in four motions.
#pragma once

#include "lab/study/time_step/step_schemes.h"

namespace pliant {

// Free swing, press, slide and impact. `cells`: per height of the block or bar.
std::vector<TissueScene> step_scenes(int cells);

// Positions of all nodes at each multiple of `every` [s], a whole number of steps. Empty if a step had no solution, or
// if `goes_on` (called with the completed share) returns false. `ms`: CPU time per simulated second.
using StepTrace = std::vector<std::vector<dvec3>>;
StepTrace trace_of(
    const TissueScene& scene, StepScheme scheme, double step, double every, double* ms = nullptr,
    const std::function<bool(double)>& goes_on = [](double) { return true; });

// [1] RMS distance of the nodes over the RMS of their displacement from rest, or from force-free motion. Infinite if a
// trace is empty.
double trace_error(const TissueScene& scene, const StepTrace& trace, const StepTrace& truth, double every);

}  // namespace pliant
