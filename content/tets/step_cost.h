// Estimates the time of a soft step on this machine, before any simulation.
#pragma once

#include <cstddef>

namespace pliant {

// A model of measurements (bench/results/README.md, a whole soft step of a tool with some 60 contacts, `auto` solver,
// medians on an idle 2-core Xeon virtual machine): 4.7 ms with 540 tetrahedra, 6.0 with 2,016, 44 with 10,080 and 676
// with 40,128. The model gives 4.6, 6.2, 47 and 681. The quadratic part is the factorisation; contacts and the touch
// clock are the rest. Steps without contacts take less; those of several bodies add up.
inline constexpr double kStepBase = 4.5;       // [ms]
inline constexpr double kStepSquare = 4.2e-7;  // [ms] per tetrahedron squared

// [ms] On a machine with `slowness` times the reference machine's time.
double step_ms(std::size_t tetrahedra, double slowness);

// [1] Slowness of this machine: times a few milliseconds of a factorisation in CPU time of one thread, the minimum of
// several runs. Measured at the first call, then cached.
double machine_slowness();

}  // namespace pliant
