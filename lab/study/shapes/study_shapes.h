// Shape functions against reference surfaces: accuracy and cost. References are the closed forms of a flat punch and of
// a sphere on a half-space, and finite tetrahedral blocks bonded at their bottom.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/deformable.h"
#include "lab/study/pareto.h"
#include "lab/study/shapes/block_press.h"

namespace pliant {

// Reference surface of a press: the share of the depth at distance r [m] from its centre.
struct PressTruth {
  std::string name;
  double inner = 0.005;  // [m] radius of the contact
  std::function<double(double)> share;
};
PressTruth punch_truth(double radius);
PressTruth hertz_truth(double contact_radius);
PressTruth block_truth(const std::string& name, double radius, const PressedBlock& block);
// Surface of the limit of finer grids, extrapolated like their force.
PressTruth limit_truth(const PressTruth& coarser, const PressTruth& finest, const GridLimit& force);

// The engine's shape function with reach [m] around a contact of radius `inner` [m].
std::function<double(double)> engine_share(Shape shape, double inner, double reach);

// Within five radii of the centre, weighted by area. [1]
struct ShapeError {
  double profile = 0.0;  // RMS difference over the RMS of the reference
  double volume = 0.0;   // the shape's volume over the reference's, minus one
};
ShapeError shape_error(const std::function<double(double)>& share, const PressTruth& truth);
// [m] The smallest reach whose profile error is within a thousandth of the minimum.
double best_reach(Shape shape, const PressTruth& truth);

const char* name_of(Shape shape);

}  // namespace pliant
