// Choices of an error budget for a soft body: lattice, soft step and solver.
#include <gtest/gtest.h>

#include <cmath>

#include "content/keys/enum_words.h"
#include "content/level_file.h"
#include "engine/choice/alone.h"
#include "engine/choice/model_choice.h"
#include "engine/choice/solver_choice.h"
#include "pliant/scene.h"
#include "scenes/scenes.h"

namespace pliant {
namespace {

MeshData body_data(const Primitive& primitive) {
  MeshData mesh;
  mesh.position = primitive.position;
  mesh.index = primitive.index;
  return mesh;
}

Level slab_level(double error) {
  Scene scene;
  SoftBodyParameters body;
  body.young = 1e4;
  body.rayleigh = {0.0, 0.01};
  body.error = error;
  body.pinned.add(vec3(-1, -0.06f, -1));
  body.pinned.add(vec3(1, -0.035f, 1));
  scene.add_soft_body("slab", body_data(scenes::slab(8, 0.1, 0.05)), body);
  return scene.level();
}

// An independent body, made from the level and not by the chooser: positions on its top after a press in the middle,
// during rise and hold, in steps of `step` [s].
std::vector<dvec3> press_middle(Level level, double cell, double step, Scheme scheme) {
  level.nodes[0].soft_body->cell = cell;
  level.nodes[0].soft_body->error = 0.0;
  const auto world = spawn_level(level);
  EXPECT_TRUE(world);
  const SoftBody* body = nullptr;
  for (auto [entity, each] : world->registry.view<const SoftBody>()) body = &each;
  const TetMesh& tets = world->tet_meshes[body->tets];
  const auto depth = [](dvec3 p) {  // weight of a smooth dent
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
    // The top seen from above, by the nearest lattice node.
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

TEST(BodyChoice, ABodyIsWithinItsBudgetAndATighterOneNeverGivesItACheaperLatticeAndStep) {
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
  // A tighter budget, measured again: never a cheaper lattice and step, and no cheaper one is within it.
  Level tight = slab_level(0.5 * choice.tried[choice.chosen].error);
  const auto others = choose_models(tight);
  ASSERT_TRUE(others) << others.error().message();
  const ModelChoice& other = others->front();
  EXPECT_GT(other.tried[other.chosen].cost, choice.tried[choice.chosen].cost);
  EXPECT_TRUE(tight.nodes[0].soft_body->cell < cell || tight.simulation.soft_step < level.simulation.soft_step);
  for (std::size_t i = 0; i < other.tried.size(); ++i)
    if (other.tried[i].cost < other.tried[other.chosen].cost && other.within)
      EXPECT_GT(other.tried[i].error, other.budget) << other.tried[i].label;
}

// Lattices of a level's only body, pressed at the same places.
struct PressedLattices {
  Patches patches;
  std::vector<Lattice> its;  // per cell
};
PressedLattices pressed_lattices(const Level& level, const std::vector<double>& cells) {
  PressedLattices out;
  Level alone = level_alone(level, 0);
  for (const double cell : cells) {
    auto lattice = make_lattice(alone, 0, cell, out.patches);
    EXPECT_TRUE(lattice);
    out.its.push_back(std::move(lattice).value());
  }
  const Mesh& surface = out.patches.surface;
  out.patches.radius = kDefaultReach * static_cast<double>(surface.box.diagonal());
  for (std::uint32_t k = 0; k < 6; ++k) out.patches.vertices.push_back((2 * k + 1) * surface.vertex_count / 12);
  return out;
}

TEST(BodyChoice, TheErrorOfAnySoftStepIsFiniteAndGrowsWithIt) {
  const Level level = slab_level(0.0);
  const PressedLattices at = pressed_lattices(level, {0.02});
  const auto at_rest = answers(at.its[0], *level.nodes[0].soft_body, at.patches);
  ASSERT_TRUE(at_rest);
  const std::vector<double> steps{0.0001, 0.001, 0.002, 0.0025, 0.005, 0.01, 0.02, 1.0 / 30, 0.05, 0.1, 0.3, 1.0};
  const auto figures = step_errors(at.its[0], *level.nodes[0].soft_body, at.patches, *at_rest, steps);
  ASSERT_EQ(figures.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(figures[i].step, steps[i]);
    EXPECT_GT(figures[i].error, 0.0) << steps[i];
    EXPECT_LT(figures[i].error, 1.5) << steps[i] << ": nothing that moves at all is farther off";
    if (i > 0 && steps[i] <= 0.1) EXPECT_GE(figures[i].error, figures[i - 1].error) << steps[i];
  }
  EXPECT_EQ(figures[0].error, figures[1].error) << "steps below a millisecond have its error";
  EXPECT_NEAR(figures.back().error, 1.0, 1e-9) << "in one second all is over: nothing moves";
  // Euler is of order 1.
  EXPECT_NEAR(figures[4].error / figures[3].error, 2.0, 0.3);
  EXPECT_NEAR(figures[5].error / figures[4].error, 2.0, 0.3);
}

TEST(BodyChoice, AStatedStepOfAnyLengthHasAnError) {
  for (const double step : {0.0001, 0.07, 0.1, 1.0}) {
    Level level = slab_level(0.5);
    level.nodes[0].soft_body->cell = 0.02;
    level.simulation.soft_step = step;
    const auto choices = choose_models(level);
    ASSERT_TRUE(choices) << choices.error().message();
    for (const ModelCandidate& it : choices->front().tried) EXPECT_LT(it.error, 3.0) << it.label;
    EXPECT_EQ(choices->front().sentence().find("too short to be measured") != std::string::npos, step < 1e-3);
  }
}

TEST(BodyChoice, AFineStatedCellHasTheErrorThatItsOwnRefinementWouldSay) {
  Level level = slab_level(0.5);
  level.nodes[0].soft_body->cell = 0.0062;  // refined: more tetrahedra than are answered in seconds
  level.simulation.soft_step = 1.0 / 60;
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices) << choices.error().message();
  const ModelChoice& choice = choices->front();
  EXPECT_NE(choice.sentence().find("too many to be refined in seconds"), std::string::npos) << choice.sentence();
  // The slower twin, without the step's part, which is measured on a lattice of two cells.
  const PressedLattices own = pressed_lattices(level, {0.0062, 0.6 * 0.0062, 2 * 0.0062});
  ASSERT_GT(own.its[0].tets.tets.size(), 8640u);
  const SoftBody& body = *level.nodes[0].soft_body;
  const auto cell = answers(own.its[0], body, own.patches), finer = answers(own.its[1], body, own.patches),
             coarse = answers(own.its[2], body, own.patches);
  ASSERT_TRUE(cell && finer && coarse);
  const double ratio = own.its[1].cell / own.its[0].cell;
  const double lattice = difference(*cell, *finer, own.patches.surface) / (1 - ratio * ratio);
  const double step = step_errors(own.its[2], body, own.patches, *coarse, {1.0 / 60}).front().error;
  // How a lattice lies in a block counts as well: cells of 6.2 and 6.6 mm have 0.094 and 0.175.
  const double measured = (choice.tried[choice.chosen].error - step) / lattice;
  EXPECT_GT(measured, 0.5) << lattice << ' ' << step;
  EXPECT_LT(measured, 2.0) << lattice << ' ' << step;
}

TEST(BodyChoice, ASolverThatThisBuildLacksIsNamed) {
  for (const SolverKind kind : {SolverKind::kCholmod}) {
    if (make_solver(kind, 1)) continue;
    Level level = slab_level(0.5);
    level.nodes[0].soft_body->solver = kind;
    const auto choices = choose_models(level);
    ASSERT_FALSE(choices);
    EXPECT_NE(choices.error().what.find("solver is not in this build"), std::string::npos) << choices.error().message();
  }
}

TEST(BodyChoice, AutoIsTheCheapestSolverAndConjugateGradientsTheInexactOne) {
  Level level = slab_level(0.0);
  Patches patches;
  Level alone = level_alone(level, 0);
  const auto lattice = make_lattice(alone, 0, 0.008, patches);
  ASSERT_TRUE(lattice) << lattice.error().message();
  patches.radius = 0.02;
  const std::vector<dvec3> load = patch_load(patches, lattice->tets, 0);
  const auto figures = measure_solvers(lattice->tets, material_of(*level.nodes[0].soft_body, Strain::kCorotational),
                                       load, 1.0 / 60, solvers_to_choose());
  ASSERT_GE(figures.size(), 4u);
  ASSERT_EQ(figures[0].kind, SolverKind::kAuto);
  EXPECT_EQ(figures[0].more_ms, 0.0);
  for (const SolverFigures& it : figures) {
    EXPECT_GE(it.more_ms, 0.0) << word_of(it.kind);
    if (it.kind == SolverKind::kConjugateGradient) {
      EXPECT_GT(it.error, 1e-14);
      EXPECT_LT(it.error, 1e-7);
    } else if (it.kind != SolverKind::kAuto) {
      EXPECT_LT(it.error, 1e-11) << word_of(it.kind);
    }
    if (it.kind == SolverKind::kEigenCholesky) EXPECT_GT(it.more_ms, 0.0);
  }
}

TEST(BodyChoice, TheSolverIsChosenWhereTheLevelSaysNone) {
  Level open = slab_level(2.0), said = slab_level(2.0);
  open.nodes[0].soft_body->cell = said.nodes[0].soft_body->cell = 0.012;  // stated: only one lattice
  open.simulation.soft_step = said.simulation.soft_step = 1.0 / 100;
  ASSERT_TRUE(set_key(said, "slab.soft_body.solver=conjugate_gradient"));
  const auto a = choose_models(open), b = choose_models(said);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(open.nodes[0].soft_body->solver, SolverKind::kAuto) << a->front().sentence();
  EXPECT_EQ(said.nodes[0].soft_body->solver, SolverKind::kConjugateGradient);
  ASSERT_EQ(b->front().tried.size(), 1u);
  EXPECT_NE(b->front().tried[0].label.find("solver conjugate_gradient"), std::string::npos);
  EXPECT_GE(a->front().tried.size(), 4u) << "every solver";
  for (const auto& choices : {*a, *b})
    for (const ModelCandidate& it : choices.front().tried) EXPECT_LT(it.error, 2.0) << it.label;
  EXPECT_GT(b->front().tried[0].cost, a->front().tried[0].cost) << "60 contacts are too many right-hand sides";
}

}  // namespace
}  // namespace pliant
