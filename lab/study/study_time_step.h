// The soft step's scheme and its length against a converged solution: tissue alone, on four motions.
#pragma once

#include "lab/study/step_schemes.h"

namespace pliant {

// Free swing, press, slide and impact. `cells`: of a block's height, or a bar's.
std::vector<TissueScene> step_scenes(int cells);

// Places of all nodes at each multiple of `every` [s], which is a whole number of steps; empty where a step had no
// solution, or `goes_on` (asked with the share that is done) says no. `ms`: processor time, by simulated second.
using StepTrace = std::vector<std::vector<dvec3>>;
StepTrace trace_of(
    const TissueScene& scene, StepScheme scheme, double step, double every, double* ms = nullptr,
    const std::function<bool(double)>& goes_on = [](double) { return true; });

// [1] RMS of the distance of nodes over the RMS of how far they went from where they were at rest, or would be without
// forces. Infinite where a trace is empty.
double trace_error(const TissueScene& scene, const StepTrace& trace, const StepTrace& truth, double every);

}  // namespace pliant
