#include "systems/soft/collide/contact_geometry.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/collide/contact_on_arcs.h"

namespace pliant {
namespace {

constexpr double kSameSide = 0.7;        // [1] cosine: normals of one and the same contact
constexpr double kCrease = 0.5;          // [1] cosine between triangles: no contact slides over a sharper edge
constexpr int kMostTriangles = 8;        // largest number of triangles crossed in a step
constexpr double kParallelFaces = 1e-2;  // [1] sine below which the common normal of two edges is undefined
constexpr double kDeepest = 0.25;        // [mean edges] deeper predictions are invalid: the motion will not continue
constexpr double kLeast = 5e-3;          // [1] sine: a smaller tilt of the normal is ignored
constexpr double kDifference = 0.5;      // [mean edges]
constexpr double kFlatAngle = 0.01;      // [1] of both curvatures: lower bound for flat or concave surfaces
constexpr double kFlattest = 1e-6;       // [1/m] lower bound for flat on flat
constexpr double kReach = 0.3;           // [mean edges] at larger distances differences of normals are meaningless

struct Touch {
  SurfacePoint a, b;
  dvec3 apart{0};  // [m] from b to a, at their predicted positions
  dvec3 normal{0};
};

// [m] The shorter of their mean edges.
double edge_of(const FeaturePair& pair) {
  return static_cast<double>(std::min(pair.a.mesh().mean_edge, pair.b.mesh().mean_edge));
}

// A surface at the end of the step; or in its rest shape, rotated with one of its triangles.
class Surface {
 public:
  explicit Surface(const CollisionMesh& collision_mesh)
      : collision_mesh_(collision_mesh), turned_(collision_mesh.turns()), turn_(collision_mesh.normals_to_ahead()) {}
  Surface(const CollisionMesh& collision_mesh, std::uint32_t triangle)
      : collision_mesh_(collision_mesh), resting_(true), turned_(true), turn_(collision_mesh.turn(triangle)) {}
  const CollisionMesh& collision_mesh() const { return collision_mesh_; }
  bool smooth(std::uint32_t v) const {
    return resting_ ? collision_mesh_.rest().smooth[v] != 0 : collision_mesh_.smooth(v);
  }
  double curvature(std::uint32_t v) const {
    return resting_ ? collision_mesh_.rest().curvature[v] : collision_mesh_.curvature(v);
  }
  // Interpolated vertex normals; at a corner on a crease the facet's normal is used instead.
  dvec3 normal(const SurfacePoint& point) const {
    const uvec3 corners = collision_mesh_.mesh().triangles[point.triangle];
    dvec3 n(0.0);
    for (int i = 0; i < 3; ++i)
      n += point.barycentric[i] * (smooth(corners[i]) ? vertex_normal(corners[i]) : facet(point.triangle));
    return turned_ ? turn_ * n : n;
  }

 private:
  dvec3 vertex_normal(std::uint32_t v) const {
    return resting_ ? collision_mesh_.rest().vertex_normal[v] : collision_mesh_.vertex_normal(v);
  }
  dvec3 facet(std::uint32_t t) const { return resting_ ? collision_mesh_.rest().normal[t] : collision_mesh_.normal(t); }

