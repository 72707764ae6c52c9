// Polylines between two points of a surface.
#pragma once

#include <vector>

#include "editor/paint/paint_surface.h"

namespace pliant {

// The shortest path along mesh edges; A* (Hart, Nilsson and Raphael 1968).
std::vector<dvec3> over_edges(const PaintSurface& surface, const SurfaceHit& from, const SurfaceHit& to);

// The line with `steps` pieces of equal length.
std::vector<dvec3> resampled(const std::vector<dvec3>& line, int steps);

}  // namespace pliant
