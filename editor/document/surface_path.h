// The motion of a device between the keys of a path along a surface, as rows of poses.
//
// Between two keys, the path is a short curve along the surface (Dijkstra over its edges, then tightened on it). The
// centre of the tip's sphere is offset by its radius and the interpolated height of the keys. Where another part of the
// surface is nearer, as in a cleft, the path moves outwards. So the tip is nowhere deeper in a surface than its keys,
// within the tolerance: not around corners, not on the far side. Between disconnected surfaces the path goes through
// the air, over obstacles.
#pragma once

#include <memory>
#include <vector>

#include "editor/document/script_keys.h"
#include "editor/paint/paint_surface.h"

namespace pliant {

// A surface with keys, or an obstacle, and the origin of its frame.
struct PathSurface {
  std::shared_ptr<const PaintSurface> surface;
  dvec3 origin{0};  // [m] world
};

// [m] Distance of the point outside of the nearest surface; < 0: inside. At most `within`.
double distance_outside(const std::vector<PathSurface>& surfaces, dvec3 point, double within);

// [m] How much deeper than its keys a path may be anywhere, including between rows.
double path_tolerance(const std::vector<PathSurface>& surfaces);

std::vector<PathRow> rows_along(const ScriptKeys& script, const std::vector<PathSurface>& surfaces);

}  // namespace pliant
