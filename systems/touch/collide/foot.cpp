#include "systems/touch/collide/foot.h"

#include <algorithm>
#include <cmath>

#include "components/curved_patch.h"
#include "systems/touch/collide/around_vertex.h"

namespace pliant {
namespace {

constexpr int kMostSteps = 40;     // of Newton on one patch
constexpr int kMostPatches = 512;  // on the way downhill
constexpr double kOnEdge = 1e-12;  // [1] a barycentric below this is zero
constexpr double kBetter = 1e-13;  // [1] relative decrease of the distance squared required for the foot to move on
constexpr double kFree =
    5e-7;  // [1] x - p deviates less than this from the normal: no constraint at the foot. Above sqrt(kBetter)
// Patches that meet at less than this angle are one smooth surface: a foot that halts on their edge for a moment has
// the derivatives of a foot inside. Otherwise the force of painted and of relaxing tissue would click there. [rad]
constexpr double kSmooth = 0.005;
// Near a focal distance the edge alone holds such a foot: from here on it has the derivatives of a foot on an edge.
constexpr double kHolds = 0.25;      // [1] det of the distance's second derivatives, of a flat patch's
constexpr double kMostMoves = 20.0;  // [1] most of dp/dx
constexpr double kOnSurface = 1e-9;  // [1] of the triangle's edge: closer than this, x is on the surface

struct Place {
  double u = 0.0, v = 0.0;
  double w() const { return 1 - u - v; }
};

// Bit i is set if barycentric i is zero.
unsigned zeros(Place at) {
  return (at.w() <= kOnEdge ? 1u : 0u) | (at.u <= kOnEdge ? 2u : 0u) | (at.v <= kOnEdge ? 4u : 0u);
}

// Largest fraction of a step (du, dv) that stays in the triangle, at most 1.
double room(Place at, double du, double dv) {
  double t = 1.0;
  const double dw = -du - dv;
  if (dw < 0) t = std::min(t, std::max(0.0, at.w()) / -dw);
  if (du < 0) t = std::min(t, std::max(0.0, at.u) / -du);
  if (dv < 0) t = std::min(t, std::max(0.0, at.v) / -dv);
  return t;
}

// Whether a fraction t of a step (du, dv) is negligible: t is about zero, and the remaining step is shorter than the
// tolerance of being on an edge. With t alone, a foot just beside a corner would be stuck.
bool nowhere(double du, double dv, double t) {
  return t < 1e-9 && t * std::max({std::abs(du), std::abs(dv), std::abs(du + dv)}) <= kOnEdge;
}

Place moved(Place at, double du, double dv, double t) {
  Place to{at.u + t * du, at.v + t * dv};
  // Snapped to the edge, so that the next step detects it.
  if (to.u < kOnEdge) to.u = 0.0;
  if (to.v < kOnEdge) to.v = 0.0;
  if (to.w() < kOnEdge) {
    const double sum = to.u + to.v;
    to.u /= sum;
    to.v = 1.0 - to.u;
  }
  return to;
}

// The direction along the edge on which barycentric i is zero, from its first corner to its second.
struct Along {
  double du, dv;
};
constexpr Along kAlong[3] = {{-1, 1}, {0, -1}, {1, 0}};  // corners 1 to 2, 2 to 0, 0 to 1

struct Hessian {
  double uu, uv, vv;
  double det() const { return uu * vv - uv * uv; }
};

// Of half the distance squared; its Gauss-Newton part where the full one has no minimum (beyond a focal distance).
Hessian hessian(const CurvedPatch::Point& at, dvec3 r, bool full) {
  Hessian h{dot(at.pu, at.pu), dot(at.pu, at.pv), dot(at.pv, at.pv)};
  if (full) {
    h.uu += dot(r, at.puu);
    h.uv += dot(r, at.puv);
    h.vv += dot(r, at.pvv);
  }
  return h;
}

double half_square(dvec3 r) {
  return 0.5 * dot(r, r);
}

// Minimum of the distance over one patch, by descent from a place on it.
Place minimise(const CurvedPatch& patch, Place at, dvec3 x) {
  CurvedPatch::Point here = patch.at(at.u, at.v);
  double f = half_square(here.p - x);
  for (int step = 0; step < kMostSteps; ++step) {
    const dvec3 r = here.p - x;
    const double gu = dot(r, here.pu), gv = dot(r, here.pv);
    Hessian H = hessian(here, r, true);
    const Hessian first = hessian(here, r, false);
    const bool full = H.uu > 0 && H.det() > 1e-6 * first.det();
    if (!full) H = first;
    double du = 0.0, dv = 0.0;
    if (const double det = H.det(); det > 0) {
      du = -(H.vv * gu - H.uv * gv) / det;
      dv = -(H.uu * gv - H.uv * gu) / det;
    }
    double t = room(at, du, dv);
    if (nowhere(du, dv, t)) {  // the step leaves the triangle: follow the edge of steepest descent instead
      double best = 0.0;
      const unsigned on = zeros(at);
      for (int i = 0; i < 3; ++i) {
        if (!(on >> i & 1)) continue;
        const auto [eu, ev] = kAlong[i];
        const double slope = gu * eu + gv * ev;
        double bend = H.uu * eu * eu + 2 * H.uv * eu * ev + H.vv * ev * ev;
        if (!(bend > 0)) bend = first.uu * eu * eu + 2 * first.uv * eu * ev + first.vv * ev * ev;
        if (!(bend > 0)) continue;
        const double s = -slope / bend, open = room(at, s * eu, s * ev);
        const double gain = slope * slope / bend * open;
        if (nowhere(s * eu, s * ev, open) || gain <= best) continue;
        best = gain;
        du = s * eu;
        dv = s * ev;
        t = open;
      }
      if (best == 0.0) break;  // no edge descends
    }
    const double size = length(du * here.pu + dv * here.pv);
    Place next;
    CurvedPatch::Point there;
    double g = f;
    for (int halving = 0; halving < 24; ++halving, t *= 0.5) {
      next = moved(at, du, dv, t);
      there = patch.at(next.u, next.v);
      g = half_square(there.p - x);
      if (g <= f) break;
    }
    if (g > f) break;
    // A full Newton step leaves an error of the order of its square.
    const double small = full && t == 1.0 ? 1e-7 : 1e-12;
    const bool still = t * size < small * (length(here.pu) + length(here.pv));
    at = next;
    here = there;
    f = g;
    if (still || (patch.flat && t == 1.0 && zeros(at) == 0)) break;
  }
  return at;
}

struct Local {
  CurvedPatch patch;
  Place at;
  double f = 0.0;
};

Local local_minimum(const Mesh& mesh, std::uint32_t triangle, Place from, dvec3 x) {
  Local local;
  local.patch = curved_patch(mesh, triangle);
  local.at = minimise(local.patch, from, x);
  local.f = half_square(local.patch.at(local.at.u, local.at.v).p - x);
  return local;
}

Place at_corner(int corner) {
  return {corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0};
}

// The same point of a shared edge, in the triangle on its other side. `share`: weight of the edge's second corner.
Place across_edge(const Mesh& mesh, std::uint32_t from, int edge, std::uint32_t to, double share) {
  const uvec3 t = mesh.triangles[to];
  const int i = corner_of(t, mesh.triangles[from][edge]), j = corner_of(t, mesh.triangles[from][(edge + 1) % 3]);
  const auto weight = [&](int corner) { return (corner == i ? 1 - share : 0.0) + (corner == j ? share : 0.0); };
  return {weight(1), weight(2)};
}

dvec3 patch_normal(const CurvedPatch::Point& at) {
  const dvec3 n = cross(at.pu, at.pv);
  const double size = length(n);
  return size > 0 ? n / size : dvec3(0);
}

// [rad] Angle of a patch at one of its corners. The sum of normals around a vertex is weighted by it: it tells inside
// from outside where a sum without weights does not (Baerentzen & Aanaes 2005).
double corner_angle(const CurvedPatch::Point& at, int corner) {
  const dvec3 a = corner == 0 ? at.pu : corner == 1 ? at.pv - at.pu : -at.pv;
  const dvec3 b = corner == 0 ? at.pv : corner == 1 ? -at.pu : at.pu - at.pv;
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// Where a minimum is about to end, its place moves infinitely fast; nothing may follow from that.
void bound_motion(Foot& foot) {
  double size = 0.0;
  for (int i = 0; i < 3; ++i) size += dot(foot.moves[i], foot.moves[i]);
  size = std::sqrt(size);
  if (!(size > kMostMoves)) return;
  foot.moves *= kMostMoves / size;
  foot.turns *= kMostMoves / size;
  for (dvec3& shift : foot.shifts) shift *= kMostMoves / size;
}

// Derivatives of a foot inside its patch. False: the distance bends by less than `least` of a flat patch's [1].
bool move_inside(Foot& foot, const CurvedPatch::Point& at, dvec3 r, double least = 0.0) {
  const Hessian H = hessian(at, -r, true);
  const double det = H.det();
  if (!(H.uu > 0 && det > least * hessian(at, -r, false).det())) return false;
  const dvec3 du = (H.vv * at.pu - H.uv * at.pv) / det, dv = (H.uu * at.pv - H.uv * at.pu) / det;
  foot.shifts = {-du - dv, du, dv};
  foot.moves = glm::outerProduct(at.pu, du) + glm::outerProduct(at.pv, dv);
  const double size = length(cross(at.pu, at.pv));
  const auto tangent = [&](dvec3 a) { return (a - dot(a, foot.normal) * foot.normal) / size; };
  const dvec3 nu = tangent(cross(at.puu, at.pv) + cross(at.pu, at.puv)),
              nv = tangent(cross(at.puv, at.pv) + cross(at.pu, at.pvv));
  foot.turns = glm::outerProduct(nu, du) + glm::outerProduct(nv, dv);
  return true;
}

// The corner of its triangle that a place on an edge is at, or -1.
int corner_at(Place at) {
  const unsigned on = zeros(at);
  return (on & (on - 1)) == 0 ? -1 : on == 6 ? 0 : on == 5 ? 1 : 2;
}

// Calls offer(triangle, place) for the other triangles at a place on an edge or a corner, without crossing an edge that
// may not be crossed. Returns whether there is one, or a border.
template <class Crosses, class Offer>
bool visit_beside(const Mesh& mesh, std::uint32_t triangle, Place at, Crosses crosses, Offer offer) {
  const int corner = corner_at(at);
  if (corner < 0) {
    const unsigned on = zeros(at);
    const int zero = on == 1 ? 0 : on == 2 ? 1 : 2, edge = (zero + 1) % 3;
    const std::uint32_t next = mesh.across[triangle][edge];
    if (next == kBorder || !crosses(triangle, edge)) return true;
    const double b[3] = {at.w(), at.u, at.v};
    offer(next, across_edge(mesh, triangle, edge, next, b[(edge + 1) % 3]));
    return false;
  }
  const std::uint32_t vertex = mesh.triangles[triangle][corner];
  bool at_border = false;
  around_vertex(mesh, vertex, triangle, crosses, [&](std::uint32_t t) {
    const int of = corner_of(mesh.triangles[t], vertex);
    if (t != triangle) offer(t, at_corner(of));
    for (const int edge : {of, (of + 2) % 3})
      at_border = at_border || mesh.across[t][edge] == kBorder || !crosses(t, edge);
  });
  return at_border;
}

// Sum of the normals of the patches that meet at a place on an edge or a corner.
template <class Crosses>
dvec3 sum_of_sides(const Mesh& mesh, const Local& local, std::uint32_t triangle, Crosses crosses) {
  const bool at_corner_too = corner_at(local.at) >= 0;
  const auto side = [&](const CurvedPatch& patch, Place at) {
    const CurvedPatch::Point point = patch.at(at.u, at.v);
    return (at_corner_too ? corner_angle(point, corner_at(at)) : 1.0) * patch_normal(point);
  };
  dvec3 sides = side(local.patch, local.at);
  visit_beside(mesh, triangle, local.at, crosses,
               [&](std::uint32_t t, Place at) { sides += side(curved_patch(mesh, t), at); });
  return sides;
}

// Completes a foot at the found place. `sides`: returns the sum of the normals of the patches that meet there.
template <class Sides>
Foot make_foot(const Local& local, std::uint32_t triangle, dvec3 x, Sides sides_of) {
  const auto [u, v] = local.at;
  const CurvedPatch::Point at = local.patch.at(u, v);
  Foot foot;
  foot.triangle = triangle;
  foot.barycentric = {1 - u - v, u, v};
  foot.p = at.p;
  const unsigned on = zeros(local.at);
  const dvec3 r = x - at.p;
  const double far = length(r), scale = length(at.pu) + length(at.pv);
  const dvec3 steepest(dot(r, at.pu) / length(at.pu), dot(r, at.pv) / length(at.pv), 0.0);
  const double aside = on == 0 ? 0.0 : length(steepest);
  // If the edge or corner is not an active constraint, the foot is treated as inside the patch.
  if (aside <= kFree * far) {
    foot.normal = patch_normal(at);
    foot.height = dot(r, foot.normal);
    move_inside(foot, at, r);
    bound_motion(foot);
    return foot;
  }
  foot.place = (on & (on - 1)) == 0 ? FootPlace::kEdge : FootPlace::kVertex;
  const dvec3 sides = sides_of(), mean = length(sides) > 0 ? normalize(sides) : patch_normal(at);
  const bool on_surface = far < kOnSurface * scale;
  const double side = dot(r, mean) < 0 ? -1.0 : 1.0;
  foot.normal = on_surface ? mean : side * r / far;
  foot.height = on_surface ? 0.0 : side * far;
  const int zero = on == 1 ? 0 : on == 2 ? 1 : 2;
  if (foot.place == FootPlace::kEdge) foot.edge = static_cast<std::uint8_t>((zero + 1) % 3);
  if (aside <= kSmooth * far && move_inside(foot, at, r, kHolds)) {
    bound_motion(foot);
    return foot;
  }
  if (foot.place == FootPlace::kEdge) {
    const auto [eu, ev] = kAlong[zero];
    const dvec3 along = eu * at.pu + ev * at.pv;
    const Hessian H = hessian(at, -r, true);
    const double bend = H.uu * eu * eu + 2 * H.uv * eu * ev + H.vv * ev * ev;
    if (bend > 0) {
      const dvec3 d = along / bend;
      foot.moves = glm::outerProduct(along, d);
      foot.shifts = {(-eu - ev) * d, eu * d, ev * d};
    }
  }
  if (!on_surface) {
    const dmat3 across = dmat3(1.0) - glm::outerProduct(foot.normal, foot.normal);
    foot.turns = across * (dmat3(1.0) - foot.moves) / foot.height;
  }
  bound_motion(foot);
  return foot;
}

}  // namespace

Foot descend(const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric, dvec3 x, bool over_creases,
             std::span<const std::uint32_t> closed) {
  Place from{barycentric.y, barycentric.z};
  if (!(from.u >= 0 && from.v >= 0 && from.w() >= 0))
    from = moved({1.0 / 3, 1.0 / 3}, from.u - 1.0 / 3, from.v - 1.0 / 3,
                 room({1.0 / 3, 1.0 / 3}, from.u - 1.0 / 3, from.v - 1.0 / 3));
  const auto crosses = [&](std::uint32_t t, int edge) {
    return (over_creases || !mesh.is_crease(t, edge)) &&
           (closed.empty() ||
            !std::binary_search(closed.begin(), closed.end(), 3 * t + static_cast<std::uint32_t>(edge)));
  };
  Local local = local_minimum(mesh, triangle, from, x);
  bool at_border = false;
  for (int patches = 0; patches < kMostPatches && zeros(local.at) != 0; ++patches) {
    Local best = local;
    std::uint32_t best_triangle = triangle;
    const double enough = local.f * (1 - kBetter);
    at_border = visit_beside(mesh, triangle, local.at, crosses, [&](std::uint32_t t, Place start) {
      const Local other = local_minimum(mesh, t, start, x);
      if (!(other.f < enough && other.f < best.f)) return;
      best = other;
      best_triangle = t;
    });
    if (best_triangle == triangle) break;
    local = best;
    triangle = best_triangle;
  }
  Foot foot = make_foot(local, triangle, x, [&] { return sum_of_sides(mesh, local, triangle, crosses); });
  foot.at_border = foot.place != FootPlace::kInside && at_border;
  return foot;
}

}  // namespace pliant
