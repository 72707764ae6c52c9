// Laws for large strain (systems/soft/fem/law): against finite differences, closed forms, and from shapes that no
// tissue should be in.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "scenes/tet_shapes.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;

struct Case {
  TissueLaw law;
  double poisson, b;
  LawConstants constants() const {
    const double young = 1e4;
    return {young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson)), b};
  }
  TissueMaterial material() const {
    return {.young = 1e4, .poisson = poisson, .density = 1000, .law = law, .stiffening = b};
  }
};
const Case kCases[] = {{TissueLaw::kNeoHookean, 0.0, 1},  {TissueLaw::kNeoHookean, 0.3, 1},
                       {TissueLaw::kNeoHookean, 0.45, 1}, {TissueLaw::kNeoHookean, 0.499, 1},
                       {TissueLaw::kFung, 0.0, 1},        {TissueLaw::kFung, 0.3, 0.0},
                       {TissueLaw::kFung, 0.45, 3},       {TissueLaw::kFung, 0.499, 8}};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << (c.law == TissueLaw::kFung ? "fung" : "neo_hookean") << " nu " << c.poisson << " b " << c.b;
}

dmat3 cofactor(const dmat3& F) {
  return {cross(F[1], F[2]), cross(F[2], F[0]), cross(F[0], F[1])};
}
double invariant(const dmat3& F) {
  return dot(F[0], F[0]) + dot(F[1], F[1]) + dot(F[2], F[2]);
}
Density density_at(const Case& c, const dmat3& F) {
  return elastic_law(c.law)(c.constants(), invariant(F), determinant(F));
}
dmat3 stress(const Case& c, const dmat3& F) {
  const Density psi = density_at(c, F);
  return 2.0 * psi.I * F + psi.J * cofactor(F);
}
// Column n is dP of F's entry n, both column by column.
Matrix9 tangent(const Case& c, const dmat3& F, double step = 1e-5) {
  Matrix9 out;
  for (int n = 0; n < 9; ++n) {
    dmat3 up = F, down = F;
    up[n / 3][n % 3] += step, down[n / 3][n % 3] -= step;
    const dmat3 d = (stress(c, up) - stress(c, down)) / (2 * step);
    for (int m = 0; m < 9; ++m) out(m, n) = d[m / 3][m % 3];
  }
  return out;
}
// Sheared, squashed, inverted, flat, and collapsed ones.
std::vector<dmat3> deformations() {
  std::vector<dmat3> out;
  for (std::uint32_t i = 0; i < 12; ++i) {
    dmat3 F(i % 4 == 3 ? 0.2 : 1.0);
    for (std::uint32_t k = 0; k < 3; ++k) F[k] += (0.1 + 0.1 * i) * tets::scatter(7 * i + k);
    out.push_back(F);
  }
  out.push_back(dmat3(dvec3(1.3, 0, 0), dvec3(0.2, 1, 0), dvec3(0, 0, 0)));
  out.push_back(dmat3(dvec3(1, 0, 0), dvec3(0, 1.1, 0), dvec3(0, 0, -0.7)));
  return out;
}

TEST(ElasticLaw, StressIsTheGradientOfTheEnergy) {
  for (const Case& c : kCases)
    for (const dmat3& F : deformations()) {
      const dmat3 P = stress(c, F);
      double size = c.constants().mu;
      for (int n = 0; n < 9; ++n) size = std::max(size, std::abs(P[n / 3][n % 3]));
      const double step = 1e-6;
      for (int n = 0; n < 9; ++n) {
        dmat3 up = F, down = F;
        up[n / 3][n % 3] += step, down[n / 3][n % 3] -= step;
        const double slope = (density_at(c, up).psi - density_at(c, down).psi) / (2 * step);
        EXPECT_NEAR(slope, P[n / 3][n % 3], 1e-6 * size) << c << ' ' << n;
      }
    }
}

