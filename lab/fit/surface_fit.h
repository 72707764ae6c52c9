// Keys of a deformable surface (P1) from presses into its tissue: a law and a map of its stiffness, and the shape and
// reach of its dents.
#pragma once

#include <string>
#include <vector>

#include "components/deformable.h"
#include "lab/fit/tissue_press.h"

namespace pliant {

// One place with its presses, the deepest last.
struct PressedPlace {
  PressPlace place;
  double stiffness = 0.0;           // [N/m] of a small press
  std::vector<SurfaceSample> seen;  // what the heights of the presses are of
  std::vector<PressedTissue> presses;
};

struct ShapeFit {
  Shape shape = Shape::kVolume;
  double reach = 0.0;     // [m]
  double volume = 1.0;    // [1]
  double contact = 0.0;   // [m] contact_radius; 0: the shape has none
  double error = 0.0;     // [1] RMS difference over RMS of the dents, by area, within kAroundPress radii, all depths
  double of_depth = 0.0;  // [1] ... over the depth
};
inline constexpr double kAroundPress = 3.0;  // [1] radii of the indenter that a dent is compared within

// Difference of two sets of heights of the same points, and the size of the second: squares times area.
struct SurfaceDifference {
  double off = 0.0, size = 0.0;  // [m4]
  double area = 0.0;             // [m2]
};
SurfaceDifference surface_difference(const std::vector<SurfaceSample>& seen, const std::vector<double>& heights,
                                     const std::vector<double>& truth);

// What of a dent the best function of the distance from its place leaves: a continuous one, straight between distances
// a quarter of the indenter's radius apart.
SurfaceDifference radial_remainder(const std::vector<SurfaceSample>& seen, const PressPlace& place, double radius,
                                   const std::vector<double>& heights);
// Whether, at the end of a press of this depth [m], another side of the object is within 1.5 depths: a probe there is
// as much inside of that.
bool is_near_an_edge(const Mesh& mesh, const PressPlace& place, double depth);

// `reach`: 0, or the one that is wanted. A quarter of 3.5 radii is the deepest press that elements follow; only where
// dents are much wider than such a reach it is larger, up to kWidestReach.
inline constexpr double kUsualReach = 3.5, kWidestReach = 10.0;  // [1] radii of the indenter
ShapeFit fit_shape(const std::vector<PressedPlace>& places, double radius, double reach);

struct ForceFit {
  SpringLaw spring = SpringLaw::kLinear;
  double factor = 1.0;     // [1] on the stiffness of a small press
  double curvature = 0.0;  // stiffening [1/m], or cubic over stiffness [1/m2]
  double error = 0.0;      // [1] RMS of relative errors
};
ForceFit fit_force(const std::vector<PressedPlace>& places);

// Places all over the surface, by area and this seed; none where `allowed` says no.
std::vector<PressPlace> scatter(const Mesh& mesh, std::size_t count, std::uint64_t seed,
                                const std::vector<std::uint8_t>& allowed);
// Vertices that lie as far from each other as so many can, the first being 0.
std::vector<std::uint32_t> farthest_vertices(const Mesh& mesh, std::size_t count);
// A value > 0 of each vertex from those of some places: moving least squares through the logarithms of the nearest
// ones, those that face the same way first.
std::vector<double> spread(const Mesh& mesh, const std::vector<PressPlace>& at, const std::vector<double>& value);

}  // namespace pliant
