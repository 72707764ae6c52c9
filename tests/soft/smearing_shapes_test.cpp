// Split contacts on surfaces that are not plane (methods.md 2.10): a ball against its series, and beside a right-angled
// edge against cells of the contact's size, which carry it without the split.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "content/mesh/mesh_build.h"
#include "content/tets/lattice.h"
#include "content/tets/surface_samples.h"
#include "content/tets/tet_order.h"
#include "scenes/scenes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/linear_solver.h"
#include "systems/soft/local/smearing_surface.h"

namespace pliant {
namespace {

constexpr double kLongStep = 1e6;     // [s] inertia is nothing against stiffness,
constexpr double kLightMatter = 1e6;  // [kg/m3] but holds a free body

// Tissue of E = 1 Pa in a long step.
class LatticeBody {
 public:
  LatticeBody(const Primitive& surface, double cell, double poisson, const std::function<bool(dvec3)>& pinned)
      : tissue_{1.0, poisson} {
    Result<BuiltMesh> mesh = build_mesh("body", {&surface, 1}, mat4(1.0f));
    EXPECT_TRUE(mesh.ok());
    Result<TetMesh> tets = fill_surface(mesh->mesh, {.cell = cell});
    EXPECT_TRUE(tets.ok());
    tets_ = std::move(*tets);
    std::vector<NodeGroup> group;
    for (const dvec3 p : tets_.nodes) group.push_back(pinned(p) ? NodeGroup::kPinned : NodeGroup::kFree);
    put_in_order(tets_, group);
    tets_.samples = sample_surface(mesh->mesh, tets_);
    surface_ = std::make_unique<SmearingSurface>(tets_, poisson);
    body_ = std::make_unique<Tissue>(
        tets_, TissueMaterial{.young = 1.0, .poisson = poisson, .density = kLightMatter, .strain = Strain::kLinear},
        tets_.free_count);
    body_->assemble(kLongStep, dvec3(0));
    solver_ = make_solver(SolverKind::kBlockCholesky, body_->moving());
    solver_->analyse(body_->inner());
    EXPECT_TRUE(solver_->factorise(body_->inner()));
  }
  SmearedLoad load_at(dvec3 at, dvec3 normal, double own) const { return surface_->load_alone(at, normal, own); }
  // [m] Inwards at the first of these loads, under a unit force inwards at each of them.
  double approach(const std::vector<SmearedLoad>& loads) const {
    Rows x = Rows::Zero(3 * body_->moving(), 1);
    const auto each = [&](const SmearedLoad& load, const auto& use) {
      for (const SmearedNode& part : load.nodes)
        for (int d = 0; d < 3; ++d)
          if (part.node < body_->moving()) use(x(3 * part.node + d, 0), -part.weight * load.place.normal[d]);
    };
    for (const SmearedLoad& load : loads)
      each(load, [](double& force, double weight) { force += kLongStep * kLongStep * weight; });
    solver_->solve_many(x);
    double of_lattice = 0.0;
    each(loads.front(), [&](double u, double weight) { of_lattice += weight * u; });
    return of_lattice + local_normal_compliance(loads.front().place, tissue_, &surface_->layer());
  }
  const LocalElasticity& tissue() const { return tissue_; }