  const CollisionMesh& collision_mesh_;
  bool resting_ = false, turned_ = false;
  dmat3 turn_{1};
};

// One side of a contact: the surface's normal at its point and its curvature; no normal if it is sharp.
struct Lean {
  dvec3 normal{0};
  double curvature = 0.0;  // [1/m] >= 0
  bool sharp = true;
};

// `flat`: a facet beside a crease is flat, whatever the other facets of its sharp corners do.
Lean lean_at(const Surface& surface, const SurfacePoint& point, bool face, bool flat = false) {
  const uvec3 corners = surface.collision_mesh().mesh().triangles[point.triangle];
  Lean lean;
  lean.sharp = false;
  for (int i = 0; i < 3; ++i) {
    if (point.barycentric[i] == 0.0) continue;
    lean.sharp |= !face && !surface.smooth(corners[i]);
    if (flat && !surface.smooth(corners[i])) continue;
    lean.curvature += point.barycentric[i] * std::max(0.0, surface.curvature(corners[i]));
  }
  if (!lean.sharp) lean.normal = surface.normal(point);
  return lean;
}

// Out of b; zero if both are sharp.
dvec3 common_normal(const Lean& a, const Lean& b) {
  if (a.sharp) return b.normal;
  if (b.sharp) return -a.normal;
  const double sum = a.curvature + b.curvature;
  const double of_b = sum > 0.0 && b.curvature > 0.0 ? a.curvature / sum : 1.0;
  return of_b * b.normal - (1.0 - of_b) * a.normal;
}

dvec3 without(dvec3 v, dvec3 along) {
  return v - dot(v, along) / dot(along, along) * along;
}

// `offset` [m]: displacement of a from its prediction.
std::optional<Touch> vertex_touch(const FeaturePair& pair, const Surface& of_a, const Surface& of_b, dvec3 offset) {
  const CollisionMesh& b = pair.b;
  const dvec3 p = pair.a.ahead(pair.feature_a) + offset;
  std::uint32_t t = pair.feature_b, from = kBorder;
  for (int walked = 0; walked < kMostTriangles; ++walked) {
    const uvec3 c = b.mesh().triangles[t];
    const dvec3 x0 = b.ahead(c.x), x1 = b.ahead(c.y), x2 = b.ahead(c.z), n = cross(x1 - x0, x2 - x0);
    const double nn = dot(n, n);
    if (!(nn > 0.0)) return {};
    dvec3 w(dot(cross(x1 - p, x2 - p), n) / nn, dot(cross(x2 - p, x0 - p), n) / nn, 0.0);
    w.z = 1.0 - w.x - w.y;
    const int outside = w.x <= w.y ? (w.x <= w.z ? 0 : 2) : (w.y <= w.z ? 1 : 2);
    const std::uint32_t next = w[outside] < 0.0 ? b.mesh().across[t][(outside + 1) % 3] : kBorder;
    // Over a convex edge, each triangle may refer to the other.
    if (next != kBorder && next != from && dot(b.normal(next), b.normal(t)) > kCrease) {
      from = t;
      t = next;
      continue;
    }
    w = glm::max(w, dvec3(0.0));
    Touch touch{pair.a.point_at_vertex(pair.feature_a), b.point_on_triangle(t, w / (w.x + w.y + w.z))};
    touch.apart = p - (touch.b.barycentric.x * x0 + touch.b.barycentric.y * x1 + touch.b.barycentric.z * x2);
    touch.normal =
        common_normal(lean_at(of_a, touch.a, false), lean_at(of_b, touch.b, true, pair.a.turns() || pair.b.turns()));
    return touch;
  }
  return {};
}

std::optional<Touch> edge_touch(const FeaturePair& pair, const Surface& of_a, const Surface& of_b, dvec3 offset) {
  const CollisionEdge &on_a = pair.a.edges()[pair.feature_a], &on_b = pair.b.edges()[pair.feature_b];
  const dvec3 a0 = pair.a.ahead(on_a.from) + offset, b0 = pair.b.ahead(on_b.from);
  const dvec3 e = pair.a.ahead(on_a.to) + offset - a0, f = pair.b.ahead(on_b.to) - b0, r = a0 - b0, n = cross(e, f);
  const double ee = dot(e, e), ff = dot(f, f), ef = dot(e, f), er = dot(e, r), fr = dot(f, r), det = ee * ff - ef * ef;
  if (!(det > kParallelFaces * kParallelFaces * ee * ff)) return {};
  const double on_e = (ef * fr - er * ff) / det, on_f = (ee * fr - ef * er) / det;
  const double s = std::clamp(on_e, 0.0, 1.0), t = std::clamp(on_f, 0.0, 1.0);
  Touch touch{pair.a.point_on_edge(pair.feature_a, s), pair.b.point_on_edge(pair.feature_b, t)};
  touch.apart = a0 + s * e - (b0 + t * f);
  const Lean a = lean_at(of_a, touch.a, false), b = lean_at(of_b, touch.b, false);
  touch.normal = common_normal(a, b);
  // The normal is perpendicular to a sharp edge.
  if (a.sharp && b.sharp)
    touch.normal = dot(n, pair.normal) < 0.0 ? -n : n;
  else if (a.sharp || b.sharp)
    touch.normal = without(touch.normal, a.sharp ? e : f);
  return touch;
}

std::optional<Touch> touch_at(const FeaturePair& pair, const Surface& a, const Surface& b, dvec3 offset) {
  std::optional<Touch> touch = pair.edges ? edge_touch(pair, a, b, offset) : vertex_touch(pair, a, b, offset);
  if (!touch) return {};
  const double size = length(touch->normal);
  touch->normal /= size;
  if (!(size > 0.0 && dot(touch->normal, pair.normal) > kSameSide)) return {};
  return touch;
}

// Invalid if so deep that the motion will not continue.
std::optional<Touch> touch_ahead(const FeaturePair& pair) {
  const std::optional<Touch> touch = touch_at(pair, Surface(pair.a), Surface(pair.b), dvec3(0.0));
  if (!touch || dot(touch->normal, touch->apart) < -kDeepest * edge_of(pair)) return {};
  return touch;
}

// One side's shape operator at a contact, in its rest shape but rotated to its current orientation, along the contact's
// tangents.
struct Bend {
  dmat2 form{0};  // [1/m]
  bool sharp = false;
};

Bend bend_at(const CollisionMesh& collision_mesh, const SurfacePoint& point, bool face, const dmat3& axes) {
  const uvec3 corners = collision_mesh.mesh().triangles[point.triangle];
  Bend out;
  dmat3 bend(0.0);
  for (int i = 0; i < 3; ++i) {
    if (point.barycentric[i] == 0.0) continue;
    out.sharp |= !face && !collision_mesh.rest().smooth[corners[i]];
    bend += point.barycentric[i] * collision_mesh.rest().bend[corners[i]];
  }
  const dmat3 turned = glm::transpose(axes) * collision_mesh.turn(point.triangle);
  const dmat3 local = turned * bend * glm::transpose(turned);
  out.form = dmat2(local[1][1], local[1][2], local[2][1], local[2][2]);
  return out;
}

// m = mean + radius * across, across a reflection: eigenvalues mean + radius and mean - radius.
struct Eigen2 {
  double mean = 0.0, radius = 0.0;
  dmat2 across{0};
  explicit Eigen2(const dmat2& m) : mean(0.5 * (m[0][0] + m[1][1])) {
    const double d = 0.5 * (m[0][0] - m[1][1]), off = m[0][1];
    radius = std::hypot(d, off);
    if (radius > 0.0) across = dmat2(d, off, off, -d) / radius;
  }
};

double largest(const dmat2& symmetric) {
  const Eigen2 m(symmetric);
  return std::max(0.0, m.mean + m.radius);
}

// Eigenvalues raised to `least`.
dmat2 raised(const dmat2& symmetric, double least) {
  const Eigen2 m(symmetric);
  const double high = std::max(m.mean + m.radius, least), low = std::max(m.mean - m.radius, least);
  return 0.5 * (high + low) * dmat2(1.0) + 0.5 * (high - low) * m.across;
}

// Where both sides are smooth; else `turning` stays as found by differences.
void find_place(const FeaturePair& pair, ContactPoint& contact) {
  const Bend a = bend_at(pair.a, contact.a, false, contact.axes);
  const Bend b = bend_at(pair.b, contact.b, !pair.edges, contact.axes);
  if (a.sharp && b.sharp) return;
  if (a.sharp) {
    contact.over_b = dmat2(1.0);
  } else if (b.sharp) {
    contact.over_a = dmat2(-1.0);
  } else {
    const double least = std::max(kFlatAngle * (largest(a.form) + largest(b.form)), kFlattest);
    const dmat2 A = raised(a.form, least), B = raised(b.form, least);
    contact.over_b = glm::inverse(A + B) * A;
    contact.over_a = contact.over_b - dmat2(1.0);
    contact.turning = B * contact.over_b;
  }
}

}  // namespace

bool look_ahead(const FeaturePair& pair, ContactPoint& contact) {
  const std::optional<Touch> touch = touch_ahead(pair);
  if (!touch) return false;
  contact.a = touch->a;
  contact.b = touch->b;
  contact.normal = touch->normal;
  contact.gap = dot(touch->normal, touch->a.position - touch->b.position);
  return true;
}

bool look_again(const FeaturePair& pair, ContactPoint& contact) {
  const std::optional<Touch> touch = touch_ahead(pair);
  if (!touch) return false;
  const dvec3 own = touch->normal * contact.axes;
  if (!(own.x > kSameSide) || std::max(std::abs(own.y), std::abs(own.z)) < kLeast) return false;
  contact.normal = touch->normal;
  contact.lean = dvec2(own.y, own.z) / own.x;
  contact.end_gap = dot(touch->normal, touch->apart) - closer_by_shape(pair, touch->a, touch->b, touch->normal);
  return true;
}

void find_turning(const FeaturePair& pair, ContactPoint& contact) {
  const double h = kDifference * edge_of(pair);
  const Surface a(pair.a, contact.a.triangle), b(pair.b, contact.b.triangle);
  FeaturePair beside = pair;
  beside.normal = contact.normal;
  dmat2 turning(0.0);
  for (int k = 0; k < 2; ++k) {
    const dvec3 aside = h * contact.axes[k + 1];
    const std::optional<Touch> ahead = touch_at(beside, a, b, aside), back = touch_at(beside, a, b, -aside);
    if (!ahead || !back) return;
    const dvec3 change = ahead->normal - back->normal;
    turning[k] = dvec2(dot(change, contact.axes[1]), dot(change, contact.axes[2])) / (2.0 * h);
  }
  contact.turning = turning;
  find_place(pair, contact);
  contact.reach = kReach * edge_of(pair);
}

}  // namespace pliant
