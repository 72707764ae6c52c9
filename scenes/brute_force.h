// Contact vertex and closest point of a mesh without a tree: the reference for searches.
#pragma once

#include <algorithm>
#include <vector>

#include "systems/touch/collide/virtual_vertex.h"

namespace pliant {

// Visits every triangle; only those with a bounding sphere that is too far are skipped.
class BruteForce {
 public:
  explicit BruteForce(const Mesh& mesh) : mesh_(mesh) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Corner3 c = corners(mesh, t);
      const dvec3 center = (c.p[0] + c.p[1] + c.p[2]) / 3.0;
      centers_.push_back(center);
      radii_.push_back(1.000001 *
                       std::max({length(c.p[0] - center), length(c.p[1] - center), length(c.p[2] - center)}));
    }
  }
  SurfaceFoot closest(dvec3 x, double within) const {
    SurfaceFoot closest;
    double best = within;
    each_near(x, best, [&](std::uint32_t t) {
      const SurfaceFoot p = closest_point(mesh_, t, x);
      if (p.distance() <= best && (!closest.valid() || p.distance() < closest.distance()))
        closest = p, best = p.distance();
    });
    return closest;
  }
  SurfaceFoot nearest(dvec3 x, double within) const {
    const SurfaceFoot closest = this->closest(x, within);
    SurfaceFoot vertex;
    if (!closest.valid()) return closest;
    double best = std::min(within, 2 * closest.distance());
    each_near(x, best, [&](std::uint32_t t) {
      const SurfaceFoot p = virtual_vertex(mesh_, t, x);
      if (p.valid() && p.distance() <= best && (!vertex.valid() || p.distance() < vertex.distance()))
        vertex = p, best = p.distance();
    });
    return vertex.valid() ? vertex : closest;
  }

 private:
  template <class Visit>
  void each_near(dvec3 x, const double& bound, Visit visit) const {
    for (std::uint32_t t = 0; t < centers_.size(); ++t) {
      const double reach = bound + radii_[t];
      const dvec3 d = x - centers_[t];
      if (dot(d, d) <= reach * reach) visit(t);
    }
  }
  const Mesh& mesh_;
  std::vector<dvec3> centers_;
  std::vector<double> radii_;
};

}  // namespace pliant
