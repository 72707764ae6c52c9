// What a device does between the keys of a path that follows a surface: rows of its poses.
//
// The way from key to key is a short curve along the surface (Dijkstra over its edges, then pulled tight on it). The
// middle of the tip's sphere stands off it by the height that comes between the keys', and its radius; where the
// surface comes nearer than that from elsewhere, in a cleft, it gives way outwards. So the tip is nowhere deeper in the
// surface than its keys say, but for the tolerance: not around a corner, not on the far side, not on a way over it.
// Between surfaces that do not hang together it goes through the air, and over what is between them.
#pragma once

#include <memory>
#include <vector>

#include "editor/document/script_keys.h"
#include "editor/paint/paint_surface.h"

namespace pliant {

// A surface that keys are anchored on or that is in the way, and where its frame stands.
struct PathSurface {
  std::shared_ptr<const PaintSurface> surface;
  dvec3 origin{0};  // [m] world
};

// [m] How far the point is outside of the nearest surface; < 0: inside. Not looked for beyond `within`: that, then.
double distance_outside(const std::vector<PathSurface>& surfaces, dvec3 point, double within);

// [m] How much deeper than its keys say a path may be anywhere, rows and what is between them.
double path_tolerance(const std::vector<PathSurface>& surfaces);

std::vector<PathRow> rows_along(const ScriptKeys& script, const std::vector<PathSurface>& surfaces);

}  // namespace pliant
