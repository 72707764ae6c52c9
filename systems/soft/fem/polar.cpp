#include "systems/soft/fem/polar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace pliant {
namespace {

constexpr int kPolarSteps = 6;
constexpr double kPolarConverged = 1e-6;  // [rad] a smaller step leaves an error of its square
constexpr double kCertainPolar = 1e-7;    // [1] smallest det H over (tr H / 3)^3 that counts as positive
constexpr double kTie = 1e-9;             // [1] of the largest eigenvalue: tolerance for equal eigenvalues

using Matrix4 = std::array<std::array<double, 4>, 4>;

// Eigenvalues on the diagonal of `a`, eigenvectors in the columns of `v`: cyclic Jacobi, converges quadratically.
void diagonalise(Matrix4& a, Matrix4& v) {
  v = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  for (int sweep = 0; sweep < 12; ++sweep) {
    double off = 0, on = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) (i == j ? on : off) += a[i][j] * a[i][j];
    if (off <= 1e-34 * on) return;
    for (int p = 0; p < 3; ++p) {
      for (int r = p + 1; r < 4; ++r) {
        if (a[p][r] == 0.0) continue;
        const double theta = (a[r][r] - a[p][p]) / (2 * a[p][r]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(1 + theta * theta));
        const double c = 1 / std::sqrt(1 + t * t), s = t * c;
        for (int k = 0; k < 4; ++k) {
          const double x = a[k][p], y = a[k][r];
          a[k][p] = c * x - s * y, a[k][r] = s * x + c * y;
        }
        for (int k = 0; k < 4; ++k) {
          const double x = a[p][k], y = a[r][k];
          a[p][k] = c * x - s * y, a[r][k] = s * x + c * y;
        }
        for (int k = 0; k < 4; ++k) {
          const double x = v[k][p], y = v[k][r];
          v[k][p] = c * x - s * y, v[k][r] = s * x + c * y;
        }
      }
    }
  }
}

// tr(R(q)^T F) = q^T N q for a unit quaternion q = (w, x, y, z).
Matrix4 horn(const dmat3& F) {
  const double xx = F[0][0], xy = F[1][0], xz = F[2][0];  // row x of F
  const double yx = F[0][1], yy = F[1][1], yz = F[2][1];
  const double zx = F[0][2], zy = F[1][2], zz = F[2][2];
  return {{{xx + yy + zz, zy - yz, xz - zx, yx - xy},
           {zy - yz, xx - yy - zz, xy + yx, xz + zx},
           {xz - zx, xy + yx, yy - xx - zz, yz + zy},
           {yx - xy, xz + zx, yz + zy, zz - xx - yy}}};
}

}  // namespace

void extract_rotation_globally(const dmat3& F, dquat& q) {
  Matrix4 N = horn(F), V;
  diagonalise(N, V);
  double largest = N[0][0], size = 0;
  for (int i = 0; i < 4; ++i) largest = std::max(largest, N[i][i]), size = std::max(size, std::abs(N[i][i]));
  // Projects the guess onto all eigenvectors that tie for the largest eigenvalue.
  const std::array<double, 4> guess{q.w, q.x, q.y, q.z};
  std::array<double, 4> answer{};
  int first = -1;
  for (int i = 0; i < 4; ++i) {
    if (N[i][i] < largest - kTie * size) continue;
    if (first < 0) first = i;
    double share = 0;
    for (int k = 0; k < 4; ++k) share += V[k][i] * guess[k];
    for (int k = 0; k < 4; ++k) answer[k] += share * V[k][i];
  }
  double norm2 = 0;
  for (const double x : answer) norm2 += x * x;
  if (norm2 < 1e-12) {  // the guess is orthogonal to all
    for (int k = 0; k < 4; ++k) answer[k] = V[k][first];
    norm2 = 1;
  }
  q = normalize(dquat(answer[0], answer[1], answer[2], answer[3]));
}

void extract_rotation(const dmat3& F, dquat& q) {
  const dquat guess = q;
  for (int step = 0; step < kPolarSteps; ++step) {
    const dmat3 B = transpose(mat3_cast(q)) * F;
    const double trace = B[0][0] + B[1][1] + B[2][2];
    const dvec3 a(B[1][2] - B[2][1], B[2][0] - B[0][2], B[0][1] - B[1][0]);
    const double xx = trace - B[0][0], yy = trace - B[1][1], zz = trace - B[2][2];
    const double xy = -0.5 * (B[0][1] + B[1][0]), xz = -0.5 * (B[0][2] + B[2][0]), yz = -0.5 * (B[1][2] + B[2][1]);
    // H^-1 by its adjugate, whose leading entries are the minors that decide whether H is positive definite.
    const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const double czz = xx * yy - xy * xy, cyz = xy * xz - xx * yz, cyy = xx * zz - xz * xz;
    const double det = xx * cxx + xy * cxy + xz * cxz;
    const double mean = (xx + yy + zz) / 3;
    if (!(xx > 0 && czz > 0 && det > kCertainPolar * mean * mean * mean)) break;
    const dvec3 w =
        dvec3(cxx * a.x + cxy * a.y + cxz * a.z, cxy * a.x + cyy * a.y + cyz * a.z, cxz * a.x + cyz * a.y + czz * a.z) /
        det;
    q = normalize(q * dquat(1, 0.5 * w.x, 0.5 * w.y, 0.5 * w.z));
    if (dot(w, w) <= kPolarConverged * kPolarConverged) return;
  }
  q = guess;
  extract_rotation_globally(F, q);
}

}  // namespace pliant
