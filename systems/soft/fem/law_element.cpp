#include "systems/soft/fem/law_element.h"

#include <cmath>

#include "runtime/kernel.h"

namespace pliant {
namespace {

constexpr int kJacobiSweeps = 4;  // cyclic Jacobi converges quadratically: 1e-12 of the largest after these

inline double above_zero(double x) {
  return x > 0.0 ? x : 0.0;
}

struct alignas(64) DensityLanes {
  ElementLanes I, J, II, IJ, JJ;
};

// Eigenvalues in d, orthonormal eigenvectors in the columns v[.][k], of symmetric matrices a (00 11 22 01 02 12).
struct alignas(64) EigenLanes {
  ElementLanes d[3], off[3], v[3][3];  // off: 01 02 12; v[row][column]
};

PLIANT_KERNEL void turn_pair(EigenLanes& e, int p, int q, int pq, int pr, int qr) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    const double a = e.off[pq][l], difference = e.d[q][l] - e.d[p][l];
    const double t = 2.0 * a * (difference < 0.0 ? -1.0 : 1.0) /
                     (std::abs(difference) + std::sqrt(difference * difference + 4.0 * a * a) + 1e-300);
    const double c = 1.0 / std::sqrt(1.0 + t * t), s = t * c;
    e.d[p][l] -= t * a;
    e.d[q][l] += t * a;
    e.off[pq][l] = 0.0;
    const double x = e.off[pr][l], y = e.off[qr][l];
    e.off[pr][l] = c * x - s * y;
    e.off[qr][l] = s * x + c * y;
    for (int row = 0; row < 3; ++row) {
      const double vp = e.v[row][p][l], vq = e.v[row][q][l];
      e.v[row][p][l] = c * vp - s * vq;
      e.v[row][q][l] = s * vp + c * vq;
    }
  }
}

void diagonalise(EigenLanes& e) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      for (std::size_t l = 0; l < kElementLanes; ++l) e.v[row][column][l] = row == column ? 1.0 : 0.0;
  for (int sweep = 0; sweep < kJacobiSweeps; ++sweep) {
    turn_pair(e, 0, 1, 0, 1, 2);
    turn_pair(e, 0, 2, 1, 0, 2);
    turn_pair(e, 1, 2, 2, 0, 1);
  }
}

// F[row][column] from the edges.
PLIANT_KERNEL void deform_law(const ElementPack& pack, const ElementVisit& v, ElementLanes (&F)[3][3]) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      for (std::size_t l = 0; l < kElementLanes; ++l)
        F[row][column][l] = v.edge[0][row][l] * pack.gradient[0][column][l] +
                            v.edge[1][row][l] * pack.gradient[1][column][l] +
                            v.edge[2][row][l] * pack.gradient[2][column][l];
}

// S = R^T F, symmetric, into e; R[row][column] from q.
PLIANT_KERNEL void stretch(const ElementVisit& visit, const ElementLanes (&F)[3][3], ElementLanes (&R)[3][3],
                           EigenLanes& e) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    const double w = visit.q[0][l], x = visit.q[1][l], y = visit.q[2][l], z = visit.q[3][l];
    R[0][0][l] = 1 - 2 * (y * y + z * z), R[1][0][l] = 2 * (x * y + w * z), R[2][0][l] = 2 * (x * z - w * y);
    R[0][1][l] = 2 * (x * y - w * z), R[1][1][l] = 1 - 2 * (x * x + z * z), R[2][1][l] = 2 * (y * z + w * x);
    R[0][2][l] = 2 * (x * z + w * y), R[1][2][l] = 2 * (y * z - w * x), R[2][2][l] = 1 - 2 * (x * x + y * y);
    const auto s = [&](int i, int j) {
      return R[0][i][l] * F[0][j][l] + R[1][i][l] * F[1][j][l] + R[2][i][l] * F[2][j][l];
    };
    e.d[0][l] = s(0, 0), e.d[1][l] = s(1, 1), e.d[2][l] = s(2, 2);
    e.off[0][l] = 0.5 * (s(0, 1) + s(1, 0));
    e.off[1][l] = 0.5 * (s(0, 2) + s(2, 0));
    e.off[2][l] = 0.5 * (s(1, 2) + s(2, 1));
  }
}

