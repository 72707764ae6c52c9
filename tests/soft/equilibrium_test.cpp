// How tissue rests under gravity: a hanging bar's closed form, and the inverse of it.
#include "systems/soft/body/equilibrium.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"

namespace pliant {
namespace {

constexpr double kLength = 0.1;  // [m]
const dvec3 kDown(0, -9.81, 0);

// Hung up at its top, or stood on its bottom. Poisson's ratio 0, so that it is one-dimensional.
TetMesh hung_bar(bool hangs = true, double width = 0.02, int cells = 20) {
  TetMesh mesh = tets::box(2, cells, 2, dvec3(-0.5 * width, 0, -0.5 * width), dvec3(0.5 * width, kLength, 0.5 * width));
  const double pinned = hangs ? kLength : 0.0;
  tets::hold(mesh, [&](dvec3 x) { return std::abs(x.y - pinned) < 1e-9; });
  return mesh;
}

SoftBody bar_tissue(double young) {
  SoftBody body;
  body.young = young;
  body.poisson = 0.0;
  return body;
}

TEST(Equilibrium, AHangingBarSagsByItsClosedForm) {
  const SoftBody body = bar_tissue(2e4);
  const Equilibrium rest = find_equilibrium(hung_bar(), body, kDown);
  ASSERT_TRUE(rest.held);
  ASSERT_TRUE(rest.converged);
  EXPECT_NEAR(rest.most, 0.5 * body.density * 9.81 * kLength * kLength / body.young, 0.03 * rest.most);
  EXPECT_LT(rest.turned, 1e-3);
  EXPECT_FALSE(sag_doubt(body, rest, nullptr));
}

TEST(Equilibrium, OfWhatIsFoundWithoutWeightTheGivenShapeIsTheEquilibrium) {
  const TetMesh bar = hung_bar(true, 0.03);
  SoftBody body = bar_tissue(5e3);
  body.poisson = 0.45;
  const Unloaded unloaded = find_unloaded(bar, body, kDown);
  ASSERT_TRUE(unloaded.found);
  EXPECT_GT(unloaded.most, 5e-3);
  TetMesh without = bar;
  without.nodes = unloaded.nodes;
  const Equilibrium rest = find_equilibrium(without, body, kDown);
  ASSERT_TRUE(rest.converged);
  for (std::size_t i = 0; i < bar.nodes.size(); ++i) EXPECT_LT(length(rest.nodes[i] - bar.nodes[i]), 1e-3 * kLength);
}

TEST(Equilibrium, ASlenderBarThatStandsOnItsFootTurnsOverAndIsSaidTo) {
  SoftBody body = bar_tissue(800.0);
  body.poisson = 0.3;
  TetMesh bar = hung_bar(false, 0.01);
  const Equilibrium rest = find_equilibrium(bar, body, dvec3(0.3, -9.8, 0));
  ASSERT_TRUE(sag_doubt(body, rest, nullptr));
  EXPECT_EQ(sag_doubt(body, rest, nullptr)->code, "tissue.gravity");
  EXPECT_GT(rest.most, kMuchSag * rest.size);
  body.under_gravity = UnderGravity::kModelled;
  const Unloaded none = find_unloaded(bar, body, dvec3(0.3, -9.8, 0));
  EXPECT_FALSE(none.found);
  ASSERT_TRUE(sag_doubt(body, rest, &none));
  EXPECT_NE(sag_doubt(body, rest, &none)->cure.find("pin more"), std::string::npos);
}

TEST(Equilibrium, WhatIsNotPinnedHasNone) {
  TetMesh mesh = tets::box(2, 2, 2, dvec3(0), dvec3(0.05));
  mesh.free_count = mesh.node_count();
  EXPECT_FALSE(find_equilibrium(mesh, bar_tissue(5e3), kDown).held);
  EXPECT_FALSE(find_unloaded(mesh, bar_tissue(5e3), kDown).found);
}

// [m] How far the lowest node of a bar is from where it began, at most, over two seconds.
double farthest_in_run(UnderGravity how) {
  scenes::ToolStage stage(1.0 / 60.0);
  SoftBody body = bar_tissue(5e3);
  body.poisson = 0.4;
  body.under_gravity = how;
  const Entity bar = stage.add_soft(hung_bar(true, 0.03, 10), body, Pose{{0.2, 0.5, 0.1}, {1, 0, 0, 0}});
  stage.prepare();
  const std::vector<dvec3> began = stage.tissue(bar).tissue().position();
  const TetMesh modelled = hung_bar(true, 0.03, 10);
  if (how == UnderGravity::kModelled) {
    for (std::size_t i = 0; i < began.size(); ++i)
      EXPECT_LT(length(began[i] - dvec3(0.2, 0.5, 0.1) - modelled.nodes[i]), 1e-9) << "as modelled";
  }
  double most = 0.0;
  for (int i = 0; i < 120; ++i) {
    stage.step();
    for (std::size_t n = 0; n < began.size(); ++n)
      most = std::max(most, length(stage.tissue(bar).tissue().position()[n] - began[n]));
  }
  return most;
}

TEST(UnderGravity, OnlyWhatFallsMoves) {
  EXPECT_GT(farthest_in_run(UnderGravity::kFalls), 5e-3);
  EXPECT_LT(farthest_in_run(UnderGravity::kSettled), 1e-4);
  EXPECT_LT(farthest_in_run(UnderGravity::kModelled), 1e-4);
}

}  // namespace
}  // namespace pliant
