// Shape functions against truth: which surface a press gives, and at what cost. Truths are the closed forms of a flat
// punch and of a sphere on a half-space, and blocks of the engine's own tetrahedra, finite and bonded below.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/deformable.h"
#include "lab/study/block_press.h"
#include "lab/study/pareto.h"

namespace pliant {

// What a press should look like: the share of the depth at distance r [m] from its middle.
struct PressTruth {
  std::string name;
  double inner = 0.005;  // [m] radius of the contact
  std::function<double(double)> share;
};
PressTruth punch_truth(double radius);
PressTruth hertz_truth(double contact_radius);
PressTruth block_truth(const std::string& name, double radius, const PressedBlock& block);
// Where the surfaces of ever finer grids go, as their force does.
PressTruth limit_truth(const PressTruth& coarser, const PressTruth& finest, const GridLimit& force);

// The engine's shape with its reach [m] around a contact of this radius [m].
std::function<double(double)> engine_share(Shape shape, double inner, double reach);

// Within five radii of the middle, weighted by area. [1]
struct ShapeError {
  double profile = 0.0;  // RMS of the difference, over the RMS of the truth
  double volume = 0.0;   // the shape's volume over the truth's, less one
};
ShapeError shape_error(const std::function<double(double)>& share, const PressTruth& truth);
// The least reach whose profile error is no larger than any other's, but for a thousandth of it. [m]
double best_reach(Shape shape, const PressTruth& truth);

const char* name_of(Shape shape);

}  // namespace pliant
