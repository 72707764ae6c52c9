// A clamped beam against beam theory. Linear tetrahedra lock in bending: they are too stiff by an error quadratic in
// their size, so the extrapolated limit of refinement is tested.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "scenes/tet_shapes.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

// `cells` across the height H; length L along x, width W along z, clamped at x = 0, pushed up at the other end.
struct Beam {
  double L = 0.1, H = 0.0125, W = 0.0125;  // [m]
  TissueMaterial material{.young = 1e5, .poisson = 0.0, .density = 1000};
  int cells = 2;

  double second_moment() const { return W * H * H * H / 12; }
};

class ClampedBeam {
 public:
  explicit ClampedBeam(const Beam& beam)
      : beam_(beam), mesh_(mesh_of(beam)), tissue_(mesh_, beam.material, mesh_.free_count) {
    solver_ = make_solver(SolverKind::kBlockCholesky, tissue_.moving());
    solver_->analyse(tissue_.inner());
    // The load spreads evenly over the end: each node has the area of the end's cells around it.
    share_.assign(mesh_.nodes.size(), 0.0);
    double sum = 0.0;
    const auto edge = [](double at, double end) { return at < 1e-9 || at > end - 1e-9 ? 0.5 : 1.0; };
    for (std::uint32_t i = 0; i < mesh_.free_count; ++i) {
      const dvec3 p = mesh_.nodes[i];
      if (p.x > beam.L - 1e-9) sum += share_[i] = edge(p.y, beam.H) * edge(p.z, beam.W);
    }
    for (double& share : share_) share /= sum;
  }

  // How far the end's middle has moved [m].
  dvec3 tip() const {
    dvec3 tip(0);
    for (std::uint32_t i = 0; i < mesh_.free_count; ++i) tip += share_[i] * (tissue_.position()[i] - mesh_.nodes[i]);
    return tip;
  }
  // At rest under P [N] up at the end, linear.
  double small_deflection(double P) {
    const std::vector<dvec3> push = load(P);
    EXPECT_TRUE(settle_tissue(tissue_, *solver_, dvec3(0), {.push = &push}).solved);
    const double up = tip().y;
    tissue_.position() = mesh_.nodes;
    return up;
  }
  // The same at any size, by steps of T [s] until one moves the end by less than 1e-6 of the length. Jumping to the
  // end of time would not do: K' lacks the stiffness that a pull along the beam gives it, so it overshoots.
  void settle(double P, double T) {
    const std::vector<dvec3> push = load(P);
    for (int i = 0; i < 500; ++i) {
      ASSERT_TRUE(step_tissue(tissue_, *solver_, T, dvec3(0), {.push = &push}).solved);
      double fastest = 0;
      for (const dvec3& v : tissue_.velocity()) fastest = std::max(fastest, length(v));
      if (fastest * T < 1e-6 * beam_.L) return;
    }
    FAIL() << "still moving under " << P << " N";
  }

 private:
  static TetMesh mesh_of(const Beam& beam) {
    const auto cells = [&](double size) {
      return std::max(1, static_cast<int>(std::lround(beam.cells * size / beam.H)));
    };
    TetMesh mesh = tets::box(cells(beam.L), beam.cells, cells(beam.W), dvec3(0), {beam.L, beam.H, beam.W});
    tets::hold(mesh, [](dvec3 p) { return p.x < 1e-9; });
    return mesh;
  }
  std::vector<dvec3> load(double P) const {
    std::vector<dvec3> push;
    for (const double share : share_) push.emplace_back(0, P * share, 0);
    return push;
  }

  Beam beam_;
  TetMesh mesh_;
  Tissue tissue_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> share_;
};

// P L^3 / 3EI + P L / kappa G A, with Cowper's kappa.
double beam_theory(const Beam& beam, double P) {
  const double E = beam.material.young, nu = beam.material.poisson;
  const double G = E / (2 * (1 + nu)), kappa = 10 * (1 + nu) / (12 + 11 * nu);
  return P * std::pow(beam.L, 3) / (3 * E * beam.second_moment()) + P * beam.L / (kappa * G * beam.H * beam.W);
}

TEST(Beam, SmallDeflectionConvergesToBeamTheory) {
  for (const double poisson : {0.0, 0.3}) {
    Beam beam{.L = 0.1, .H = 0.02, .W = 0.01};
    beam.material.poisson = poisson;
    const double P = 1e-5;
    std::array<double, 3> lack;
    for (int i = 0; i < 3; ++i) {
      beam.cells = 2 << i;
      lack[i] = 1 - ClampedBeam(beam).small_deflection(P) / beam_theory(beam, P);
    }
    const double limit = lack[2] - (lack[1] - lack[2]) / 3;  // errors of order two
    EXPECT_GT(std::log2(lack[0] / lack[1]), 1.3) << poisson;
    EXPECT_GT(std::log2(lack[1] / lack[2]), 1.5) << poisson;
    // With a Poisson's ratio the clamp also constrains the cross-section's width, which beam theory neglects.
    EXPECT_NEAR(limit, 0, poisson > 0 ? 0.025 : 0.01);
  }
}

// The table of methods.md 3.3. The beam's own stiffness, including locking, is taken from its small deflection: only
// large rotations are tested here.
TEST(Beam, LargeDeflectionIsTheElastica) {
  constexpr std::array<std::array<double, 3>, 4> kElastica{
      {{1, .30172, .05643}, {2, .49346, .16064}, {5, .71379, .38763}, {10, .81061, .55500}}};
  Beam beam{.L = 0.1, .H = 0.1 / 24, .W = 0.1 / 24};
  ClampedBeam bent(beam);
  const double EI = 1e-5 * std::pow(beam.L, 3) / (3 * bent.small_deflection(1e-5));
  for (const auto& [load, up, back] : kElastica) {
    bent.settle(load * EI / (beam.L * beam.L), 0.1);
    EXPECT_NEAR(bent.tip().y / beam.L, up, 0.005) << load;
    EXPECT_NEAR(-bent.tip().x / beam.L, back, 0.005) << load;
  }
}

}  // namespace
}  // namespace pliant
