// A flat, round punch bonded to the top of a block whose bottom is bonded. The engine's tetrahedra on a grid refined at
// the punch's rim, where the stress is singular. Frame: the origin is the punch's centre, the block lies below y = 0.
//
// Grids of all sizes follow the same curves, so that errors decrease uniformly and the limit can be extrapolated.
#pragma once

#include <functional>
#include <vector>

#include "components/tet_mesh.h"
#include "runtime/result.h"
#include "systems/soft/fem/tissue.h"

namespace pliant {

struct BlockPress {
  double young = 10e3, poisson = 0.45;  // [Pa] [1]
  double radius = 0.005;                // [m] of the punch
  double thickness = 0.025;             // [m] of the block
  double half_width = 0.06;             // [m]
  int cells = 4;                        // per punch radius
  Strain strain = Strain::kLinear;      // small strains, or co-rotational iterated to convergence
};

struct PressedBlock {
  double depth = 0.0;          // [m]
  double force = 0.0;          // [N] on the punch
  std::vector<double> radius;  // [m] of the top's rings, ascending from 0
  std::vector<double> share;   // [1] deflection over the depth, mean over the ring's nodes
  std::size_t tets = 0;
  double ms = 0.0;  // CPU time of assembly, factorisation and solution, without the analysis
  int solves = 1;   // number of solves, each with a factorisation
};

// With small strains the result is linear in `depth`.
Result<PressedBlock> press_block(const BlockPress& press, double depth);
// A sequence of depths [m], each starting from the previous solution. `goes_on` is called before each with the
// completed share; if it returns false the function ends with an error.
Result<std::vector<PressedBlock>> press_block(
    const BlockPress& press, const std::vector<double>& depths,
    const std::function<bool(double)>& goes_on = [](double) { return true; });

// Richardson extrapolation: value = limit + c cells^-order through the last three values.
struct GridLimit {
  double limit = 0.0;
  double order = 0.0;    // [1] NaN: the values do not converge; the limit is then the last value
  double to_come = 0.0;  // [1] of the last change: limit = last + to_come (last - previous)
};
GridLimit grid_limit(const std::vector<int>& cells, const std::vector<double>& values);

}  // namespace pliant
