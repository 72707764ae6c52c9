#include "systems/touch/collide/contact_place.h"

#include <algorithm>
#include <cmath>

#include "components/curved_patch.h"
#include "systems/touch/collide/around_vertex.h"
#include "systems/touch/collide/seams.h"
#include "systems/touch/collide/section.h"

namespace pliant {
namespace {

// Sides of a convex crease whose normals make a larger angle than this cosine's (145 degrees) are two faces of a thin
// part: pressing one does not open the other.
constexpr double kThin = -0.82;
// Distance of a crease from a point, in its depths, up to which its other side matters. For a wedge of 35 degrees, the
// sharpest that is not a thin part: tan a = sin 35 / (1.5 + cos 35) and 1 / sin a = 4.2.
constexpr double kCreaseReach = 4.2;
// Two feet closer than this are the same. [1] of the mean edge
constexpr double kSameContact = 1e-6;

// Convex creases of the mesh within `within` of x, as 3 * triangle + edge; each from both sides.
template <class Visit>
void visit_creases(const ObjectState& object, dvec3 x, double within, Visit visit) {
  Box around;
  around.add(vec3(x - dvec3(within)));
  around.add(vec3(x + dvec3(within)));
  object.crease_boxes.visit(around, [&](std::uint32_t i) {
    const std::uint32_t key = object.creases[i];
    if (!std::binary_search(object.closed.begin(), object.closed.end(), key))  // else another surface continues
      visit(key / 3, static_cast<int>(key % 3));
  });
}

// A crease that may matter, and the distance of its edge.
struct NearCrease {
  std::uint32_t triangle;
  int edge;
  double distance;
  dvec3 barycentric;  // of the edge's nearest point
  dvec3 normal;       // of the triangle
  double offset;      // [m] of its plane: normal . p
};
// Number of creases considered in a tick, one per flat side; on a rough surface the nearest ones.
constexpr std::size_t kMostCreases = 24;

// The nearest creases within `within` of x that have x behind their side by less than `farthest`. Returns the number of
// creases that are not on the far sheet of a thin part.
std::size_t nearest_creases(const ObjectState& object, const Mesh& mesh, const Foot& own, dvec3 x, double within,
                            double farthest, std::array<NearCrease, kMostCreases>& found, std::size_t& count) {
  const double bulge = static_cast<double>(mesh.tree.bulge), flat = 1e-5 * static_cast<double>(mesh.mean_edge);
  std::size_t met = 0;
  visit_creases(object, x, within, [&](std::uint32_t t, int edge) {
    const uvec3 corner = mesh.triangles[t];
    const dvec3 a(mesh.position(corner[edge])), e = dvec3(mesh.position(corner[(edge + 1) % 3])) - a;
    const dvec3 n = normalize(cross(e, dvec3(mesh.position(corner[(edge + 2) % 3])) - a));
    if (dot(n, own.normal) < kThin) return;  // another sheet's
    ++met;
    const double below = -dot(x - a, n), offset = dot(n, a);
    if (below > farthest + bulge || below < -bulge) return;
    const double s = std::clamp(dot(x - a, e) / dot(e, e), 0.0, 1.0), distance = length(x - a - s * e);
    std::size_t place = 0;
    while (place < count && !(dot(found[place].normal, n) > 1 - 1e-9 && std::abs(found[place].offset - offset) < flat))
      ++place;
    if (place == count) {
      place = count < kMostCreases ? count++ : kMostCreases;
      if (place == kMostCreases && !(distance < found[--place].distance)) return;
    } else if (!(distance < found[place].distance)) {
      return;
    }
    for (; place > 0 && found[place - 1].distance > distance; --place) found[place] = found[place - 1];
    dvec3 b(0);
    b[edge] = 1 - s;
    b[(edge + 1) % 3] = s;
    found[place] = {t, edge, distance, b, n, offset};
  });
  return met;
}

// Start of a descent on this side of a crease.
struct Start {
  std::uint32_t triangle;
  dvec3 barycentric;
  std::uint32_t vertex = kBorder;  // the start, if it is not on a crease: then it identifies this side
};
constexpr int kMostVertices = 512;  // on the way

// Walks from vertex to vertex, each nearer to x than the last, without crossing an edge that the foot may not cross.
// This is a hundred times faster than walking over patches. If it does not leave the crease, the crease's nearest point
// is the start.
Start start_on_side(const ObjectState& object, const Mesh& mesh, const NearCrease& crease, dvec3 x) {
  const auto crosses = [&](std::uint32_t t, int edge) {
    return !mesh.is_crease(t, edge) &&
           (object.closed.empty() ||
            !std::binary_search(object.closed.begin(), object.closed.end(), 3 * t + static_cast<std::uint32_t>(edge)));
  };
  const auto distance2 = [&](std::uint32_t v) {
    const dvec3 d = dvec3(mesh.position(v)) - x;
    return dot(d, d);
  };
  std::uint32_t triangle = crease.triangle, vertex = mesh.triangles[triangle][(crease.edge + 2) % 3];
  double best = distance2(vertex);
  if (!(best < crease.distance * crease.distance)) return {crease.triangle, crease.barycentric};
  bool at_crease = false;
  for (int step = 0; step < kMostVertices; ++step) {
    const std::uint32_t from = vertex;
    at_crease = false;
    around_vertex(mesh, from, triangle, crosses, [&](std::uint32_t t) {
      const int corner = corner_of(mesh.triangles[t], from);
      at_crease = at_crease || !crosses(t, corner) || !crosses(t, (corner + 2) % 3);
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = mesh.triangles[t][i];
        if (v == from || v == vertex) continue;
        const double d2 = distance2(v);
        if (!(d2 < best)) continue;
        best = d2;
        vertex = v;
        triangle = t;
      }
    });
    if (vertex == from) break;
  }
  dvec3 corner(0);
  corner[corner_of(mesh.triangles[triangle], vertex)] = 1;
  return {triangle, corner, at_crease ? kBorder : vertex};
}

// Whether the surface connects two feet of x near it: along its section by the plane of both feet and x, no farther
// from x than `within`. Another sheet of a thin part is not connected, however near it is.
bool connected(const Mesh& mesh, const Foot& from, const Foot& to, dvec3 x, double within) {
  const dvec3 p = inside_triangle(mesh, from.triangle, from.barycentric),
              q = inside_triangle(mesh, to.triangle, to.barycentric);
  const dvec3 across = cross(p - x, q - x);
  const auto near = [&](const SectionEdge& at) { return length(at.p - x) <= within; };
  return from.triangle == to.triangle || walk_section(mesh, from.triangle, to.triangle, p, across, near) ||
         walk_section(mesh, from.triangle, to.triangle, p, -across, near);
}

// How much the side of a foot on its edge faces x: 0 where x leaves the side's tangent plane.
Facing facing_of(const Mesh& mesh, const Foot& foot) {
  if (foot.place == FootPlace::kInside) return {};
  const CurvedPatch::Point at = curved_patch(mesh, foot.triangle).at(foot.barycentric.y, foot.barycentric.z);
  const dvec3 n = cross(at.pu, at.pv);
  const double size = length(n), cosine = dot(foot.normal, n) / size;
  const auto turn = [&](dvec3 dn) { return (dot(dn, foot.normal) - dot(dn, n) / size * cosine) / size; };
  return {cosine, glm::transpose(foot.turns) * (n / size) +
                      turn(cross(at.puu, at.pv) + cross(at.pu, at.puv)) * foot.shifts[1] +
                      turn(cross(at.puv, at.pv) + cross(at.pu, at.pvv)) * foot.shifts[2]};
}

// The contact's foot and those on other sides.
struct SideFeet {
  const ObjectState& object;
  const Mesh& mesh;
  dvec3 x;
  double same, farthest;  // [m]
  std::uint32_t count = 1;
  std::array<Foot, kMostFeet> feet;
  std::array<Facing, kMostFeet> facing{};

