#include "systems/soft/collide/contact_on_arcs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "systems/soft/collide/farthest_axis.h"

namespace pliant {
namespace {

constexpr double kCurved = 0.02;   // [rad] over a mean edge: a surface that turns less along a direction is flat there
constexpr double kFacing = 0.0;    // [1] cosine: surfaces that face away from each other do not touch there
constexpr double kRim = 0.866;     // [1] cosine between the normals of triangles: a rim, beyond which they do not touch
constexpr int kMostCrossed = 32;   // triangles of a flat side between a feature and where it touches
constexpr double kFarthest = 2.0;  // [mean edges] of the shift from a feature to where its surface touches

// A sheet keeps its mesh: what comes from behind passes it.
bool rigid(const CollisionMesh& mesh) {
  return (mesh.turns() || mesh.fixed()) && mesh.closed();
}

// One side's smooth surface at a point, in the frame of a contact: normal and two tangents.
struct Side {
  dvec3 normal{0};
  dmat2 form{0};      // [1/m] shape operator
  double rise = 0.0;  // [m] over the mesh
  double edge = 0.0;  // [m] of its mesh if it is curved, else 0
  bool sharp = false;
};

Side side_of(const CollisionMesh& mesh, const SurfacePoint& point, bool face, const dmat3& turn, const dmat3& axes) {
  const uvec3 corners = mesh.mesh().triangles[point.triangle];
  const SmoothShape& shape = mesh.smooth_shape();
  Side side;
  dvec3 normal(0.0);
  dmat3 bend(0.0);
  for (int i = 0; i < 3; ++i) {
    const double w = point.barycentric[i];
    if (w == 0.0) continue;
    const bool smooth = shape.smooth[corners[i]] != 0;
    side.sharp |= !face && !smooth;
    normal += w * (smooth ? shape.normal[corners[i]] : mesh.rest().normal[point.triangle]);
    bend += w * shape.bend[corners[i]];
  }
  side.rise = shape.rise(mesh.mesh(), point.triangle, point.barycentric);
  const double size = length(normal);
  side.sharp |= !(size > 0.0);
  if (side.sharp) return side;
  const dmat3 to_axes = glm::transpose(axes) * turn;
  side.normal = to_axes * (normal / size);
  const dmat3 local = to_axes * bend * glm::transpose(to_axes);
  side.form = dmat2(local[1][1], local[1][2], local[2][1], local[2][2]);
  const double edge = static_cast<double>(mesh.mesh().mean_edge);
  const double most = std::abs(side.form[0][0]) + std::abs(side.form[1][1]) + std::abs(side.form[0][1]);
  if (most * edge > kCurved) side.edge = edge;
  return side;
}

// The minimum of phi s + s K s / 2, along the directions in which K bulges.
dvec2 shift_to_touch(const dmat2& K, dvec2 phi, double edge) {
  const double mean = 0.5 * (K[0][0] + K[1][1]), half = 0.5 * (K[0][0] - K[1][1]), radius = std::hypot(half, K[0][1]);
  const double angle = 0.5 * std::atan2(K[0][1], half);
  const dvec2 first(std::cos(angle), std::sin(angle)), second(-first.y, first.x);
  dvec2 s(0.0);
  for (const auto& [way, k] : {std::pair(first, mean + radius), std::pair(second, mean - radius)})
    if (k * edge > kCurved) s -= dot(way, phi) / k * way;
  return s;
}

// Whether `by` [m] leads from a point of a flat side over its rim. Rest frame.
bool over_rim(const CollisionMesh& mesh, const SurfacePoint& from, dvec3 by) {
  const Mesh& rest = mesh.mesh();
  std::uint32_t triangle = from.triangle;
  const auto corner = [&](int i) { return dvec3(rest.position(mesh.mesh().triangles[triangle][i])); };
  const dvec3 at =
      from.barycentric[0] * corner(0) + from.barycentric[1] * corner(1) + from.barycentric[2] * corner(2) + by;
  for (int n = 0; n < kMostCrossed; ++n) {
    const dvec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
    int out = -1;
    double least = -1e-9 * dot(normal, normal);
    for (int i = 0; i < 3; ++i)
      if (const double area = dot(normal, cross(corner((i + 2) % 3) - corner((i + 1) % 3), at - corner((i + 1) % 3)));
          area < least)
        least = area, out = i;
    if (out < 0) return false;
    const CollisionEdge* crossed = nullptr;
    for (int i = 0; i < 3; ++i) {
      const CollisionEdge& edge = mesh.edges()[mesh.edge_of(triangle, i)];
      const std::uint32_t opposite = mesh.mesh().triangles[triangle][out];
      if (edge.from != opposite && edge.to != opposite) crossed = &edge;
    }
    const std::uint32_t next = crossed->triangle[crossed->triangle[0] == triangle ? 1 : 0];
    if (next == triangle || dot(mesh.rest().normal[triangle], mesh.rest().normal[next]) < kRim) return true;
    triangle = next;
  }
  return false;
}

// Where the smooth surfaces touch, relative to the features' points.
struct Foot {
  dvec3 a{0}, b{0};     // [m] world
  double closer = 0.0;  // [m]
  bool curved = false;  // neither is sharp, and one of them is curved
};

Foot find_foot(const FeaturePair& pair, const SurfacePoint& at_a, const SurfacePoint& at_b, dvec3 normal, bool ahead) {
  const dvec3 along = farthest_axis(normal);
  const dvec3 t = normalize(along - dot(along, normal) * normal);
  const dmat3 axes(normal, t, cross(normal, t));
  const Side a = side_of(pair.a, at_a, false, pair.a.turn_from_rest(ahead), axes);
  const Side b = side_of(pair.b, at_b, !pair.edges, pair.b.turn_from_rest(ahead), axes);
  dvec3 of_a(-a.rise, 0, 0), of_b(b.rise, 0, 0);
  bool touch = !a.sharp && !b.sharp && -dot(a.normal, b.normal) > kFacing;
  if (touch) {
    const dvec2 up_a(a.normal.y, a.normal.z), up_b(-b.normal.y, -b.normal.z);
    const double edge = a.edge > 0.0 && b.edge > 0.0 ? std::min(a.edge, b.edge) : std::max(a.edge, b.edge);
    dvec2 s = shift_to_touch(a.form + b.form, up_a - up_b, edge);
    for (const auto& [mesh, side, point] : {std::tuple(&pair.a, &a, &at_a), std::tuple(&pair.b, &b, &at_b)})
      if (side->edge == 0.0)
        touch &= !over_rim(*mesh, *point, glm::transpose(mesh->turn_from_rest(ahead)) * (axes * dvec3(0, s)));
    if (const double far = length(s); far > kFarthest * edge) s *= kFarthest * edge / far;
    const double exact = 2.0 / (1.0 + std::max(0.0, -dot(a.normal, b.normal)));  // of a circle's arc, not a parabola
    if (touch) {
      of_a += dvec3(exact * (dot(up_a, s) + 0.5 * dot(s, a.form * s)), s);
      of_b += dvec3(exact * (dot(up_b, s) - 0.5 * dot(s, b.form * s)), s);
    }
  }
  return {axes * of_a, axes * of_b, of_b.x - of_a.x, touch && (a.edge > 0.0 || b.edge > 0.0)};
}

// Moves a point of a turning body to its arm at the end of the step. Returns the part of T u_n by its rotation [m].
double put_on_arc(const CollisionMesh& mesh, dvec3 foot, dvec3 normal, SurfacePoint& point) {
  if (!mesh.turns()) return 0.0;
  const RigidPath& path = mesh.last_path();
  point.position = path.centre + mesh.turn_ahead() * (point.position - path.centre) + foot;
  point.beside = true;
  return mesh.step() * dot(normal, cross(path.angular, point.position - path.centre));
}

}  // namespace

void place_on_arcs(const FeaturePair& pair, double begin_gap, ContactPoint& contact) {
  const CollisionMesh &a = pair.a, &b = pair.b;
  if (!(a.turns() || b.turns()) || !rigid(a) || !rigid(b)) return;
  const Foot foot = find_foot(pair, contact.a, contact.b, contact.normal, true);
  if (!foot.curved) return;
  const double closer = find_foot(pair, contact.a, contact.b, contact.normal, false).closer;
  contact.depth = std::max(0.0, closer - begin_gap);
  const double by_a = put_on_arc(a, foot.a, contact.normal, contact.a);
  const double by_b = put_on_arc(b, foot.b, contact.normal, contact.b);
  const double of_feet = dot(contact.normal, (a.turns() ? foot.a : dvec3(0.0)) - (b.turns() ? foot.b : dvec3(0.0)));
  contact.gap = dot(contact.normal, contact.a.position - contact.b.position) - of_feet - foot.closer - (by_a - by_b);
}

double closer_by_shape(const FeaturePair& pair, const SurfacePoint& a, const SurfacePoint& b, dvec3 normal) {
  if (!(pair.a.turns() || pair.b.turns()) || !rigid(pair.a) || !rigid(pair.b)) return 0.0;
  const Foot foot = find_foot(pair, a, b, normal, true);
  return foot.curved ? foot.closer : 0.0;
}

}  // namespace pliant
