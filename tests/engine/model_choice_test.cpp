// Error budgets (engine/choice): the model that is chosen is within its budget by a measurement of its own, a tighter
// budget never chooses a cheaper one, and what a level says itself stays.
#include "engine/choice/model_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "content/keys/extensions.h"
#include "content/level_file.h"
#include "engine/choice/choice_parts.h"
#include "pliant/session.h"
#include "systems/soft/fem/tissue_step.h"
#include "tests/scenes/scenes.h"

namespace pliant {
namespace {

MeshData data_of(const Primitive& primitive) {
  MeshData mesh;
  mesh.position = primitive.position;
  mesh.index = primitive.index;
  return mesh;
}

constexpr double kReach = 0.03;  // [m]

Level sheet_level(double error) {
  Scene scene;
  DeformableParameters d;
  d.reach = kReach;
  d.error = error;
  scene.add_surface("sheet", data_of(scenes::sheet(40, 0.16)), d);
  return scene.level();
}

// In a session, by a probe of its own: the surface against the half-space, with the chosen keys.
double error_in_a_session(const Level& level) {
  Scene scene(level);
  scene.level().nodes[0].deformable->error = 0.0;
  scene.add_probe("tip", {}, {}, {.position = dvec3(0.001, 0.01, 0.001)});
  auto session = Session::open(scene);
  EXPECT_TRUE(session);
  const double depth = 0.002, inner = 0.2 * kReach;
  const dvec3 foot(0.0015, 0.0, 0.0025);
  EXPECT_TRUE(session->move("tip", foot + dvec3(0, 0.002, 0)));
  EXPECT_TRUE(session->step());
  EXPECT_TRUE(session->move("tip", foot - dvec3(0, depth, 0)));
  EXPECT_TRUE(session->step());
  std::vector<vec3> at;
  EXPECT_TRUE(session->vertices("sheet", at));
  double off = 0.0, size = 0.0;
  for (const vec3 p : at) {
    const double r = std::hypot(p.x - foot.x, p.z - foot.z);
    if (r > kReach) continue;
    const double truth = r <= inner ? 1.0 : 2 / M_PI * std::asin(inner / r);
    off += (-p.y / depth - truth) * (-p.y / depth - truth);
    size += truth * truth;
  }
  return std::sqrt(off / size);
}

TEST(ModelChoice, AChosenSurfaceIsWithinItsBudgetInASessionOfItsOwn) {
  Shape last = Shape::kHertz;
  int shapes = 0;
  for (const double budget : {0.5, 0.3}) {
    Level level = sheet_level(budget);
    const auto choices = choose_models(level);
    ASSERT_TRUE(choices) << choices.error().message();
    ASSERT_EQ(choices->size(), 1u);
    const ModelChoice& choice = choices->front();
    EXPECT_TRUE(choice.within) << choice.sentence();
    // Places on a coarse mesh differ a little.
    EXPECT_LT(error_in_a_session(level), budget + 0.03) << choice.sentence();
    EXPECT_NEAR(error_in_a_session(level), choice.tried[choice.chosen].error, 0.06) << choice.sentence();
    shapes += level.nodes[0].deformable->shape != last;
    last = level.nodes[0].deformable->shape;
  }
  EXPECT_EQ(shapes, 2) << "a tighter budget takes another shape";
}

TEST(ModelChoice, ATighterBudgetNeverChoosesACheaperModel) {
  double before = 0.0;
  for (const double budget : {0.9, 0.5, 0.4, 0.3, 0.2, 0.05}) {
    Level level = sheet_level(budget);
    const auto choices = choose_models(level);
    ASSERT_TRUE(choices);
    const ModelChoice& choice = choices->front();
    EXPECT_GE(choice.tried[choice.chosen].cost, before) << budget;
    before = choice.tried[choice.chosen].cost;
    for (std::size_t i = 0; i < choice.chosen; ++i)
      EXPECT_TRUE(choice.tried[i].error > budget || !choice.within) << choice.tried[i].label;
    if (!choice.within) EXPECT_NE(choice.sentence().find("comes nearest"), std::string::npos);
  }
}

TEST(ModelChoice, TheSameLevelChoosesTheSameBitsEveryTime) {
  Level a = sheet_level(0.4), b = sheet_level(0.4);
  const auto first = choose_models(a), second = choose_models(b);
  ASSERT_TRUE(first && second);
  ASSERT_EQ(first->front().tried.size(), second->front().tried.size());
  for (std::size_t i = 0; i < first->front().tried.size(); ++i) {
    EXPECT_EQ(first->front().tried[i].label, second->front().tried[i].label);
    EXPECT_EQ(first->front().tried[i].error, second->front().tried[i].error);
    EXPECT_EQ(first->front().tried[i].cost, second->front().tried[i].cost);
  }
}

TEST(ModelChoice, WhatALevelSaysByAKeyStaysAtItsDefaultToo) {
  Level level = sheet_level(0.3);
  ASSERT_TRUE(set_key(level, "sheet.deformable.shape=volume"));
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices);
  EXPECT_EQ(level.nodes[0].deformable->shape, Shape::kVolume);
  EXPECT_NE(choices->front().sentence().find("the level itself says shape"), std::string::npos)
      << choices->front().sentence();
  EXPECT_FALSE(choices->front().within) << "a rim is no half-space";
}

TEST(ModelChoice, ALevelWithoutABudgetIsLeftAlone) {
  Level level = sheet_level(0.0);
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices);
  EXPECT_TRUE(choices->empty());
  EXPECT_EQ(level.nodes[0].deformable->shape, Shape::kVolume);
  Level empty;
  EXPECT_FALSE(set_error_budget(empty, 0.1));
}

