// A flat, round punch bonded to the top of a block that is bonded below: the engine's own tetrahedra on a grid that is
// fine at the punch's rim, where stress is singular. Frame: the punch's middle at the origin, the block below y = 0.
//
// Grids of more cells follow the same curves, so that errors fall evenly and the limit can be extrapolated.
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
  int cells = 4;                        // over the punch's radius
  Strain strain = Strain::kLinear;      // small strains; corotational ones are settled to the end
};

struct PressedBlock {
  double depth = 0.0;          // [m]
  double force = 0.0;          // [N] that holds the punch down
  std::vector<double> radius;  // [m] of the top's rings, ascending from 0
  std::vector<double> share;   // [1] of the depth that the surface gives way there, mean over the ring's nodes
  std::size_t tets = 0;
  double ms = 0.0;  // processor time of assembly, factorisation and solution; the analysis is not in it
  int solves = 1;   // of them, each with a factorisation
};

// With small strains the answer is linear in `depth`.
Result<PressedBlock> press_block(const BlockPress& press, double depth);
// One after the other [m], each from where the last one ended. Ends with an error where `goes_on`, asked before each
// with the share that is done, says no.
Result<std::vector<PressedBlock>> press_block(
    const BlockPress& press, const std::vector<double>& depths,
    const std::function<bool(double)>& goes_on = [](double) { return true; });

// Richardson's extrapolation: value = limit + c cells^-order through the last three.
struct GridLimit {
  double limit = 0.0;
  double order = 0.0;    // [1] not a number: the values do not tend to one; then the limit is the last
  double to_come = 0.0;  // [1] of the last change: limit = last + to_come (last - the one before)
};
GridLimit grid_limit(const std::vector<int>& cells, const std::vector<double>& values);

}  // namespace pliant
