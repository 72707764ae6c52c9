// A flat punch bonded to the top of a block that is bonded below: the engine's own tetrahedra on a grid that is fine
// under the punch. Frame: the punch's middle at the origin, the block below y = 0.
#pragma once

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
  double ms = 0.0;  // processor time of assembly, factorisation and solution
  int solves = 1;   // of them, each with a factorisation
};

// With small strains the answer is linear in `depth`.
Result<PressedBlock> press_block(const BlockPress& press, double depth);
// One after the other [m], each from where the last one ended.
Result<std::vector<PressedBlock>> press_block(const BlockPress& press, const std::vector<double>& depths);

}  // namespace pliant
