#include "systems/touch/model/smooth_paint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/touch/collide/around_vertex.h"
#include "systems/touch/collide/box_tree.h"
#include "systems/touch/collide/seams.h"

namespace pliant {
namespace {

constexpr int kFewest = 10;  // vertices of a regression

// A vertex's value, and its gradient limited to the range of the ring. [1], per metre
struct VertexPaint {
  double value = 0.0;
  dvec3 gradient{0};
};

template <class Visit>
void visit_ring(const Mesh& mesh, std::uint32_t vertex, std::uint32_t triangle, Visit visit) {
  around_vertex(mesh, vertex, triangle, [&](std::uint32_t t) {
    for (int i = 0; i < 3; ++i)
      if (const std::uint32_t v = mesh.triangles[t][i]; v != vertex) visit(v);
  });
}

VertexPaint vertex_paint(const Mesh& mesh, const std::vector<float>& factor, std::uint32_t vertex,
                         std::uint32_t triangle) {
  const double value = factor[vertex];
  const dvec3 p(mesh.position(vertex));
  dvec3 normal(0);
  around_vertex(mesh, vertex, triangle, [&](std::uint32_t t) { normal += facet_normal(mesh, t); });
  normal = length(normal) > 0 ? normalize(normal) : dvec3(0);
  double low = value, high = value;
  dmat3 moments(0.0);
  dvec3 right(0);
  visit_ring(mesh, vertex, triangle, [&](std::uint32_t v) {
    const double other = factor[v];
    low = std::min(low, other);
    high = std::max(high, other);
    // Along the surface only: on a dome the heights of the ring follow a peak of the paint.
    const dvec3 way = dvec3(mesh.position(v)) - p, e = way - dot(way, normal) * normal;
    const double weight = 1 / std::max(dot(e, e), 1e-300);
    moments += weight * glm::outerProduct(e, e);
    right += weight * (other - value) * e;
  });
  if (low == high) return {value, dvec3(0)};
  // The ring says nothing across it: the least gradient.
  moments += 1e-9 * (moments[0][0] + moments[1][1] + moments[2][2]) * dmat3(1.0);
  const dvec3 gradient = glm::inverse(moments) * right;
  double share = 1.0;
  visit_ring(mesh, vertex, triangle, [&](std::uint32_t v) {
    const double step = dot(gradient, dvec3(mesh.position(v)) - p) / 3;
    if (value + share * step > high) share = (high - value) / step;
    if (value + share * step < low) share = (low - value) / step;
  });
  return {value, share * gradient};
}

// Value at b and its derivatives by the barycentric coordinates.
struct CubicAt {
  double value;
  std::array<double, 3> slope;
};

CubicAt clough_tocher(const std::array<dvec3, 3>& p, const std::array<VertexPaint, 3>& at, dvec3 b) {
  // Ordinates: corner[i] at vertex i; next to it, towards[i][j] on the edge to j and inward[i] on the line to the
  // centroid; outward[i] next to the centroid; middle[i] between centroid and the edge opposite of i.
  double corner[3], towards[3][3], inward[3], middle[3], outward[3];
  for (int i = 0; i < 3; ++i) {
    corner[i] = at[i].value;
    for (int j = 0; j < 3; ++j) towards[i][j] = corner[i] + dot(at[i].gradient, p[j] - p[i]) / 3;
    inward[i] = (corner[i] + towards[i][(i + 1) % 3] + towards[i][(i + 2) % 3]) / 3;
  }
  const dvec3 centre = (p[0] + p[1] + p[2]) / 3.0;
  for (int i = 0; i < 3; ++i) {  // the derivative across edge jk is linear along it
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const dvec3 e = p[k] - p[j];
    const double s = std::clamp(dot(centre - p[j], e) / std::max(dot(e, e), 1e-300), 0.0, 1.0);
    middle[i] = 0.5 * (inward[j] + inward[k] - (1 - s) * (corner[j] + towards[k][j] - 2 * towards[j][k]) -
                       s * (towards[j][k] + corner[k] - 2 * towards[k][j]));
  }
  for (int i = 0; i < 3; ++i) outward[i] = (inward[i] + middle[(i + 1) % 3] + middle[(i + 2) % 3]) / 3;
  const double top = (outward[0] + outward[1] + outward[2]) / 3;

  // The part opposite of corner m, by its own coordinates: u at j, v at k, w at the centroid.
  int m = 0;
  for (int i = 1; i < 3; ++i)
    if (b[i] < b[m]) m = i;
  const int j = (m + 1) % 3, k = (m + 2) % 3;
  const double u = b[j] - b[m], v = b[k] - b[m], w = 3 * b[m];
  // One step of de Casteljau leaves a quadratic in three corners, whose values are the derivatives' thirds.
  const auto quadratic = [&](double uu, double vv, double ww, double uv, double vw, double uw) {
    return u * u * uu + v * v * vv + w * w * ww + 2 * (u * v * uv + v * w * vw + u * w * uw);
  };
  const double by_u = quadratic(corner[j], towards[k][j], outward[j], towards[j][k], middle[m], inward[j]);
  const double by_v = quadratic(towards[j][k], corner[k], outward[k], towards[k][j], inward[k], middle[m]);
  const double by_w = quadratic(inward[j], inward[k], top, middle[m], outward[k], outward[j]);
  CubicAt out;
  out.value = u * by_u + v * by_v + w * by_w;
  out.slope[j] = 3 * by_u;
  out.slope[k] = 3 * by_v;
  out.slope[m] = 3 * (3 * by_w - by_u - by_v);
  return out;
}

}  // namespace

namespace {

float at(const std::vector<float>& factor, std::uint32_t v) {
  return factor.empty() ? 1.0f : factor[v];
}

// Values around a vertex: sums of a regression plane.
struct Regression {
  dvec3 p, n, along, aside;
  double radius;
  dmat3 moments{0.0};
  dvec3 right{0};
  double low, high;
  int count = 0;

