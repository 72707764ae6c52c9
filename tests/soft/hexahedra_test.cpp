// Whole cells weighted by their tissue, against closed forms: beams and bars of some four cells across, fitted and cut,
// sag, and the rise of a contact's force towards nu = 1/2.
#include <gtest/gtest.h>

#include <cmath>

#include "content/level/spawn_soft.h"
#include "content/mesh/mesh_build.h"
#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

constexpr double kLong = 1e5;  // [s] of a step: inertia is nothing against stiffness

TetMesh cells_of(const Primitive& p, double cell, const mat4& frame = mat4(1)) {
  const Result<BuiltMesh> surface = build_mesh("body", {&p, 1}, frame);
  EXPECT_TRUE(surface.ok());
  LatticeOptions options;
  options.cell = cell;
  options.elements = Elements::kHexahedra;
  Result<TetMesh> mesh = fill_surface(surface->mesh, options);
  EXPECT_TRUE(mesh.ok());
  return std::move(*mesh);
}

// A bar from x = 0 to L, its square section of side 1 turned by `turn` [rad], clamped at x = 0.
class CutBar {
 public:
  static constexpr double L = 4.0;
  CutBar(double cell, double turn, double poisson) : poisson_(poisson) {
    const mat4 frame = glm::rotate(mat4(1), static_cast<float>(turn), vec3(1, 0, 0));
    mesh_ = cells_of(scenes::box({L, 1, 1}, {L / 2, 0, 0}), cell, frame);
    tets::hold(mesh_, [](dvec3 p) { return p.x < 1e-6; });
    for (const dvec3& p : mesh_.nodes) end_.push_back(p.x > L - 1e-6);
  }
  std::size_t size() const { return mesh_.tets.size(); }
  double shear() const { return 0.5 / (1 + poisson_); }
  double kappa() const { return 10 * (1 + poisson_) / (12 + 11 * poisson_); }

  // [1] Of the tip under a force there, over Timoshenko's.
  double bends() const {
    double whole = 0.0;
    std::vector<dvec3> push(mesh_.node_count(), dvec3(0));
    for (std::size_t i = 0; i < push.size(); ++i) whole += end_[i] ? mesh_.volume[i] : 0.0;
    for (std::size_t i = 0; i < push.size(); ++i) push[i].y = end_[i] ? mesh_.volume[i] / whole : 0.0;
    return tip(push) / (L * L * L / 3 * 12 + L / (kappa() * shear()));
  }
  // [1] Of the tip under a weight of 1 along the bar's length.
  double sags() const {
    std::vector<dvec3> push(mesh_.node_count(), dvec3(0));
    for (std::size_t i = 0; i < push.size(); ++i) push[i].y = mesh_.volume[i];
    return tip(push) / (L * L * L * L / 8 * 12 + L * L / (2 * kappa() * shear()));
  }
  // [1] Of the torque that twists the end, over Saint-Venant's.
  double twists() const {
    TetMesh held = mesh_;
    tets::hold(held, [](dvec3 p) { return p.x < 1e-6 || p.x > L - 1e-6; });
    Tissue tissue = tissue_of(held);
    const double angle = 1e-3;
    for (std::uint32_t i = held.free_count; i < held.node_count(); ++i)
      if (const dvec3 p = held.nodes[i]; p.x > 1) tissue.velocity()[i] = angle / kLong * dvec3(0, -p.z, p.y);
    auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
    solver->analyse(tissue.inner());
    EXPECT_TRUE(step_tissue(tissue, *solver, kLong, dvec3(0)).solved);
    tissue.find_forces();
    double torque = 0.0;
    for (std::uint32_t i = held.free_count; i < held.node_count(); ++i) {
      const dvec3 p = held.nodes[i], f(tissue.elastic_force()[3 * i], tissue.elastic_force()[3 * i + 1],
                                       tissue.elastic_force()[3 * i + 2]);
      if (p.x > 1) torque -= cross(p, f).x;
    }
    return torque / (shear() * 0.1406 * angle / L);
  }

