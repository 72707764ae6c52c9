#include "systems/soft/fem/element.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "runtime/kernel.h"
#include "systems/soft/fem/polar.h"

namespace pliant {
namespace {

constexpr double kFlat = 1e-9;       // [1] volume over the longest edge cubed
constexpr int kNewtonSteps = 4;      // before an element is treated individually
constexpr double kConverged = 1e-6;  // [rad] a smaller step leaves an error of its square
constexpr double kCertain = 1e-7;    // [1] as in polar.cpp

PLIANT_KERNEL void deform(const ElementPack& pack, ElementVisit& v) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      for (std::size_t l = 0; l < kElementLanes; ++l)
        v.F[column][row][l] = v.edge[0][row][l] * pack.gradient[0][column][l] +
                              v.edge[1][row][l] * pack.gradient[1][column][l] +
                              v.edge[2][row][l] * pack.gradient[2][column][l];
}

// One step of extract_rotation() in every lane, the same arithmetic.
PLIANT_KERNEL void newton(ElementVisit& v) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    const double w = v.q[0][l], x = v.q[1][l], y = v.q[2][l], z = v.q[3][l];
    // Columns of R, and B = R^T F.
    const double r00 = 1 - 2 * (y * y + z * z), r01 = 2 * (x * y + w * z), r02 = 2 * (x * z - w * y);
    const double r10 = 2 * (x * y - w * z), r11 = 1 - 2 * (x * x + z * z), r12 = 2 * (y * z + w * x);
    const double r20 = 2 * (x * z + w * y), r21 = 2 * (y * z - w * x), r22 = 1 - 2 * (x * x + y * y);
    const double b00 = r00 * v.F[0][0][l] + r01 * v.F[0][1][l] + r02 * v.F[0][2][l];
    const double b01 = r10 * v.F[0][0][l] + r11 * v.F[0][1][l] + r12 * v.F[0][2][l];
    const double b02 = r20 * v.F[0][0][l] + r21 * v.F[0][1][l] + r22 * v.F[0][2][l];
    const double b10 = r00 * v.F[1][0][l] + r01 * v.F[1][1][l] + r02 * v.F[1][2][l];
    const double b11 = r10 * v.F[1][0][l] + r11 * v.F[1][1][l] + r12 * v.F[1][2][l];
    const double b12 = r20 * v.F[1][0][l] + r21 * v.F[1][1][l] + r22 * v.F[1][2][l];
    const double b20 = r00 * v.F[2][0][l] + r01 * v.F[2][1][l] + r02 * v.F[2][2][l];
    const double b21 = r10 * v.F[2][0][l] + r11 * v.F[2][1][l] + r12 * v.F[2][2][l];
    const double b22 = r20 * v.F[2][0][l] + r21 * v.F[2][1][l] + r22 * v.F[2][2][l];
    // a = axial(B - B^T), H = tr(B) I - sym(B), its adjugate, H^-1 a.
    const double ax = b12 - b21, ay = b20 - b02, az = b01 - b10;
    const double xx = b11 + b22, yy = b00 + b22, zz = b00 + b11;
    const double xy = -0.5 * (b01 + b10), xz = -0.5 * (b02 + b20), yz = -0.5 * (b12 + b21);
    const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const double czz = xx * yy - xy * xy, cyz = xy * xz - xx * yz, cyy = xx * zz - xz * xz;
    const double det = xx * cxx + xy * cxy + xz * cxz;
    const double mean = (xx + yy + zz) / 3;
    const double certain = std::min(std::min(xx, czz), det - kCertain * mean * mean * mean);
    const double inverse = 0.5 / det;
    const double hx = inverse * (cxx * ax + cxy * ay + cxz * az);
    const double hy = inverse * (cxy * ax + cyy * ay + cyz * az);
    const double hz = inverse * (cxz * ax + cyz * ay + czz * az);
    // q <- q (1, w/2), unit again.
    const double nw = w - x * hx - y * hy - z * hz, nx = x + w * hx + y * hz - z * hy;
    const double ny = y + w * hy + z * hx - x * hz, nz = z + w * hz + x * hy - y * hx;
    const double scale = 1 / std::sqrt(nw * nw + nx * nx + ny * ny + nz * nz);
    v.q[0][l] = scale * nw, v.q[1][l] = scale * nx, v.q[2][l] = scale * ny, v.q[3][l] = scale * nz;
    const double angle2 = 4 * (hx * hx + hy * hy + hz * hz);
    v.turned[l] = v.turned[l] >= 0 && certain > 0 ? angle2 : -1.0;
  }
}