  Regression(dvec3 place, dvec3 normal, double reach, double value)
      : p(place),
        n(normal),
        along(normalize(cross(normal, std::abs(normal.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)))),
        aside(cross(normal, along)),
        radius(reach),
        low(value),
        high(value) {}

  void add(dvec3 place, dvec3 normal, double area, double value) {
    const dvec3 d = place - p;
    const double u = 1 - dot(d, d) / (radius * radius);
    if (u <= 0 || dot(normal, n) <= 0) return;
    const double weight = u * u * area;
    const dvec3 basis(1, dot(d, along) / radius, dot(d, aside) / radius);
    moments += weight * glm::outerProduct(basis, basis);
    right += weight * value * basis;
    low = std::min(low, value);
    high = std::max(high, value);
    ++count;
  }
  double value(double own) const {
    if (count < kFewest || low == high) return own;
    const dmat3 regular = moments + 1e-12 * moments[0][0] * dmat3(1.0);
    return std::clamp((glm::inverse(regular) * right).x, low, high);
  }
};

// Zones of a mesh with the range of their values, in another's frame.
struct PaintedZones {
  const Mesh& mesh;
  const std::vector<float>& factor;
  Pose place;
  double value;
  std::vector<Box> boxes;
  std::vector<float> low, high;
  BoxTree tree;

  PaintedZones(const Mesh& of, const std::vector<float>& painted, const Pose& pose, double whole)
      : mesh(of), factor(painted), place(pose), value(whole) {
    for (std::uint32_t zone = 0; zone < mesh.zone_count(); ++zone) {
      float least = at(factor, mesh.zone_begin(zone)), most = least;
      Box box;
      for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone); ++v) {
        least = std::min(least, at(factor, v));
        most = std::max(most, at(factor, v));
        box.add(vec3(place.to_world(dvec3(mesh.position(v)))));
      }
      boxes.push_back(box);
      low.push_back(least * static_cast<float>(value));
      high.push_back(most * static_cast<float>(value));
    }
    tree.build(boxes);
  }
  void add(std::uint32_t zone, Regression& sums) const {
    for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone); ++v)
      sums.add(place.to_world(dvec3(mesh.position(v))), place.rotation * dvec3(mesh.normal(v)), double{mesh.area[v]},
               value * double{at(factor, v)});
  }
};

}  // namespace

std::vector<float> felt_paint(const Mesh& mesh, const std::vector<float>& factor, double radius,
                              const std::vector<FlushPaint>& flush) {
  const bool even = std::all_of(flush.begin(), flush.end(),
                                [](const FlushPaint& other) { return other.value == 1.0 && other.factor->empty(); });
  if (factor.empty() && even) return {};
  std::vector<PaintedZones> surfaces;
  surfaces.emplace_back(mesh, factor, Pose{}, 1.0);
  for (const FlushPaint& other : flush) surfaces.emplace_back(*other.mesh, *other.factor, other.place, other.value);
  std::vector<float> felt = factor;
  if (felt.empty()) felt.assign(mesh.px.size(), 1.0f);
  std::vector<std::pair<const PaintedZones*, std::uint32_t>> near;
  const vec3 r(static_cast<float>(radius));
  for (std::uint32_t zone = 0; zone < mesh.zone_count(); ++zone) {
    const Box& box = surfaces[0].boxes[zone];
    float least = surfaces[0].low[zone], most = surfaces[0].high[zone];
    near.clear();
    for (const PaintedZones& surface : surfaces)
      surface.tree.visit(Box{box.min - r, box.max + r}, [&](std::uint32_t other) {
        near.emplace_back(&surface, other);
        least = std::min(least, surface.low[other]);
        most = std::max(most, surface.high[other]);
      });
    if (least == most) continue;
    std::sort(near.begin(), near.end());
    for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone); ++v) {
      Regression sums(dvec3(mesh.position(v)), dvec3(mesh.normal(v)), radius, double{felt[v]});
      for (const auto& [surface, other] : near) surface->add(other, sums);
      if (at(factor, v) > 0) felt[v] = static_cast<float>(sums.value(double{at(factor, v)}));  // none stays none
    }
  }
  return felt;
}

Painted smooth_painted(const FootBlend& blend, const Mesh& mesh, const std::vector<float>& factor) {
  if (factor.empty()) return {};
  Painted sum{0.0, dvec3(0)};
  for (std::uint32_t f = 0; f < blend.count; ++f) {
    const Foot& foot = blend.foot[f];
    const uvec3 t = mesh.triangles[foot.triangle];
    std::array<dvec3, 3> p;
    std::array<VertexPaint, 3> at;
    for (int i = 0; i < 3; ++i) {
      const auto corner = static_cast<std::size_t>(i);
      p[corner] = dvec3(mesh.position(t[i]));
      at[corner] = vertex_paint(mesh, factor, t[i], foot.triangle);
    }
    const CubicAt here = clough_tocher(p, at, foot.barycentric);
    dvec3 gradient(0);
    for (std::size_t i = 0; i < 3; ++i) gradient += here.slope[i] * foot.shifts[i];
    sum.value += blend.weight[f] * here.value;
    sum.gradient += blend.weight[f] * gradient + here.value * blend.weight_slope[f];
  }
  return sum;
}

}  // namespace pliant
