// A block bonded between two plates, squashed, pulled and sheared, beside quadratic tetrahedra of the same law.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "systems/soft/fem/tissue_step.h"
#include "scenes/quadratic_block.h"

namespace pliant {
namespace {

constexpr double kSide = 0.1, kYoung = 1e4, kStiffening = 0.2;

// [N] on the far plate, from `cells`^3 cells of linear tetrahedra.
dvec3 plate_force(TissueLaw law, double poisson, int cells, dvec3 way) {
  TetMesh mesh = tets::box(cells, cells, cells, dvec3(0), dvec3(kSide));
  tets::hold(mesh, [](dvec3 p) { return p.x < 1e-9 || p.x > kSide - 1e-9; });
  Tissue tissue(mesh, {.young = kYoung, .poisson = poisson, .density = 1000, .law = law, .stiffening = kStiffening},
                mesh.free_count);
  auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
  solver->analyse(tissue.inner());
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) tissue.position()[i] += mesh.nodes[i].x / kSide * way;
  const TissueReport report = settle_tissue(tissue, *solver, dvec3(0), {.iterations = 100, .tolerance = 1e-8});
  EXPECT_TRUE(report.solved);
  tissue.find_forces();
  dvec3 sum(0);
  for (std::uint32_t i = mesh.free_count; i < mesh.node_count(); ++i)
    if (mesh.nodes[i].x > kSide - 1e-9)
      for (int k = 0; k < 3; ++k) sum[k] -= tissue.elastic_force()[3 * i + k];
  return sum;
}

struct Load {
  const char* name;
  dvec3 way;  // [m] of the far plate
  int axis;   // of the force
};

// [1] Of 8^3 cells, against a twin of `twin_cells`^3.
double error_of(TissueLaw law, double poisson, int twin_cells, const Load& load) {
  const LawConstants material{kYoung / (2 * (1 + poisson)), kYoung * poisson / ((1 + poisson) * (1 - 2 * poisson)),
                              kStiffening};
  QuadraticBlock twin(twin_cells, kSide, elastic_law(law), material);
  const std::optional<dvec3> truth = twin.press(load.way);
  EXPECT_TRUE(truth) << load.name;
  if (!truth) return 1.0;
  const double want = (*truth)[load.axis], off = plate_force(law, poisson, 8, load.way)[load.axis] / want - 1;
  return off;
}

const Load kSquashToHalf{"squash 50 %", {-0.05, 0, 0}, 0};

TEST(LargeStrain, ABondedBlockBearsWhatItsQuadraticTwinBears) {
  for (const Load& load : {Load{"squash 25 %", {-0.025, 0, 0}, 0}, kSquashToHalf, Load{"pull 50 %", {0.05, 0, 0}, 0},
                           Load{"shear 100 %", {0, 0.1, 0}, 1}})
    EXPECT_LT(std::abs(error_of(TissueLaw::kNeoHookean, 0.4, 3, load)), 0.05) << load.name;
  EXPECT_LT(std::abs(error_of(TissueLaw::kFung, 0.4, 3, kSquashToHalf)), 0.05);
}

// Linear tetrahedra lock there, whatever their law: the finer, the less.
TEST(LargeStrain, ADeepSquashOfNearlyIncompressibleTissueIsTooStiffByTheLockingOfItsElements) {
  const double off = error_of(TissueLaw::kNeoHookean, 0.45, 4, {"squash 70 %", {-0.07, 0, 0}, 0});
  EXPECT_GT(off, 0.0);
  EXPECT_LT(off, 0.2);
}

}  // namespace
}  // namespace pliant