 private:
  Tissue tissue_of(const TetMesh& mesh) const {
    return Tissue(mesh, {.young = 1.0, .poisson = poisson_, .density = 1e-9, .strain = Strain::kLinear},
                  mesh.free_count);
  }
  double tip(std::vector<dvec3> push) const {
    for (dvec3& f : push) f *= 1e-6;
    Tissue tissue = tissue_of(mesh_);
    auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
    solver->analyse(tissue.inner());
    EXPECT_TRUE(settle_tissue(tissue, *solver, dvec3(0), {.push = &push}).solved);
    double up = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < push.size(); ++i)
      if (end_[i]) {
        whole += mesh_.volume[i];
        up += mesh_.volume[i] * (tissue.position()[i].y - mesh_.nodes[i].y);
      }
    return 1e6 * up / whole;
  }
  double poisson_;
  TetMesh mesh_;
  std::vector<bool> end_;
};

// The clamp, which keeps the section from widening, is missing in beam theory: it is worth 2 %, which a bar of twelve
// cells across shows.
TEST(Hexahedra, ABarOfThreeToFiveCellsAcrossIsWithinFivePercentHoweverItIsCut) {
  const CutBar fine(1.0 / 12, 0.0, 0.3);
  const double bend = fine.bends(), sag = fine.sags();
  EXPECT_NEAR(bend, 0.98, 0.01);
  EXPECT_NEAR(sag, 0.975, 0.01);
  for (const double turn : {0.0, 0.2, 0.4, 0.6, M_PI / 4})
    for (const double cell : {1.0 / 3, 0.29, 0.25, 0.22}) {
      const CutBar bar(cell, turn, 0.3);
      EXPECT_NEAR(bar.bends() / bend, 1.0, 0.02) << turn << ' ' << cell;
      EXPECT_NEAR(bar.sags() / sag, 1.0, 0.02) << turn << ' ' << cell;
      EXPECT_NEAR(bar.twists(), 1.0, 0.05) << turn << ' ' << cell;
    }
}

// Constant strain costs no force at nodes whose cells are whole, a rigid motion none at all.
TEST(Hexahedra, PassThePatchTestAndTurnWithoutForce) {
  TetMesh mesh = cells_of(scenes::box({1, 1, 1}), 0.2, glm::rotate(mat4(1), 0.5f, vec3(1, 2, 3)));
  Tissue tissue(mesh, {.young = 1.0, .poisson = 0.3, .density = 1e-9}, mesh.free_count);
  const dmat3 turn = glm::mat3_cast(glm::angleAxis(1.1, normalize(dvec3(1, -2, 0.5))));
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) tissue.position()[i] = turn * mesh.nodes[i] + dvec3(1, 2, 3);
  tissue.find_forces();
  EXPECT_LT(tissue.elastic_force().cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(tissue.elastic_energy(), 1e-20);

  std::vector<double> whole(mesh.node_count(), 0.0);
  for (const LatticeCell& cell : mesh.cells)
    for (const std::uint32_t node : cell.nodes) whole[node] += cell.share;
  const dmat3 strain(1.01, 0.002, 0.003, 0.002, 0.99, -0.004, 0.003, -0.004, 1.02);
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) tissue.position()[i] = turn * strain * mesh.nodes[i];
  tissue.find_forces();
  std::size_t inner = 0;
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
    if (whole[i] == 8.0) {
      ++inner;
      for (int d = 0; d < 3; ++d) EXPECT_NEAR(tissue.elastic_force()[3 * i + d], 0.0, 1e-12);
    }
  EXPECT_GT(inner, 10u);
}

// The assembled matrix is minus the derivative of the force at rest, and the force minus that of the energy.
TEST(Hexahedra, MatrixForceAndEnergyAgree) {
  TetMesh mesh = cells_of(scenes::box({1, 1, 1}), 0.34, glm::rotate(mat4(1), 0.5f, vec3(1, 2, 3)));
  Tissue tissue(mesh, {.young = 1.0, .poisson = 0.4, .density = 1e-9}, mesh.free_count);
  const double T = 1.0, h = 1e-6;
  tissue.assemble(T, dvec3(0));
  const auto forces = [&](std::size_t node, int d, double by) {
    tissue.position() = mesh.nodes;
    tissue.position()[node][d] += by;
    tissue.find_forces();
    return tissue.elastic_force();
  };
  const BlockMatrix matrix = tissue.inner();
  for (const std::uint32_t node : {0u, 7u, 20u})
    for (int d = 0; d < 3; ++d) {
      const Vector slope = (forces(node, d, h) - forces(node, d, -h)) / (2 * h);
      double up = 0.0, down = 0.0;
      for (std::uint32_t row = 0; row < mesh.node_count(); ++row)
        for (std::uint32_t k = matrix.first[row]; k < matrix.first[row + 1]; ++k)
          if (matrix.column[k] == node)
            for (int r = 0; r < 3; ++r) EXPECT_NEAR(matrix.value[k](r, d), -slope[3 * row + r], 1e-7);
      (void)forces(node, d, 1e-3 + h), up = tissue.elastic_energy();
      (void)forces(node, d, 1e-3 - h), down = tissue.elastic_energy();
      const Vector there = forces(node, d, 1e-3);
      EXPECT_NEAR(there[3 * node + d], -(up - down) / (2 * h), 2e-3 * std::abs(there[3 * node + d]) + 1e-9);
    }
}

