// The result of a fit to finite elements: `pliant fit LEVEL --object NAME` fills, prints, writes and draws it.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "content/author/object_frame.h"
#include "content/level/level.h"
#include "lab/fit/surface_fit.h"
#include "plot/pen.h"

namespace pliant {

// Result at a place that was not used in the fit.
struct HeldPlace {
  PressedPlace truth;
  Side side = Side::kTop;
  std::vector<PressedTissue> model;             // at the same depths
  double force_error = 0.0, force_worst = 0.0;  // [1] RMS and largest of the relative differences
  double surface_error = 0.0;                   // [1] RMS difference over RMS of the dent, at the greatest depth
  double surface_of_depth = 0.0;                // [1] RMS difference over the depth
  double not_radial = 0.0;                      // [1] non-radial part of the dent, over the depth
  bool near_edge = false;                       // of the object
};

struct TissueFit {
  std::string object;
  double radius = 0.0, cell = 0.0, young = 0.0, poisson = 0.0;
  std::string why;             // reason for the choice of radius
  double deepest = 0.0;        // [m] deepest press: a quarter of the reach, at most of the usual reach
  double too_stiff = 1.0;      // [1] stiffness of the elements over the limit of vanishing cell size
  double too_stiff_off = 0.0;  // [1] RMS deviation of single places from that ratio
  std::size_t tets = 0;        // median over the bodies
  std::size_t mapped = 0, places = 0, left_out = 0;
  ShapeFit shape;
  ForceFit force;
  DeformableParameters surface;
  bool linear = false;                   // small strains
  double softest = 0.0, stiffest = 0.0;  // [N/m] range of the map
  std::vector<HeldPlace> held;
};

struct PlaceErrors {
  double force = 0.0, worst = 0.0, surface = 0.0, of_depth = 0.0, not_radial = 0.0;
  std::size_t count = 0;
  void add(const HeldPlace& h) {
    force += h.force_error * h.force_error;
    worst = std::max(worst, h.force_worst);
    surface += h.surface_error * h.surface_error;
    of_depth += h.surface_of_depth * h.surface_of_depth;
    not_radial += h.not_radial * h.not_radial;
    ++count;
  }
  double rms(double sum) const { return count ? std::sqrt(sum / static_cast<double>(count)) : 0.0; }
};

// By region: "all", the side that the surface faces there, and, if some places lie near an edge, the others as "inner".
std::map<std::string, PlaceErrors> sums_of(const TissueFit& fitted);
std::string verdict_of(const TissueFit& fitted);

std::string places_csv(const TissueFit& fitted);
std::string json_of(const TissueFit& fitted, const Level& level);
void draw(Pen& pen, const TissueFit& fitted);
void say(const TissueFit& fitted);

}  // namespace pliant