Level slab_level(double error) {
  Scene scene;
  SoftBodyParameters body;
  body.young = 1e4;
  body.rayleigh = {0.0, 0.01};
  body.error = error;
  body.pinned.add(vec3(-1, -0.06f, -1));
  body.pinned.add(vec3(1, -0.035f, 1));
  scene.add_soft_body("slab", data_of(scenes::slab(8, 0.1, 0.05)), body);
  return scene.level();
}

// A body of its own, made from the level and not by the chooser: places on its top after a press in the middle, while
// it rises and while it holds, in steps of `step` [s].
std::vector<dvec3> press_middle(Level level, double cell, double step, Scheme scheme) {
  level.nodes[0].soft_body->cell = cell;
  level.nodes[0].soft_body->error = 0.0;
  const auto world = spawn_level(level);
  EXPECT_TRUE(world);
  const SoftBody* body = nullptr;
  for (auto [entity, each] : world->registry.view<const SoftBody>()) body = &each;
  const TetMesh& tets = world->tet_meshes[body->tets];
  const auto depth = [](dvec3 p) {  // of a smooth dent's weight
    const double u = (p.x * p.x + p.z * p.z) / (0.02 * 0.02);
    return p.y > -1e-3 && u < 1 ? (1 - u) * (1 - u) : 0.0;
  };
  // By nodes of the top: each as much as its weight, to one sum.
  std::vector<dvec3> load(tets.node_count(), dvec3(0)), push = load;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < tets.free_count; ++i) sum += depth(tets.nodes[i]);
  for (std::uint32_t i = 0; i < tets.free_count; ++i) load[i].y = -0.2 * depth(tets.nodes[i]) / sum;
  Tissue tissue(tets,
                {.young = body->young, .poisson = body->poisson, .density = body->density, .beta = body->rayleigh[1]},
                tets.free_count);
  const auto solver = make_solver(SolverKind::kBlockCholesky, tissue.inner().size);
  solver->analyse(tissue.inner());
  std::vector<dvec3> out;
  for (int i = 1; i <= static_cast<int>(std::lround(0.3 / step)); ++i) {
    const double t = std::min(1.0, (i - (scheme == Scheme::kMidpoint ? 0.5 : 0.0)) * step / 0.2);
    for (std::size_t n = 0; n < load.size(); ++n) push[n] = t * t * (3 - 2 * t) * load[n];
    EXPECT_TRUE(step_tissue(tissue, *solver, step, dvec3(0), {.scheme = scheme, .push = &push}).solved);
    if (i % static_cast<int>(std::lround(0.1 / step)) != 0) continue;
    // The top as it is seen from above, by the nearest node of the lattice.
    for (double x = -0.04; x < 0.041; x += 0.01)
      for (double z = -0.04; z < 0.041; z += 0.01) {
        std::uint32_t nearest = 0;
        for (std::uint32_t k = 1; k < tets.free_count; ++k)
          if (length(tets.nodes[k] - dvec3(x, 0, z)) < length(tets.nodes[nearest] - dvec3(x, 0, z))) nearest = k;
        out.push_back(tissue.position()[nearest] - tets.nodes[nearest]);
      }
  }
  return out;
}

TEST(ModelChoice, ABodyIsWithinItsBudgetAndATighterOneNeverGivesItACheaperLatticeAndStep) {
  Level level = slab_level(0.8);
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices) << choices.error().message();
  const ModelChoice& choice = choices->front();
  EXPECT_TRUE(choice.within) << choice.sentence();
  EXPECT_GT(level.nodes[0].soft_body->cell, 0.0);
  const double cell = level.nodes[0].soft_body->cell;
  const auto taken = press_middle(level, cell, level.simulation.soft_step, Scheme::kEuler),
             fine = press_middle(level, 0.7 * cell, 1.0 / 120, Scheme::kMidpoint);
  ASSERT_EQ(taken.size(), fine.size());
  double off = 0.0, size = 0.0;
  for (std::size_t i = 0; i < fine.size(); ++i)
    off += dot(taken[i] - fine[i], taken[i] - fine[i]), size += dot(fine[i], fine[i]);
  EXPECT_LT(std::sqrt(off / size), 0.8);
  EXPECT_GT(std::sqrt(off / size), 0.0);
  double before = 0.0;
  for (const double budget : {2.0, 1.0, 0.5, 0.3, 0.2, 0.1, 0.01}) {
    const double cost = choice.tried[cheapest_within(choice.tried, budget)].cost;
    EXPECT_GE(cost, before) << budget;
    before = cost;
  }
}

}  // namespace
}  // namespace pliant
