// The quadratic twin itself against closed forms of bars, and linear tetrahedra beside it in bending and torsion.
#include <gtest/gtest.h>

#include <cmath>

#include "systems/soft/fem/tissue_step.h"
#include "scenes/quadratic_block.h"

namespace pliant {
namespace {

constexpr double kBarLength = 0.4, kBarSide = 0.1, kBarYoung = 1e4, kBarNu = 0.3;  // [m], [Pa]
constexpr double kBarShear = kBarYoung / (2 * (1 + kBarNu));
const LawConstants kBarLaw{kBarShear, kBarYoung* kBarNu / ((1 + kBarNu) * (1 - 2 * kBarNu)), 0.0};

using PlateMotion = std::function<dvec3(dvec3, double)>;

// The far plate is moved across without turning, or turned about the bar's axis.
PlateMotion across(double way) {
  return [way](dvec3 p, double share) { return p + dvec3(0, share * way, 0); };
}
PlateMotion turned(double angle) {
  return [angle](dvec3 p, double share) {
    const dvec3 axis(p.x, 0.5 * kBarSide, 0.5 * kBarSide);
    return axis + glm::angleAxis(share * angle, dvec3(1, 0, 0)) * (p - axis);
  };
}

QuadraticBlock twin_bar(int cells) {
  return {{4 * cells, cells, cells}, {kBarLength, kBarSide, kBarSide}, elastic_law(TissueLaw::kNeoHookean), kBarLaw};
}

// Of linear tetrahedra.
QuadraticBlock::Load linear_bar(int cells, TissueLaw law, const PlateMotion& place) {
  TetMesh mesh = tets::box(4 * cells, cells, cells, dvec3(0), {kBarLength, kBarSide, kBarSide});
  tets::hold(mesh, [](dvec3 p) { return p.x < 1e-9 || p.x > kBarLength - 1e-9; });
  Tissue tissue(mesh, {.young = kBarYoung, .poisson = kBarNu, .density = 1000, .law = law}, mesh.free_count);
  auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
  solver->analyse(tissue.inner());
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
    tissue.position()[i] += mesh.nodes[i].x / kBarLength * (place(mesh.nodes[i], 1.0) - mesh.nodes[i]);
  EXPECT_TRUE(settle_tissue(tissue, *solver, dvec3(0), {.iterations = 100, .tolerance = 1e-9}).solved);
  tissue.find_forces();
  QuadraticBlock::Load on;
  for (std::uint32_t i = mesh.free_count; i < mesh.node_count(); ++i) {
    if (mesh.nodes[i].x < kBarLength - 1e-9) continue;
    const Vector& f = tissue.elastic_force();
    const dvec3 force(f[3 * i], f[3 * i + 1], f[3 * i + 2]);
    on.force -= force, on.torque -= cross(tissue.position()[i], force);
  }
  return on;
}

// Both ends clamped: F = 12 E I w / L^3 / (1 + phi), phi = 12 E I / kappa G A L^2 (Timoshenko); T = 0.1406 G a^4 / L
// per angle (Saint-Venant). Bonded ends are stiffer by some per cent, less the longer the bar.
TEST(QuadraticTwin, BendsAndTwistsAsBarsDo) {
  const double I = std::pow(kBarSide, 4) / 12, kappa = 10 * (1 + kBarNu) / (12 + 11 * kBarNu);
  const double phi = 12 * kBarYoung * I / (kappa * kBarShear * kBarSide * kBarSide * kBarLength * kBarLength);
  const double bending = 12 * kBarYoung * I / std::pow(kBarLength, 3) / (1 + phi);
  const double torsion = 0.1406 * kBarShear * std::pow(kBarSide, 4) / kBarLength;
  QuadraticBlock bar = twin_bar(3);
  const auto bent = bar.carry(across(1e-3), 1), twisted = bar.carry(turned(0.01), 1);
  ASSERT_TRUE(bent && twisted);
  EXPECT_NEAR(bent->force.y / 1e-3, bending, 0.05 * bending);
  const auto coarser = twin_bar(2).carry(across(1e-3), 1);
  ASSERT_TRUE(coarser);
  EXPECT_NEAR(bent->force.y, coarser->force.y, 0.01 * coarser->force.y);  // it has converged
  EXPECT_NEAR(twisted->torque.x / 0.01, torsion, 0.06 * torsion);
}

// Deep: a quarter of the length across, and a third of a turn.
TEST(QuadraticTwin, LinearTetrahedraOfTheSameLawComeNearItAsTheyGetFiner) {
  QuadraticBlock bar = twin_bar(2);
  struct Case {
    const char* name;
    PlateMotion place;
    double (*of)(const QuadraticBlock::Load&);
    double off;  // [1] of eight cells across
  };
  const Case cases[] = {
      {"bending", across(0.1), [](const QuadraticBlock::Load& l) { return l.force.y; }, 0.12},
      {"torsion", turned(2.0), [](const QuadraticBlock::Load& l) { return l.torque.x; }, 0.12},
  };
  for (const Case& each : cases) {
    const auto truth = bar.carry(each.place);
    ASSERT_TRUE(truth) << each.name;
    const auto off = [&](int cells) {
      return each.of(linear_bar(cells, TissueLaw::kNeoHookean, each.place)) / each.of(*truth) - 1;
    };
    const double coarse = off(4), fine = off(8);
    EXPECT_LT(std::abs(fine), each.off) << each.name << ' ' << coarse;
    EXPECT_LT(std::abs(fine), 0.5 * std::abs(coarse)) << each.name << ' ' << fine;
  }
}

}  // namespace
}  // namespace pliant