// A of the stretches, symmetric, into e.
PLIANT_KERNEL void stretch_tangent(const ElementLanes (&s)[3], const DensityLanes& psi, EigenLanes& e) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    const double s0 = s[0][l], s1 = s[1][l], s2 = s[2][l];
    const double c0 = s1 * s2, c1 = s0 * s2, c2 = s0 * s1;
    const double ii = 4 * psi.II[l], ij = 2 * psi.IJ[l], jj = psi.JJ[l];
    const auto a = [&](double si, double ci, double sj, double cj) {
      return ii * si * sj + ij * (si * cj + ci * sj) + jj * ci * cj;
    };
    e.d[0][l] = 2 * psi.I[l] + a(s0, c0, s0, c0);
    e.d[1][l] = 2 * psi.I[l] + a(s1, c1, s1, c1);
    e.d[2][l] = 2 * psi.I[l] + a(s2, c2, s2, c2);
    e.off[0][l] = s2 * psi.J[l] + a(s0, c0, s1, c1);
    e.off[1][l] = s1 * psi.J[l] + a(s0, c0, s2, c2);
    e.off[2][l] = s0 * psi.J[l] + a(s1, c1, s2, c2);
  }
}

// dP/dF in the principal axes, projected: A[p][q] among the stretches; in the plane of two axes, P_pq = same F_pq +
// cross F_qp, by the third axis.
struct alignas(64) PrincipalTangent {
  ElementLanes A[3][3], same[3], cross[3];
};

PLIANT_KERNEL void project(const EigenLanes& e, const ElementLanes (&s)[3], const DensityLanes& psi,
                           PrincipalTangent& out) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += above_zero(e.d[k][l]) * e.v[p][k][l] * e.v[q][k][l];
        out.A[p][q][l] = sum;
      }
    for (int k = 0; k < 3; ++k) {
      const double c = s[k][l] * psi.J[l];
      const double alike = above_zero(2 * psi.I[l] - c), opposed = above_zero(2 * psi.I[l] + c);
      out.same[k][l] = 0.5 * (alike + opposed);
      out.cross[k][l] = 0.5 * (alike - opposed);
    }
  }
}

// U K U^T V, K of the gradients g, h in the principal axes.
PLIANT_KERNEL void block(const PrincipalTangent& t, const ElementLanes (&g)[3], const ElementLanes (&h)[3],
                         const ElementLanes (&U)[3][3], const ElementLanes& volume, ElementLanes (&out)[3][3]) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    const double g0 = g[0][l], g1 = g[1][l], g2 = g[2][l], h0 = h[0][l], h1 = h[1][l], h2 = h[2][l], V = volume[l];
    const double k00 = V * (t.A[0][0][l] * g0 * h0 + t.same[2][l] * g1 * h1 + t.same[1][l] * g2 * h2);
    const double k11 = V * (t.A[1][1][l] * g1 * h1 + t.same[2][l] * g0 * h0 + t.same[0][l] * g2 * h2);
    const double k22 = V * (t.A[2][2][l] * g2 * h2 + t.same[1][l] * g0 * h0 + t.same[0][l] * g1 * h1);
    const double k01 = V * (t.A[0][1][l] * g0 * h1 + t.cross[2][l] * g1 * h0);
    const double k10 = V * (t.A[1][0][l] * g1 * h0 + t.cross[2][l] * g0 * h1);
    const double k02 = V * (t.A[0][2][l] * g0 * h2 + t.cross[1][l] * g2 * h0);
    const double k20 = V * (t.A[2][0][l] * g2 * h0 + t.cross[1][l] * g0 * h2);
    const double k12 = V * (t.A[1][2][l] * g1 * h2 + t.cross[0][l] * g2 * h1);
    const double k21 = V * (t.A[2][1][l] * g2 * h1 + t.cross[0][l] * g1 * h2);
    for (int i = 0; i < 3; ++i) {
      const double u0 = U[i][0][l], u1 = U[i][1][l], u2 = U[i][2][l];
      const double m0 = u0 * k00 + u1 * k10 + u2 * k20;
      const double m1 = u0 * k01 + u1 * k11 + u2 * k21;
      const double m2 = u0 * k02 + u1 * k12 + u2 * k22;
      for (int j = 0; j < 3; ++j) out[i][j][l] = m0 * U[j][0][l] + m1 * U[j][1][l] + m2 * U[j][2][l];
    }
  }
}

