// The legs of a path along surfaces: between two keys, along the surface or through the air.
#pragma once

#include <cmath>
#include <vector>

#include "editor/document/surface_path.h"

namespace pliant {

struct PathNode {
  dvec3 place, out;  // [m] world, on the surface; [1] away from it
};
struct PathLeg {
  std::vector<PathNode> nodes;
  std::vector<double> way;          // [m] arc length of the tip centre's path at each node
  const PathSurface* on = nullptr;  // null: through the air
  double spacing = 0.0;             // [m]
};
class LegMaker {
 public:
  LegMaker(const ScriptKeys& script, const std::vector<PathSurface>& surfaces);

  PathLeg leg(const PathKey& a, const PathKey& b) const;

  double stands_off(double height) const { return height + script_.tip.radius; }

  // [m] Search distance for surfaces: for a point on a surface its offset suffices; in the air it is unlimited.
  double reach(double off, bool on_surface) const { return on_surface ? std::abs(off) + tolerance_ : size_; }
  // The tip's centre at its offset from a surface point, moved away from any surface that is nearer.
  dvec3 lifted(const PathNode& node, double off, bool on_surface) const;
  double tolerance() const { return tolerance_; }  // [m]

 private:
  const PathSurface* under(const PathKey& key, SurfaceHit& hit) const;
  PathLeg along(const PathSurface& on, const PathKey& a, const PathKey& b, const SurfaceHit& from,
                const SurfaceHit& to) const;
  PathLeg through_air(const PathKey& a, const PathKey& b) const;

  const ScriptKeys& script_;
  const std::vector<PathSurface>& surfaces_;
  double tolerance_, size_ = 0.0;  // [m]; the largest surface's diagonal
};

// 1: both legs are collinear where they meet; 0: the direction changes, and the tip stops there.
double straight_on(const PathLeg& before, const PathLeg& after);

}  // namespace pliant
