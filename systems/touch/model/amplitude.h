// Amplitude of each contact's field, such that the surface is at every probe's depth (methods.md 1.3). Fields overlap,
// so the amplitudes solve a small linear complementarity problem
//   A alpha >= d,  alpha >= 0,  alpha . (A alpha - d) = 0,    A_ij = share of contact j's field at contact i.
#pragma once

#include <cstdint>
#include <span>

namespace pliant {

// Projected Gauss-Seidel, row-major A of n x n with positive diagonal; alpha is the warm start on entry and the
// solution on return [m]. Returns the largest violation of the complementarity [m]. Coincident probes (equal rows)
// converge to one of the equivalent solutions.
double solve_amplitudes(std::span<const double> A, std::span<const double> d, std::span<double> alpha);

}  // namespace pliant