  // The foot of x on the side on which it starts, if it matters.
  void add(std::uint32_t triangle, dvec3 barycentric) {
    constexpr double kLeastFacing = 1e-6;
    const Foot foot = descend(mesh, triangle, barycentric, x, false, object.closed);
    if (!(foot.height < 0) || -foot.height > farthest || dot(foot.normal, feet[0].normal) < kThin) return;
    const auto is_same = [&](const Foot& f) {
      return length(f.p - foot.p) < same + 1e-9 * length(f.p) && dot(f.normal, foot.normal) > 0.999;
    };
    if (std::any_of(feet.begin(), feet.begin() + count, is_same)) return;
    const Facing side = facing_of(mesh, foot);
    if (!(side.cosine > kLeastFacing) || -foot.height > farthest * side.cosine) return;
    const double within =
        kCreaseReach * std::max(-feet[0].height, -foot.height) + 2 * static_cast<double>(mesh.tree.bulge);
    if (!connected(mesh, foot, feet[0], x, within)) return;
    std::uint32_t to = count;
    const auto depth = [&](std::uint32_t i) { return -feet[i].height / facing[i].cosine; };
    if (count < kMostFeet) {
      ++count;
    } else {  // replaces the farthest of the others
      to = 1;
      for (std::uint32_t i = 2; i < count; ++i)
        if (depth(i) > depth(to)) to = i;
      if (!(-foot.height / side.cosine < depth(to))) return;
    }
    feet[to] = foot;
    facing[to] = side;
    farthest = std::min(farthest, kBlendRatio * depth(to));
  }
};

}  // namespace

