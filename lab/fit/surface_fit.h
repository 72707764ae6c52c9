// Keys of a deformable surface (P1) from presses into its tissue: a law, a stiffness map, and the shape and reach of
// its dents.
#pragma once

#include <string>
#include <vector>

#include "components/deformable.h"
#include "lab/fit/tissue_press.h"

namespace pliant {

// One place with its presses in ascending depth.
struct PressedPlace {
  PressPlace place;
  double stiffness = 0.0;          // [N/m] of a small press
  std::vector<PlacedSample> seen;  // sample points of the presses' heights
  std::vector<PressedTissue> presses;
};

struct ShapeFit {
  Shape shape = Shape::kVolume;
  double reach = 0.0;     // [m]
  double volume = 1.0;    // [1]
  double contact = 0.0;   // [m] contact_radius; 0: the shape has none
  double error = 0.0;     // [1] RMS difference over RMS of the dents, by area, within kAroundPress radii
  double of_depth = 0.0;  // [1] the same difference over the depth
};
inline constexpr double kAroundPress = 3.0;  // [1] radii of the indenter within which dents are compared

// Difference between two sets of heights at the same points, and the norm of the second: squares times area.
struct SurfaceDifference {
  double off = 0.0, size = 0.0;  // [m4]
  double area = 0.0;             // [m2]
};
SurfaceDifference surface_difference(const std::vector<PlacedSample>& seen, const std::vector<double>& heights,
                                     const std::vector<double>& truth);

// Residual of a dent after subtracting its best radial fit: a continuous function of the distance, linear between knots
// a quarter of the indenter's radius apart.
SurfaceDifference radial_remainder(const std::vector<PlacedSample>& seen, const PressPlace& place, double radius,
                                   const std::vector<double>& heights);
// True if at this press depth [m] another side of the object is within 1.5 depths: a probe there is equally deep below
// that side.
bool is_near_an_edge(const Mesh& mesh, const PressPlace& place, double depth);

// `reach`: the requested one, or 0 to fit it. Finite elements are valid up to presses of a quarter of 3.5 radii. A
// larger reach, up to kWidestReach, is taken only if dents are much wider.
inline constexpr double kUsualReach = 3.5, kWidestReach = 10.0;  // [1] radii of the indenter
ShapeFit fit_shape(const std::vector<PressedPlace>& places, double radius, double reach);

struct ForceFit {
  SpringLaw spring = SpringLaw::kLinear;
  double factor = 1.0;     // [1] factor on the stiffness of a small press
  double curvature = 0.0;  // stiffening [1/m], or cubic over stiffness [1/m2]
  double error = 0.0;      // [1] RMS of the relative errors
};
ForceFit fit_force(const std::vector<PressedPlace>& places);

// Random places on the surface, uniform by area, for this seed; none where `allowed` is 0.
std::vector<PressPlace> scatter(const Mesh& mesh, std::size_t count, std::uint64_t seed,
                                const std::vector<std::uint8_t>& allowed);
// Farthest-point sampling of `count` vertices; the first is vertex 0.
std::vector<std::uint32_t> farthest_vertices(const Mesh& mesh, std::size_t count);
// Interpolates positive values from some places to every vertex: moving least squares of the logarithms of the nearest
// places, those that face the same way first.
std::vector<double> spread(const Mesh& mesh, const std::vector<PressPlace>& at, const std::vector<double>& value);

}  // namespace pliant
