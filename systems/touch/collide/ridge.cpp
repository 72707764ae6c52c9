#include "systems/touch/collide/ridge.h"

#include "systems/touch/collide/section.h"

namespace pliant {

Ridge ridge_between(const Mesh& mesh, const FootBlend& a, const FootBlend& b, dvec3 x, double radius) {
  const Foot &from = a.main(), &to = b.main();
  const double most = std::min(radius - a.height, radius - b.height);
  if (from.triangle == to.triangle) return {most, a.height > b.height ? -a.gradient : -b.gradient};
  const dvec3 p = inside_triangle(mesh, from.triangle, from.barycentric),
              q = inside_triangle(mesh, to.triangle, to.barycentric), way = q - p;
  const uvec3 t = mesh.triangles[from.triangle];
  const dvec3 corner(mesh.position(t.x)),
      outward = cross(dvec3(mesh.position(t.y)) - corner, dvec3(mesh.position(t.z)) - corner);
  dvec3 across = cross(way, x - p);
  const double sense = dot(cross(across, outward), way) > 0 ? 1.0 : -1.0;
  across *= sense;
  double farthest = -1.0;
  SectionEdge highest{};
  if (!walk_section(mesh, from.triangle, to.triangle, p, across, [&](const SectionEdge& at) {
        const double far = length(at.p - x);
        if (far > farthest) {
          farthest = far;
          highest = at;
        }
        return far < radius;
      }))
    return {};
  Ridge ridge{radius - farthest, dvec3(0)};
  if (ridge.depth >= most) return {most, a.height > b.height ? -a.gradient : -b.gradient};
  // The crossing v + share (w - v) moves with the plane: share = s_v / (s_v - s_w), s = (v - p) . across.
  const uvec3 c = mesh.triangles[highest.triangle];
  const dvec3 v(mesh.position(c[highest.edge])), w(mesh.position(c[(highest.edge + 1) % 3]));
  const double sv = dot(v - p, across), sw = dot(w - p, across);
  const dvec3 outwards = (x - highest.p) / farthest;
  for (int k = 0; k < 3; ++k) {
    dvec3 dx(0);
    dx[k] = 1;
    const dvec3 dp = a.moves * dx, dq = b.moves * dx;
    const dvec3 turned = sense * (cross(dq - dp, x - p) + cross(way, dx - dp));
    const double dv = -dot(dp, across) + dot(v - p, turned), dw = -dot(dp, across) + dot(w - p, turned);
    const double share = (sv * dw - sw * dv) / ((sv - sw) * (sv - sw));
    ridge.slope[k] = -dot(outwards, dx - share * (w - v));
  }
  return ridge;
}

}  // namespace pliant