FootBlend contact_place(const ObjectState& object, const Mesh& mesh, const Foot& own, dvec3 x,
                        const FootBlend* before) {
  if (own.height >= 0 || object.creases.empty()) return place_of(own);
  // A foot over a crack is beside that on its edge.
  const double same = object.closed.empty() ? kSameContact * static_cast<double>(mesh.mean_edge) : crack_of(mesh);
  SideFeet sides{object, mesh, x, same, kBlendRatio * -own.height};
  sides.feet[0] = own;
  const double farthest = sides.farthest;
  std::array<NearCrease, kMostCreases> creases;
  std::size_t near = 0;
  // Around the point first. Then farther out, for sharp wedges, unless the surface is rough.
  if (nearest_creases(object, mesh, own, x, farthest, farthest, creases, near) <= 4 * kMostCreases) {
    near = 0;
    nearest_creases(object, mesh, own, x, kCreaseReach * -own.height, farthest, creases, near);
  }
  for (std::uint32_t i = 0; before && before->count > 1 && i < before->count; ++i)
    sides.add(before->foot[i].triangle, before->foot[i].barycentric);
  std::array<std::uint32_t, kMostCreases> started;
  std::size_t starts = 0;
  for (std::size_t i = 0; i < near; ++i) {
    const NearCrease& crease = creases[i];
    // A flat side whose foot is already known.
    const auto same_side = [&](const Foot& f) {
      return f.place == FootPlace::kInside && dot(f.normal, crease.normal) > 1 - 1e-9 &&
             std::abs(dot(f.p, crease.normal) - crease.offset) < same;
    };
    if (std::any_of(sides.feet.begin(), sides.feet.begin() + sides.count, same_side)) continue;
    const Start start = start_on_side(object, mesh, crease, x);
    if (start.vertex != kBorder) {
      if (std::find(started.begin(), started.begin() + starts, start.vertex) != started.begin() + starts) continue;
      started[starts++] = start.vertex;
    }
    sides.add(start.triangle, start.barycentric);
  }
  return blend_feet(sides.feet, sides.count, sides.facing);
}

}  // namespace pliant