// Discs pressed into a bonded layer without friction, F = 2 E a kappa d / (1 - nu^2). The radius that its nodes stand
// for is taken from the force at 0.3, by the table of Hayes et al. (1972); then the force at 0.499 is compared. ln
// kappa by the cubic through a / h = 0.2, 0.4, 1 and 2.
double hayes(const double (&kappa)[4], double a) {
  constexpr double kAt[] = {0.2, 0.4, 1.0, 2.0};
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    double term = std::log(kappa[i]);
    for (int k = 0; k < 4; ++k)
      if (k != i) term *= (a - kAt[k]) / (kAt[i] - kAt[k]);
    sum += term;
  }
  return std::exp(sum);
}

TEST(Hexahedra, DoNotLockUnderAContactOnABondedLayer) {
  constexpr double kWide = 4.0;
  constexpr double k3[] = {1.2066, 1.4726, 2.4835, 4.3532}, k499[] = {1.2800, 1.6817, 3.6044, 9.0583};
  for (const double cell : {0.5, 1.0 / 3, 0.25}) {
    TetMesh mesh = cells_of(scenes::box({2 * kWide, 1, 2 * kWide}, {0, -0.5, 0}), cell);
    const auto under = [](dvec3 p) { return p.y > -1e-6 && std::hypot(p.x, p.z) < 1.0001; };
    tets::hold(mesh, [](dvec3 p) { return p.y < -1 + 1e-6; });
    const auto force = [&](double poisson) {
      Tissue tissue(mesh, {.young = 1, .poisson = poisson, .density = 1e-9, .strain = Strain::kLinear},
                    mesh.free_count);
      tissue.assemble(1.0, dvec3(0));
      const double stiff = 1e5;  // a spring on each node below the disc
      Rows u = Rows::Zero(3 * mesh.free_count, 1);
      for (std::uint32_t i = 0; i < mesh.free_count; ++i)
        if (under(mesh.nodes[i])) {
          tissue.inner().value[tissue.inner().diagonal[i]](1, 1) += stiff;
          u(3 * i + 1, 0) = -stiff;
        }
      auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
      solver->analyse(tissue.inner());
      EXPECT_TRUE(solver->factorise(tissue.inner()));
      solver->solve_many(u);
      double sum = 0.0;
      for (std::uint32_t i = 0; i < mesh.free_count; ++i)
        if (under(mesh.nodes[i])) sum += stiff * (1 + u(3 * i + 1, 0));
      return sum;
    };
    const double usual = force(0.3);
    double low = 0.2, high = 2.0;
    for (int n = 0; n < 50; ++n) {
      const double a = 0.5 * (low + high);
      (2 * a * hayes(k3, a) / (1 - 0.09) < usual ? low : high) = a;
    }
    const double exact = 2 * low * hayes(k499, low) / (1 - 0.499 * 0.499);
    EXPECT_NEAR(force(0.499) / exact, 1.0, 0.05) << cell;
  }
}