// One tetrahedron's K' against B^T H B, H from differences of the stress, negative eigenvalues removed.
TEST(ElasticLaw, StiffnessIsTheTangentWithoutItsNegativeEigenvalues) {
  TetMesh mesh;
  mesh.nodes = {dvec3(0), dvec3(1.1, 0.1, 0), dvec3(0.2, 0.9, -0.1), dvec3(0.1, 0.2, 1.2)};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.free_count = 4;
  std::array<dvec3, 3> b;
  const double V = rest_shape(mesh.nodes, mesh.tets[0], b);
  int negative = 0;
  for (const Case& c : kCases)
    for (const dmat3& F : deformations()) {
      Tissue tissue(mesh, c.material(), 4);
      for (std::size_t i = 0; i < 4; ++i) tissue.position()[i] = F * mesh.nodes[i] + dvec3(3, 1, 2);
      tissue.assemble(1.0, dvec3(0));
      Eigen::MatrixXd K = tissue.inner().dense();
      for (int i = 0; i < 12; ++i) K(i, i) -= tissue.mass()[static_cast<std::size_t>(i / 3)];
      Matrix9 H = tangent(c, F);
      H = 0.5 * (H + H.transpose()).eval();
      const Eigen::SelfAdjointEigenSolver<Matrix9> eigen(H);
      negative += eigen.eigenvalues()[0] < -1e-3 * eigen.eigenvalues()[8];
      H = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
      Eigen::MatrixXd B = Eigen::MatrixXd::Zero(9, 12);  // F of the positions
      for (int k = 0; k < 4; ++k) {
        const dvec3 grad = k ? b[static_cast<std::size_t>(k - 1)] : -(b[0] + b[1] + b[2]);
        for (int n = 0; n < 9; ++n) B(n, 3 * k + n % 3) = grad[n / 3];
      }
      const Eigen::MatrixXd exact = V * B.transpose() * H * B;
      EXPECT_LT((K - exact).norm(), 1e-6 * exact.norm()) << c;
      Eigen::VectorXd f(12);
      for (int k = 0; k < 12; ++k) f[k] = tissue.elastic_force()[k];
      Eigen::Matrix<double, 9, 1> P;
      const dmat3 p = stress(c, F);
      for (int n = 0; n < 9; ++n) P[n] = p[n / 3][n % 3];
      EXPECT_LT((f + V * B.transpose() * P).norm(), 1e-12 * (f.norm() + V * c.constants().mu)) << c;
    }
  EXPECT_GT(negative, 20);
}

TEST(ElasticLaw, AtRestItIsHookesLaw) {
  for (const Case& c : kCases) {
    const LawConstants m = c.constants();
    EXPECT_NEAR(density_at(c, dmat3(1)).psi, 0.0, 1e-12 * m.mu) << c;
    const dmat3 P = stress(c, dmat3(1));
    for (int n = 0; n < 9; ++n) EXPECT_NEAR(P[n / 3][n % 3], 0.0, 1e-9 * m.mu) << c;
    Matrix9 hooke = Matrix9::Zero();
    for (int n = 0; n < 9; ++n) {
      hooke(n, n) += m.mu;
      hooke(n, 3 * (n % 3) + n / 3) += m.mu;
      if (n % 4 == 0)
        for (int k = 0; k < 9; k += 4) hooke(n, k) += m.lambda;
    }
    EXPECT_LT((tangent(c, dmat3(1)) - hooke).norm(), 1e-6 * hooke.norm()) << c;
  }
}

// A stationary point has equal stretches, but for signs (of P = 0 in the principal axes).
TEST(ElasticLaw, RestIsTheOnlyMinimum) {
  for (const Case& c : kCases)
    for (int i = 1; i < 300; ++i) {
      const double s = 0.01 * i;
      if (i == 100) continue;
      const double slope = stress(c, dmat3(s))[0][0];
      EXPECT_GT(i < 100 ? -slope : slope, 0.0) << c << " at " << s;
    }
}

TetMesh shaken_cube(int n) {
  TetMesh mesh = tets::box(n, n, n, dvec3(0), dvec3(0.1));
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) mesh.nodes[i] += 0.15 * 0.1 / n * tets::scatter(i);
  return mesh;
}
TetMesh held_cube() {
  TetMesh mesh = tets::box(3, 3, 3, dvec3(0), dvec3(0.1));
  tets::hold(mesh, [](dvec3 p) { return std::min({p.x, p.y, p.z, 0.1 - p.x, 0.1 - p.y, 0.1 - p.z}) < 1e-9; });
  for (std::uint32_t i = 0; i < mesh.free_count; ++i) mesh.nodes[i] += 0.005 * tets::scatter(i);
  return mesh;
}
std::unique_ptr<LinearSolver> law_solver(const Tissue& tissue) {
  auto solver = make_solver(SolverKind::kEigenCholesky, tissue.moving());
  solver->analyse(tissue.inner());
  return solver;
}
dvec3 force_sum(const Tissue& tissue, const std::function<bool(dvec3)>& of, const TetMesh& mesh) {
  dvec3 sum(0);
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
    if (of(mesh.nodes[i]))
      for (int k = 0; k < 3; ++k) sum[k] += tissue.elastic_force()[3 * i + k];
  return sum;
}

