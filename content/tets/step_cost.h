// About how long a soft step takes on this machine, before anything is simulated.
#pragma once

#include <cstddef>

namespace pliant {

// A model of what was measured (bench/results/README.md, a whole soft step of a tool with some 60 contacts, `auto`
// solver, medians on an idle 2-core Xeon virtual machine): 4.7 ms with 540 tetrahedra, 6.0 with 2,016, 44 with 10,080
// and 676 with 40,128. The model says 4.6, 6.2, 47 and 681. What grows with the square is the factor; contacts and what
// the touch clock needs are the rest. Steps without contacts take less, of several bodies the sum.
inline constexpr double kStepBase = 4.5;       // [ms]
inline constexpr double kStepSquare = 4.2e-7;  // [ms] a tetrahedron squared

// [ms] For a machine that takes `slowness` times as long as that one.
double step_ms(std::size_t tetrahedra, double slowness);

// [1] Of this machine, by a few milliseconds of arithmetic like the factor's, in processor time of one thread, the
// least of several runs. Measured when first asked for, then the same.
double machine_slowness();

}  // namespace pliant