// A bar of two materials in series, nu = 0: the stress is the same in both where the stiffer half stretches less by its
// factor. Both kinds of elements.
TEST(Hexahedra, AndTetrahedraTakeTheirFactorsOnStiffness) {
  for (const bool cells : {false, true}) {
    TetMesh mesh =
        cells ? cells_of(scenes::box({4, 1, 1}, {2, 0.5, 0.5}), 0.5) : tets::box(8, 2, 2, dvec3(0), {4, 1, 1});
    for (std::size_t e = 0; e < (cells ? mesh.cells.size() : mesh.tets.size()); ++e) {
      dvec3 middle(0);
      if (cells)
        for (const std::uint32_t n : mesh.cells[e].nodes) middle += mesh.nodes[n] / 8.0;
      else
        for (const std::uint32_t n : mesh.tets[e]) middle += mesh.nodes[n] / 4.0;
      mesh.factors.push_back({middle.x < 2 ? 1.0 : 4.0, 1.0});
    }
    Tissue tissue(mesh, {.young = 10, .poisson = 0.0, .density = 1e-9, .strain = Strain::kLinear}, mesh.free_count);
    const double strain = 1e-3;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const double x = mesh.nodes[i].x;
      tissue.position()[i].x += strain * (std::min(x, 2.0) + 0.25 * std::max(0.0, x - 2.0));
    }
    tissue.find_forces();
    double end = 0.0;
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
      const double x = mesh.nodes[i].x, f = tissue.elastic_force()[3 * i];
      if (x > 4 - 1e-6) end -= f;
      if (x > 1e-6 && x < 4 - 1e-6) EXPECT_NEAR(f, 0.0, 1e-13) << cells;
    }
    EXPECT_NEAR(end, 10 * strain, 1e-12) << cells;
  }
}

// Twice the factor on damping is twice beta.
TEST(Hexahedra, AndTetrahedraTakeTheirFactorsOnDamping) {
  for (const bool cells : {false, true}) {
    TetMesh mesh = cells ? cells_of(scenes::box({1, 1, 1}), 0.5) : tets::box(2, 2, 2, dvec3(-0.5), dvec3(0.5));
    const auto moved = [&](double factor, double beta) {
      TetMesh damped = mesh;
      damped.factors.assign(cells ? mesh.cells.size() : mesh.tets.size(), {1.0, factor});
      tets::hold(damped, [](dvec3 p) { return p.x < -0.5 + 1e-6; });
      Tissue tissue(damped, {.young = 100, .poisson = 0.3, .density = 1, .beta = beta}, damped.free_count);
      auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
      solver->analyse(tissue.inner());
      EXPECT_TRUE(step_tissue(tissue, *solver, 0.01, dvec3(0, -9.81, 0)).solved);
      return tissue.position();
    };
    const std::vector<dvec3> factor = moved(2.0, 0.05), beta = moved(1.0, 0.1), plain = moved(1.0, 0.05);
    double off = 0.0, differs = 0.0;
    for (std::size_t i = 0; i < factor.size(); ++i) {
      off = std::max(off, length(factor[i] - beta[i]));
      differs = std::max(differs, length(factor[i] - plain[i]));
    }
    EXPECT_LT(off, 1e-15);
    EXPECT_GT(differs, 1e-6);
  }
}

// A step of strain relaxes by the series; where the factor is 0, not at all.
TEST(Hexahedra, AndTetrahedraRelaxByTheirFactors) {
  Prony prony{.count = 1, .arms = {Prony::Arm{0.6, 0.5}}};
  for (const bool cells : {false, true})
    for (const double factor : {0.0, 0.5, 1.0}) {
      TetMesh mesh = cells ? cells_of(scenes::box({1, 1, 1}), 0.34) : tets::box(2, 2, 2, dvec3(-0.5), dvec3(0.5));
      mesh.factors.assign(cells ? mesh.cells.size() : mesh.tets.size(), {1.0, 1.0, factor});
      Tissue tissue(mesh, {.young = 1.0, .poisson = 0.3, .prony = prony}, mesh.node_count());
      for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
        const dvec3 p = mesh.nodes[i];
        tissue.position()[i] += 0.1 * dvec3(p.x * p.y, p.y * p.z + 0.2 * p.x, p.x * p.z);
      }
      tissue.end_step(0.0), tissue.find_forces();
      const Vector at_once = tissue.elastic_force();
      for (const double T : {1e-3, 0.3, 2.0}) tissue.end_step(T);
      tissue.find_forces();
      const double stays = 1 - 0.6 * factor * (1 - std::exp(-2.301 / 0.5));
      EXPECT_LT((tissue.elastic_force() - stays * at_once).norm(), 1e-9 * at_once.norm()) << cells << factor;
    }
}

}  // namespace
}  // namespace pliant
