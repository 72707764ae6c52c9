#include "systems/touch/collide/virtual_vertex.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// Tolerance on barycentrics: a foot on an edge belongs to both sides, never to neither.
constexpr double kInside = -1e-9;

// Real roots of a cubic, each polished by Newton; returns their number.
int real_roots(const double (&c)[4], double (&roots)[3]) {
  const double size = std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2]), std::abs(c[3])});
  if (size == 0.0) return 0;
  int count = 0;
  if (std::abs(c[3]) < 1e-12 * size) {
    if (std::abs(c[2]) < 1e-12 * size) {
      if (c[1] != 0.0) roots[count++] = -c[0] / c[1];
    } else {
      const double d = c[1] * c[1] - 4 * c[2] * c[0];
      if (d >= 0) {
        const double q = -0.5 * (c[1] + std::copysign(std::sqrt(d), c[1]));  // no cancellation
        roots[count++] = q / c[2];
        if (q != 0.0) roots[count++] = c[0] / q;
      }
    }
  } else {
    const double a = c[2] / c[3], b = c[1] / c[3], d = c[0] / c[3];
    const double Q = (a * a - 3 * b) / 9, R = (2 * a * a * a - 9 * a * b + 27 * d) / 54;
    if (R * R < Q * Q * Q) {
      const double theta = std::acos(std::clamp(R / std::sqrt(Q * Q * Q), -1.0, 1.0)), s = -2 * std::sqrt(Q);
      for (const double turn : {0.0, 2 * M_PI, -2 * M_PI}) roots[count++] = s * std::cos((theta + turn) / 3) - a / 3;
    } else {
      const double A = -std::copysign(std::cbrt(std::abs(R) + std::sqrt(std::max(0.0, R * R - Q * Q * Q))), R);
      roots[count++] = A + (A != 0.0 ? Q / A : 0.0) - a / 3;
    }
  }
  for (int i = 0; i < count; ++i) {
    for (int n = 0; n < 3; ++n) {
      const double t = roots[i];
      const double f = ((c[3] * t + c[2]) * t + c[1]) * t + c[0], df = (3 * c[3] * t + 2 * c[2]) * t + c[1];
      if (df == 0.0) break;
      roots[i] = t - f / df;
    }
  }
  return count;
}

}  // namespace

Corner3 corners(const Mesh& mesh, std::uint32_t triangle) {
  const uvec3 t = mesh.triangles[triangle];
  return {{dvec3(mesh.position(t.x)), dvec3(mesh.position(t.y)), dvec3(mesh.position(t.z))},
          {dvec3(mesh.normal(t.x)), dvec3(mesh.normal(t.y)), dvec3(mesh.normal(t.z))}};
}

SurfaceFoot surface_point(const Corner3& c, std::uint32_t triangle, dvec3 b, double height) {
  SurfaceFoot point;
  point.triangle = triangle;
  point.barycentric = b;
  point.foot = b.x * c.p[0] + b.y * c.p[1] + b.z * c.p[2];
  const dvec3 n = b.x * c.n[0] + b.y * c.n[1] + b.z * c.n[2];
  const double size = length(n);
  point.normal = size > 0 ? n / size : normalize(cross(c.p[1] - c.p[0], c.p[2] - c.p[0]));
  point.height = height;
  return point;
}

SurfaceFoot virtual_vertex(const Mesh& mesh, std::uint32_t triangle, dvec3 x) {
  const Corner3 c = corners(mesh, triangle);
  const dvec3 e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0], n0 = c.n[0], m1 = c.n[1] - n0, m2 = c.n[2] - n0;
  const dvec3 r = c.p[0] - x;
  // det[...] = A(t) . (r + t n0), A(t) = (e1 + t m1) x (e2 + t m2) = A0 + t A1 + t^2 A2
  const dvec3 A0 = cross(e1, e2), A1 = cross(e1, m2) + cross(m1, e2), A2 = cross(m1, m2);
  // t is scaled by the point's distance, so that the polynomial's terms are comparable and |t| <= 1 is likely.
  const double unit = std::max(length(r), 1e-300);
  const double poly[4] = {dot(A0, r), unit * (dot(A1, r) + dot(A0, n0)), unit * unit * (dot(A2, r) + dot(A1, n0)),
                          unit * unit * unit * dot(A2, n0)};
  double roots[3];
  const int count = real_roots(poly, roots);
  SurfaceFoot best;
  for (int i = 0; i < count; ++i) {
    const double t = roots[i] * unit;
    const dvec3 a = e1 + t * m1, b = e2 + t * m2, q = -(r + t * n0), A = cross(a, b);
    const double size = dot(A, A);
    if (!(size > 0)) continue;
    const double u = dot(cross(q, b), A) / size, v = dot(cross(a, q), A) / size, w = 1 - u - v;
    if (!(u >= kInside && v >= kInside && w >= kInside)) continue;
    // Beyond a focal distance the normals have crossed: the offset triangle or its edges are inverted.
    if (dot(A, w * c.n[0] + u * c.n[1] + v * c.n[2]) <= 0 || dot(a, e1) <= 0 || dot(b, e2) <= 0) continue;
    const dvec3 n = n0 + u * m1 + v * m2;
    const double height = t * length(n);
    if (best.valid() && std::abs(height) >= best.distance()) continue;
    best = surface_point(c, triangle, {w, u, v}, height);
    best.interpolated = true;
  }
  return best;
}