PLIANT_KERNEL void turn(const ElementPack& pack, ElementVisit& v) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    const double w = v.q[0][l], x = v.q[1][l], y = v.q[2][l], z = v.q[3][l];
    const double r00 = 1 - 2 * (y * y + z * z), r01 = 2 * (x * y + w * z), r02 = 2 * (x * z - w * y);
    const double r10 = 2 * (x * y - w * z), r11 = 1 - 2 * (x * x + z * z), r12 = 2 * (y * z + w * x);
    const double r20 = 2 * (x * z + w * y), r21 = 2 * (y * z - w * x), r22 = 1 - 2 * (x * x + y * y);
    for (int k = 0; k < 3; ++k) {
      const double bx = pack.gradient[k][0][l], by = pack.gradient[k][1][l], bz = pack.gradient[k][2][l];
      v.c[k + 1][0][l] = r00 * bx + r10 * by + r20 * bz;
      v.c[k + 1][1][l] = r01 * bx + r11 * by + r21 * bz;
      v.c[k + 1][2][l] = r02 * bx + r12 * by + r22 * bz;
    }
    for (int d = 0; d < 3; ++d) v.c[0][d][l] = -(v.c[1][d][l] + v.c[2][d][l] + v.c[3][d][l]);
  }
}

// G = sum (x_k - x_0) c_k^T, eps = sym(G) - I, sigma = 2 mu eps + lambda tr(eps) I, f_i = -V sigma c_i.
PLIANT_KERNEL void force(const ElementPack& pack, double lambda, double mu, ElementVisit& v) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    const auto g = [&](int row, int column) {
      return v.edge[0][row][l] * v.c[1][column][l] + v.edge[1][row][l] * v.c[2][column][l] +
             v.edge[2][row][l] * v.c[3][column][l];
    };
    const double xx = g(0, 0) - 1, yy = g(1, 1) - 1, zz = g(2, 2) - 1;
    const double xy = 0.5 * (g(0, 1) + g(1, 0)), xz = 0.5 * (g(0, 2) + g(2, 0)), yz = 0.5 * (g(1, 2) + g(2, 1));
    const double trace = xx + yy + zz, V = pack.volume[l], m = 2 * mu * V, p = lambda * V * trace;
    v.energy[l] = 0.5 * (m * (xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)) + p * trace);
    const double sxx = m * xx + p, syy = m * yy + p, szz = m * zz + p, sxy = m * xy, sxz = m * xz, syz = m * yz;
    for (int k = 0; k < 4; ++k) {
      const double cx = v.c[k][0][l], cy = v.c[k][1][l], cz = v.c[k][2][l];
      v.f[k][0][l] = -(sxx * cx + sxy * cy + sxz * cz);
      v.f[k][1][l] = -(sxy * cx + syy * cy + syz * cz);
      v.f[k][2][l] = -(sxz * cx + syz * cy + szz * cz);
    }
  }
}

dmat3 gradient_of(const ElementVisit& v, std::size_t l) {
  dmat3 F;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) F[column][row] = v.F[column][row][l];
  return F;
}

}  // namespace

double rest_shape(const std::vector<dvec3>& nodes, const Tet& t, std::array<dvec3, 3>& b) {
  const dvec3 u = nodes[t[1]] - nodes[t[0]], v = nodes[t[2]] - nodes[t[0]], w = nodes[t[3]] - nodes[t[0]];
  const double six_volumes = dot(cross(u, v), w);
  const double longest2 =
      std::max({dot(u, u), dot(v, v), dot(w, w), dot(u - v, u - v), dot(u - w, u - w), dot(v - w, v - w)});
  if (!(std::abs(six_volumes) > 6 * kFlat * longest2 * std::sqrt(longest2))) return 0.0;
  b = {cross(v, w) / six_volumes, cross(w, u) / six_volumes, cross(u, v) / six_volumes};
  return std::abs(six_volumes) / 6;
}

void take_edges(const ElementPack& pack, const std::vector<dvec3>& x, ElementVisit& visit) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    const Tet& t = pack.node[l];
    for (std::size_t k = 0; k < 3; ++k) {
      const dvec3 e = x[t[k + 1]] - x[t[0]];
      visit.edge[k][0][l] = e.x, visit.edge[k][1][l] = e.y, visit.edge[k][2][l] = e.z;
    }
  }
}

void take_gradients(const ElementPack& pack, ElementVisit& visit) {
  deform(pack, visit);
}

void take_rotations(const ElementPack& pack, ElementVisit& visit) {
  deform(pack, visit);
  std::memcpy(visit.q, pack.q, sizeof visit.q);
  std::fill(std::begin(visit.turned), std::end(visit.turned), 0.0);
  const auto settled = [&] {
    for (std::size_t l = 0; l < pack.count; ++l)
      if (visit.turned[l] > kConverged * kConverged) return false;
    return true;
  };
  for (int step = 0; step < kNewtonSteps; ++step) {
    newton(visit);
    if (settled()) break;
  }
  for (std::size_t l = 0; l < pack.count; ++l) {
    if (visit.turned[l] >= 0 && visit.turned[l] <= kConverged * kConverged) continue;
    dquat q(pack.q[0][l], pack.q[1][l], pack.q[2][l], pack.q[3][l]);
    extract_rotation(gradient_of(visit, l), q);
    visit.q[0][l] = q.w, visit.q[1][l] = q.x, visit.q[2][l] = q.y, visit.q[3][l] = q.z;
  }
}

void turn_gradients(const ElementPack& pack, ElementVisit& visit) {
  turn(pack, visit);
}

void take_forces(const ElementPack& pack, double lambda, double mu, ElementVisit& visit) {
  force(pack, lambda, mu, visit);
}

}  // namespace pliant