TEST(ElasticLaw, PatchUnderALargeUniformStrainIsSolvedExactly) {
  const TetMesh mesh = held_cube();
  const dmat3 F = dmat3(1) + 0.1 * dmat3(3, 1, -2, 0.5, -1, 2, 1, 4, 2);
  for (const Case& c : kCases) {
    Tissue tissue(mesh, c.material(), mesh.free_count);
    auto solver = law_solver(tissue);
    for (std::uint32_t i = mesh.free_count; i < mesh.node_count(); ++i) tissue.position()[i] = F * mesh.nodes[i];
    settle_tissue(tissue, *solver, dvec3(0), {.iterations = 60, .tolerance = 1e-14});
    for (std::uint32_t i = 0; i < mesh.free_count; ++i)
      EXPECT_LT(length(tissue.position()[i] - F * mesh.nodes[i]), 1e-10) << c << ' ' << i;
  }
}

TEST(ElasticLaw, ARigidMotionTurnsForcesAndKeepsEnergy) {
  const TetMesh mesh = shaken_cube(2);
  const dmat3 Q = glm::mat3_cast(glm::angleAxis(1.9, normalize(dvec3(1, -2, 0.5))));
  for (const Case& c : kCases) {
    Tissue still(mesh, c.material(), mesh.node_count()), turned = still;
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
      const dvec3 x = mesh.nodes[i] + 0.02 * tets::scatter(90 + i);
      still.position()[i] = x, turned.position()[i] = Q * x + dvec3(5, -3, 2);
    }
    still.find_forces(), turned.find_forces();
    EXPECT_NEAR(turned.elastic_energy(), still.elastic_energy(), 1e-10 * still.elastic_energy()) << c;
    double most = 0.0, off = 0.0;
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
      dvec3 f, g;
      for (int k = 0; k < 3; ++k) f[k] = still.elastic_force()[3 * i + k], g[k] = turned.elastic_force()[3 * i + k];
      most = std::max(most, length(f)), off = std::max(off, length(Q * f - g));
    }
    EXPECT_LT(off, 1e-9 * most) << c;
  }
}

TEST(ElasticLaw, ForcesOnAFreeBodySumToNothing) {
  const TetMesh mesh = shaken_cube(3);
  for (const Case& c : kCases) {
    Tissue tissue(mesh, c.material(), mesh.node_count());
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) tissue.position()[i] += 0.01 * tets::scatter(50 + i);
    tissue.find_forces();
    dvec3 sum(0), torque(0);
    double size = 0.0;
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
      dvec3 f;
      for (int k = 0; k < 3; ++k) f[k] = tissue.elastic_force()[3 * i + k];
      sum += f, torque += cross(tissue.position()[i], f), size += length(f);
    }
    EXPECT_LT(length(sum), 1e-12 * size) << c;
    EXPECT_LT(length(torque), 1e-12 * 0.2 * size) << c;
  }
}

// The stretch across a bar drawn by s, from P across = 0.
double lateral(const Case& c, double s) {
  double low = 0.2, high = 3.0;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (low + high);
    (stress(c, dmat3(dvec3(s, 0, 0), dvec3(0, mid, 0), dvec3(0, 0, mid)))[1][1] < 0 ? low : high) = mid;
  }
  return low;
}

TEST(ElasticLaw, ABarPulledAndSquashedHasTheClosedForm) {
  const TetMesh mesh = held_cube();
  for (const double s : {0.4, 0.7, 1.5, 2.0}) {
    // Stable Neo-Hookean: s2^2 = (a - mu/(l s)) / s, sigma = mu s + l (J - a) s2^2.
    const Case hooke{TissueLaw::kNeoHookean, 0.45, 1};
    const LawConstants m = hooke.constants();
    const double l = m.lambda + m.mu, a = 1 + m.mu / l, across2 = (a - m.mu / (l * s)) / s;
    EXPECT_NEAR(lateral(hooke, s), std::sqrt(across2), 1e-9);
    // Nearly incompressible: mu (s - s^-2), times e^(b (I - 3)) for Fung's.
    for (const Case& c : {hooke, Case{TissueLaw::kNeoHookean, 0.4999, 1}, Case{TissueLaw::kFung, 0.4999, 0.8}}) {
      const double s2 = lateral(c, s), sigma = m.mu * s + l * (s * across2 - a) * across2;
      const double I = s * s + 2 / s, soft = c.constants().mu * (s - 1 / (s * s));
      const double want = c.poisson == 0.45 ? sigma : c.law == TissueLaw::kFung ? soft * std::exp(c.b * (I - 3)) : soft;
      Tissue tissue(mesh, c.material(), mesh.free_count);
      auto solver = law_solver(tissue);
      for (std::uint32_t i = mesh.free_count; i < mesh.node_count(); ++i)
        tissue.position()[i] = dvec3(s, s2, s2) * mesh.nodes[i];
      settle_tissue(tissue, *solver, dvec3(0), {.iterations = 100, .tolerance = 1e-13});
      tissue.find_forces();
      const dvec3 end = force_sum(
          tissue, [](dvec3 p) { return p.x > 0.1 - 1e-9; }, mesh);
      const dvec3 half = force_sum(
          tissue, [](dvec3 p) { return p.y > 0.05; }, mesh);
      EXPECT_NEAR(-end.x / 0.01, want, (c.poisson == 0.45 ? 1e-6 : 1e-2) * std::abs(want)) << c << " s " << s;
      EXPECT_LT(std::abs(half.y) / 0.01, 1e-5 * std::abs(want)) << c << " s " << s;
    }
  }
}

