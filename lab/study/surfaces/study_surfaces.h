// Felt surfaces on a mesh: flat facets, force shading, P1's interpolated contact vertex, and curved patches, each
// against the smooth surface that the mesh approximates.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/mesh.h"
#include "lab/study/pareto.h"

namespace pliant {

// A surface with a closed form, a generator of meshes with about a given number of triangles, and a closed loop on it
// for s in [0, 1].
struct SmoothSurface {
  struct Point {
    dvec3 p{0}, n{0, 1, 0};  // [m], [1] outward
  };
  std::string name;
  std::function<Mesh(int triangles)> mesh;
  std::function<Point(double s)> loop;
};
SmoothSurface smooth_sphere();
SmoothSurface smooth_torus();
SmoothSurface smooth_saddle();

enum class FeltSurface : std::uint8_t { kFacets, kShading, kVirtualVertex, kPatches };
inline constexpr FeltSurface kFeltSurfaces[] = {FeltSurface::kFacets, FeltSurface::kShading,
                                                FeltSurface::kVirtualVertex, FeltSurface::kPatches};
const char* name_of(FeltSurface felt);

// On a loop at a depth of 3 mm behind the true surface, and on one at depths from 1 to 5 mm.
struct FeltErrors {
  double ripple = 0.0;     // [1] range of the force magnitude over the true one
  double direction = 0.0;  // [degree] RMS angle to the true force
  double turned = 0.0;     // [degree] largest angle
  double work = 0.0;       // [1] net work over a closed loop, over the energy stored at its deepest
  double floor = 0.0;      // [1] change of the work when the samples were last doubled: the resolution
  double us = 0.0;         // CPU time of a query that follows the probe
};
// Ripple and direction from `samples` places. For the work the samples are doubled until it converges or they are
// kMostWork times as many.
inline constexpr int kMostWork = 16;
FeltErrors feel(const Mesh& mesh, const SmoothSurface& surface, FeltSurface felt, int samples);

}  // namespace pliant