// out = a b, of 3x3 matrices.
PLIANT_KERNEL void multiply(const ElementLanes (&a)[3][3], const ElementLanes (&b)[3][3], ElementLanes (&out)[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (std::size_t l = 0; l < kElementLanes; ++l)
        out[i][j][l] = a[i][0][l] * b[0][j][l] + a[i][1][l] * b[1][j][l] + a[i][2][l] * b[2][j][l];
}

// I and J of F, cof F.
PLIANT_KERNEL void invariants(const ElementLanes (&F)[3][3], ElementLanes (&cof)[3][3], ElementLanes& I,
                              ElementLanes& J) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        cof[i][j][l] = F[a][c][l] * F[b][d][l] - F[a][d][l] * F[b][c][l];
        sum += F[i][j][l] * F[i][j][l];
      }
    I[l] = sum;
    J[l] = F[0][0][l] * cof[0][0][l] + F[0][1][l] * cof[0][1][l] + F[0][2][l] * cof[0][2][l];
  }
}

// f_i = -V P b_i, P = 2 psi_I F + psi_J cof F.
PLIANT_KERNEL void law_force(const ElementPack& pack, const ElementLanes (&F)[3][3], const ElementLanes (&cof)[3][3],
                             const DensityLanes& psi, ElementVisit& v) {
  for (std::size_t l = 0; l < kElementLanes; ++l)
    for (int d = 0; d < 3; ++d) {
      double sum = 0.0;
      for (int k = 0; k < 3; ++k) {
        double p = 0.0;
        for (int c = 0; c < 3; ++c) p += (2 * psi.I[l] * F[d][c][l] + psi.J[l] * cof[d][c][l]) * pack.gradient[k][c][l];
        v.f[k + 1][d][l] = -pack.volume[l] * p;
        sum += pack.volume[l] * p;
      }
      v.f[0][d][l] = sum;
    }
}

}  // namespace

void take_law_forces(const ElementPack& pack, ElasticLaw law, const LawConstants& material, ElementVisit& visit) {
  alignas(64) ElementLanes F[3][3], cof[3][3], I, J;
  deform_law(pack, visit, F);
  invariants(F, cof, I, J);
  DensityLanes psi{};
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    visit.energy[l] = 0.0;
    if (l >= pack.count) continue;
    const Density at = law(material, I[l], J[l]);
    visit.energy[l] = pack.volume[l] * at.psi;
    psi.I[l] = at.I, psi.J[l] = at.J;
  }
  law_force(pack, F, cof, psi, visit);
}

void take_law_blocks(const ElementPack& pack, ElasticLaw law, const LawConstants& material, const ElementVisit& visit,
                     LawBlocks& blocks) {
  alignas(64) ElementLanes F[3][3], R[3][3], U[3][3];
  EigenLanes e;
  deform_law(pack, visit, F);
  stretch(visit, F, R, e);
  diagonalise(e);
  multiply(R, e.v, U);

  alignas(64) ElementLanes g[3][3];  // V^T b_k
  for (int k = 0; k < 3; ++k)
    for (int p = 0; p < 3; ++p)
      for (std::size_t l = 0; l < kElementLanes; ++l)
        g[k][p][l] = e.v[0][p][l] * pack.gradient[k][0][l] + e.v[1][p][l] * pack.gradient[k][1][l] +
                     e.v[2][p][l] * pack.gradient[k][2][l];

  DensityLanes psi{};
  for (std::size_t l = 0; l < pack.count; ++l) {
    const double s0 = e.d[0][l], s1 = e.d[1][l], s2 = e.d[2][l];
    const Density at = law(material, s0 * s0 + s1 * s1 + s2 * s2, s0 * s1 * s2);
    psi.I[l] = at.I, psi.J[l] = at.J, psi.II[l] = at.II, psi.IJ[l] = at.IJ, psi.JJ[l] = at.JJ;
  }
  EigenLanes among;
  stretch_tangent(e.d, psi, among);
  diagonalise(among);
  PrincipalTangent tangent;
  project(among, e.d, psi, tangent);
  std::size_t n = 0;
  for (int k = 0; k < 3; ++k)
    for (int l = k; l < 3; ++l) block(tangent, g[k], g[l], U, pack.volume, blocks.of[n++]);
}

}  // namespace pliant
