// Which surface a probe feels on a mesh: flat facets, force shading, P1's interpolated contact vertex, curved patches,
// each against the smooth surface that the mesh stands for.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/mesh.h"
#include "lab/study/pareto.h"

namespace pliant {

// A surface with a closed form, a mesh of about so many triangles of it, and a loop on it, once around for s in [0, 1].
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

// Of a loop at a depth of 3 mm, behind the true surface, and of one at depths from 1 to 5 mm.
struct FeltErrors {
  double ripple = 0.0;     // [1] of the force's size, from least to most, over the true one
  double direction = 0.0;  // [degree] RMS angle to the true force
  double turned = 0.0;     // [degree] the largest
  double work = 0.0;       // [1] that a closed loop gives out or takes, over the energy stored at its deepest
  double floor = 0.0;      // [1] how much that still changed when its samples were doubled: less is not resolved
  double us = 0.0;         // a query that follows the probe, processor time
};
// Ripple and direction from `samples` places; the work from twice as many again and again, until it no longer changes
// or they are kMostWork times as many.
inline constexpr int kMostWork = 16;
FeltErrors feel(const Mesh& mesh, const SmoothSurface& surface, FeltSurface felt, int samples);

}  // namespace pliant