bool continue_virtual_vertex(const Corner3& c, dvec3 x, dvec3& barycentric, double& height) {
  const dvec3 e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0], n0 = c.n[0], m1 = c.n[1] - n0, m2 = c.n[2] - n0;
  double u = barycentric.y, v = barycentric.z;
  double size = length(n0 + u * m1 + v * m2);
  if (!(size > 0)) return false;
  double t = height / size;
  const double edge = std::sqrt(std::max(dot(e1, e1), dot(e2, e2)));
  for (int i = 0; i < 20; ++i) {
    // Newton on P(u,v) + t N(u,v) - x with Jacobian [P_u + t N_u, P_v + t N_v, N].
    const dvec3 N = n0 + u * m1 + v * m2, a = e1 + t * m1, b = e2 + t * m2;
    const dvec3 residual = c.p[0] + u * e1 + v * e2 + t * N - x;
    const double det = dot(cross(a, b), N);
    if (!(det > 1e-12 * edge * edge)) return false;
    const double du = dot(cross(residual, b), N) / det, dv = dot(cross(a, residual), N) / det;
    const double dt = dot(cross(a, b), residual) / det;
    u -= du;
    v -= dv;
    t -= dt;
    if (!(std::abs(u) < 1e6 && std::abs(v) < 1e6)) return false;
    if (std::abs(du) + std::abs(dv) + std::abs(dt) / edge < 1e-13 * (1 + std::abs(u) + std::abs(v))) break;
    if (i == 19 && std::abs(du) + std::abs(dv) > 1e-9) return false;
  }
  barycentric = {1 - u - v, u, v};
  height = t * length(n0 + u * m1 + v * m2);
  return true;
}

// Voronoi regions of the triangle, after Ericson, Real-Time Collision Detection 5.1.5.
dvec3 closest_barycentric(const dvec3 (&p)[3], dvec3 x) {
  const dvec3 ab = p[1] - p[0], ac = p[2] - p[0], ap = x - p[0];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  const dvec3 bp = x - p[1], cp = x - p[2];
  const double d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {1 - v, v, 0};
  }
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {1 - w, 0, w};
  }
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

bool may_have_virtual_vertex(const Mesh& mesh, std::uint32_t triangle, dvec3 x, double distance2) {
  const Corner3 c = corners(mesh, triangle);
  const dvec3 n = cross(c.p[1] - c.p[0], c.p[2] - c.p[0]);
  // cos of the largest angle between the plane's normal and a corner's; no convex combination of the three exceeds it.
  const double size2 = dot(n, n);
  double least = std::numeric_limits<double>::max();
  for (const dvec3& normal : c.n) least = std::min(least, dot(normal, n) / length(normal));
  if (!(least > 0) || !(size2 > 0)) return true;
  const double above = dot(x - c.p[0], n);  // n| times the height above the plane
  const double room = kInside * kInside * size2 * dot(c.p[1] - c.p[0], c.p[1] - c.p[0]);
  return (above * above + 100 * room) * 1.000001 >= distance2 * least * least;
}

SurfaceFoot closest_point(const Mesh& mesh, std::uint32_t triangle, dvec3 x) {
  const Corner3 c = corners(mesh, triangle);
  const dvec3 b = closest_barycentric(c.p, x);
  SurfaceFoot point = surface_point(c, triangle, b, 0.0);
  const dvec3 d = x - point.foot;
  point.height = std::copysign(length(d), dot(d, point.normal));
  return point;
}

}  // namespace pliant