TEST(ElasticLaw, ASimpleShearHasTheClosedForm) {
  const TetMesh mesh = held_cube();
  for (const double shear : {0.2, 1.0, 1.5})
    for (const Case& c : kCases) {
      Tissue tissue(mesh, c.material(), mesh.free_count);
      auto solver = law_solver(tissue);
      for (std::uint32_t i = mesh.free_count; i < mesh.node_count(); ++i)
        tissue.position()[i] = mesh.nodes[i] + dvec3(shear * mesh.nodes[i].y, 0, 0);
      settle_tissue(tissue, *solver, dvec3(0), {.iterations = 100, .tolerance = 1e-13});
      tissue.find_forces();
      // tau = mu shear, times e^(b shear^2) for Fung's.
      const double stiffer = c.law == TissueLaw::kFung ? std::exp(c.b * shear * shear) : 1.0;
      const double want = c.constants().mu * shear * stiffer;
      const dvec3 top = force_sum(
          tissue, [](dvec3 p) { return p.y > 0.1 - 1e-9; }, mesh);
      EXPECT_NEAR(-top.x / 0.01, want, 1e-6 * want) << c << " shear " << shear;
    }
}

enum class Start { kInverted, kFlat, kPoint, kRandom };

void put(Tissue& tissue, const TetMesh& mesh, Start start) {
  for (std::uint32_t i = 0; i < mesh.free_count; ++i) {
    dvec3& x = tissue.position()[i];
    if (start == Start::kInverted) x.y = -x.y;
    if (start == Start::kFlat) x.y = 0.0;
    if (start == Start::kPoint) x = dvec3(0.05) + 1e-4 * tets::scatter(300 + i);
    if (start == Start::kRandom) x += 0.03 * tets::scatter(300 + i);  // by a cell
  }
}

// As the engine steps: one linearised step of 1/60 s after another.
TEST(ElasticLaw, TissueRecoversFromInvertedFlatCollapsedAndRandomShapesWithoutGainingEnergy) {
  TetMesh mesh = shaken_cube(3);
  tets::hold(mesh, [](dvec3 p) { return p.x < 0.015; });
  for (const Case& c : kCases)
    for (const Start start : {Start::kInverted, Start::kFlat, Start::kPoint, Start::kRandom}) {
      Tissue tissue(mesh, c.material(), mesh.free_count);
      auto solver = law_solver(tissue);
      put(tissue, mesh, start);
      const double rest = 1e-12 * c.constants().mu * 1e-3;  // of the block's volume
      double last = tissue.elastic_energy();
      for (int i = 0; i < 1500 && last > rest; ++i) {
        step_tissue(tissue, *solver, 1.0 / 60, dvec3(0));
        const double now = tissue.elastic_energy() + kinetic_energy(tissue);
        ASSERT_LE(now, last * (1 + 1e-8)) << c << " start " << static_cast<int>(start) << " step " << i;
        last = now;
      }
      // Nearly incompressible, neighbours that are inside of each other may stay so: another minimum of the whole mesh.
      if (start == Start::kRandom && c.poisson > 0.45) continue;
      double off = 0.0;
      for (std::uint32_t k = 0; k < mesh.free_count; ++k)
        off = std::max(off, length(tissue.position()[k] - mesh.nodes[k]));
      EXPECT_LT(off, 1e-5) << c << " start " << static_cast<int>(start);
    }
}

}  // namespace
}  // namespace pliant
