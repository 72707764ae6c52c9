#include "systems/touch/contact_place.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// Sides of a convex crease whose normals make a larger angle than this cosine's (145 degrees) are two faces of a thin
// part: pressing one does not open the other.
constexpr double kThin = -0.82;
// How far from a point, in its depths, a crease may lie whose other side still matters: for a wedge of 35 degrees, the
// sharpest that is no thin part, tan a = sin 35 / (1.5 + cos 35) and 1 / sin a = 4.2.
constexpr double kCreaseReach = 4.2;
// Two feet are one where they are nearer than this. [1] of the mean edge
constexpr double kSameFoot = 1e-6;

// Convex creases of the mesh within `within` of x, as 3 * triangle + edge; every one from both its sides.
template <class Visit>
void visit_creases(const ObjectState& object, dvec3 x, double within, Visit visit) {
  Box around;
  around.add(vec3(x - dvec3(within)));
  around.add(vec3(x + dvec3(within)));
  object.crease_boxes.visit(
      around, [&](std::uint32_t i) { visit(object.creases[i] / 3, static_cast<int>(object.creases[i] % 3)); });
}

// A crease that may matter, and how far its edge is.
struct NearCrease {
  std::uint32_t triangle;
  int edge;
  double distance;
  dvec3 barycentric;  // of the edge's nearest point
  dvec3 normal;       // of the triangle
  double offset;      // [m] of its plane: normal . p
};
// So many are looked at in a tick, one for every flat side; where a surface is rough, the nearest ones.
constexpr std::size_t kMostCreases = 8;

// The nearest creases within `within` of x whose sides x may be below by less than `farthest`. Returns how many were
// met on the way.
std::size_t nearest_creases(const ObjectState& object, const Mesh& mesh, dvec3 x, double within, double farthest,
                            std::array<NearCrease, kMostCreases>& found, std::size_t& count) {
  const double bulge = static_cast<double>(mesh.tree.bulge), flat = 1e-5 * static_cast<double>(mesh.mean_edge);
  std::size_t met = 0;
  visit_creases(object, x, within, [&](std::uint32_t t, int edge) {
    ++met;
    const uvec3 corner = mesh.triangles[t];
    const dvec3 a(mesh.position(corner[edge])), e = dvec3(mesh.position(corner[(edge + 1) % 3])) - a;
    const dvec3 n = normalize(cross(e, dvec3(mesh.position(corner[(edge + 2) % 3])) - a));
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

}  // namespace

FootBlend contact_place(const ObjectState& object, const Mesh& mesh, const Foot& own, dvec3 x) {
  std::array<Foot, kMostFeet> feet;
  feet[0] = own;
  if (own.height >= 0 || object.creases.empty()) return blend_feet(feet, 1);
  double farthest = kBlendRatio * -own.height;
  std::array<NearCrease, kMostCreases> creases;
  std::size_t near = 0;
  // Around the point first; farther out, where sharp wedges may have theirs, unless the surface is rough.
  if (nearest_creases(object, mesh, x, farthest, farthest, creases, near) <= 4 * kMostCreases) {
    near = 0;
    nearest_creases(object, mesh, x, kCreaseReach * -own.height, farthest, creases, near);
  }
  std::uint32_t count = 1;
  const double same = kSameFoot * static_cast<double>(mesh.mean_edge);
  for (std::size_t i = 0; i < near; ++i) {
    const NearCrease& crease = creases[i];
    // A flat side whose foot is known.
    const auto same_side = [&](const Foot& f) {
      return f.place == FootPlace::kInside && dot(f.normal, crease.normal) > 1 - 1e-9 &&
             std::abs(dot(f.p, crease.normal) - crease.offset) < same;
    };
    if (std::any_of(feet.begin(), feet.begin() + count, same_side)) continue;
    const Foot foot = descend(mesh, crease.triangle, crease.barycentric, x, false, object.closed);
    if (!(foot.height < 0) || -foot.height > farthest || dot(foot.normal, own.normal) < kThin) continue;
    const auto is_same = [&](const Foot& f) {
      return length(f.p - foot.p) < same + 1e-9 * length(f.p) && dot(f.normal, foot.normal) > 0.999;
    };
    if (std::any_of(feet.begin(), feet.begin() + count, is_same)) continue;
    if (count < kMostFeet) {
      feet[count++] = foot;
    } else {  // the farthest of the others gives way
      const auto deepest = std::min_element(feet.begin() + 1, feet.end(),
                                            [](const Foot& f, const Foot& g) { return f.height < g.height; });
      if (foot.height > deepest->height) *deepest = foot;
    }
    farthest = std::min(farthest, kBlendRatio * -foot.height);
  }
  return blend_feet(feet, count);
}

}  // namespace pliant