 private:
  LocalElasticity tissue_;
  TetMesh tets_;
  std::unique_ptr<SmearingSurface> surface_;
  std::unique_ptr<Tissue> body_;
  std::unique_ptr<LinearSolver> solver_;
};

// [m/N] A ball of radius 1 and E = 1 between two opposite Gaussian pressures: mean radial displacement under one of
// them. Each Legendre degree has two regular fields, grad(r^n P_n) and r^2 grad(r^n P_n) + alpha x r^n P_n (Love 1927,
// art. 172).
double pressed_ball(double sigma, double nu) {
  constexpr int kPoints = 4000;
  const double mu = 1 / (2 + 2 * nu), lambda = 2 * mu * nu / (1 - 2 * nu), widest = std::min(M_PI, 8 * sigma);
  std::vector<double> z, weight;  // cos(theta); of the pressure
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double theta = widest * (i + 0.5) / kPoints, chord = 2 * std::sin(theta / 2);
    z.push_back(std::cos(theta));
    weight.push_back(std::sin(theta) * std::exp(-chord * chord / (2 * sigma * sigma)));
    sum += weight.back();
  }
  std::vector<double> before(z.size(), 1.0), now = z;  // P_(n-1), P_n
  double total = 2 * (1 - 2 * nu) / (4 * M_PI);        // n = 0: even pressure
  for (int n = 1; n < static_cast<int>(12 / sigma); ++n) {
    if (n % 2 == 0) {
      double g = 0.0;
      for (std::size_t i = 0; i < z.size(); ++i) g += weight[i] / sum * now[i];
      const double alpha = -2 * (n * lambda + (3 * n + 1) * mu) / ((n + 3) * lambda + (n + 5) * mu);
      const double rr1 = 2 * mu * n * (n - 1), rt1 = 2 * mu * (n - 1);
      const double rr2 = lambda * (2 * n + alpha * (n + 3)) + 2 * mu * (n + 1) * (n + alpha);
      const double rt2 = mu * (2 * n + alpha);
      const double b = 1 / (rr2 - rr1 * rt2 / rt1), a = -b * rt2 / rt1;  // sigma_rr = 1, sigma_rt = 0
      total += 2 * (2 * n + 1) / (4 * M_PI) * g * g * (a * n + b * (n + alpha));
    }
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double next = ((2 * n + 1) * z[i] * now[i] - n * before[i]) / (n + 1);
      before[i] = now[i], now[i] = next;
    }
  }
  return total;
}

// Row 8: a ball of five smearing radii.
TEST(SmearingShapes, OnABallOfFiveRadiiThePunchIsThatOfTheBall) {
  const double small = 1e-3;  // of a ball's radius: its surroundings are a half-space
  EXPECT_NEAR(pressed_ball(kSigmaOfRadius * small, 0.3) * 2 * small / (1 - 0.09), 1.0, 5 * small);
  for (const double nu : {0.3, 0.45}) {
    const double radius = 5 * smearing_cells(nu);  // cells
    const LatticeBody ball(scenes::sphere(24, radius), 1.0, nu, [](dvec3) { return false; });
    for (const dvec3 toward : {dvec3(0.36, 0.48, 0.8), dvec3(0.9, 0.1, -0.42), dvec3(0, 1, 0)}) {
      const dvec3 n = normalize(toward);
      for (const double a : {0.25, 0.5}) {
        const double split = ball.approach({ball.load_at(radius * n, n, a), ball.load_at(-radius * n, -n, a)});
        const double truth = pressed_ball(kSigmaOfRadius * a / radius, nu) / radius;
        EXPECT_NEAR(split / truth, 1.0, 0.02) << nu << ' ' << a;
      }
    }
  }
}

// Row 8: 1 and 2 R from a right-angled edge.
TEST(SmearingShapes, BesideAnEdgeThePunchIsThatOfFineCells) {
  constexpr double kNu = 0.3, kHalf = 4.0, kDeep = 6.2, kFine = 0.4;  // [cells]
  const Primitive block = scenes::box(dvec3(2 * kHalf, kDeep, 2 * kHalf), dvec3(0, -0.5 * kDeep, 0));
  const auto pinned = [](dvec3 p) { return p.y < -kDeep + 1e-6; };
  const LatticeBody coarse(block, 1.0, kNu, pinned), fine(block, kFine, kNu, pinned);
  const double R = smearing_cells(kNu), a = kFine * R;
  for (const double from : {1.0, 2.0})
    for (const double along : {-0.3, 0.45}) {
      const dvec3 at(kHalf - from * R, 0, along);
      const double split = coarse.approach({coarse.load_at(at, dvec3(0, 1, 0), a)});
      const double truth = fine.approach({fine.load_at(at, dvec3(0, 1, 0), a)});
      EXPECT_NEAR(split / truth, 1.0, 0.04) << from << " R";
    }
}

}  // namespace
}  // namespace pliant
