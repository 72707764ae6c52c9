// A block bonded between two plates, squashed, pulled and sheared, beside quadratic tetrahedra of the same law.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "systems/soft/fem/tissue_step.h"
#include "tests/soft/quadratic_block.h"

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
const Load kLoads[] = {{"squash 25 %", {-0.025, 0, 0}, 0},
                       {"squash 50 %", {-0.05, 0, 0}, 0},
                       {"squash 70 %", {-0.07, 0, 0}, 0},
                       {"pull 50 %", {0.05, 0, 0}, 0},
                       {"shear 100 %", {0, 0.1, 0}, 1}};

// At 0.45 linear tetrahedra lock, whatever their law: the more, the deeper the squash and the larger the cells.
TEST(LargeStrain, ABondedBlockBearsWhatItsQuadraticTwinBears) {
  for (const double poisson : {0.4, 0.45})
    for (const TissueLaw law : {TissueLaw::kNeoHookean, TissueLaw::kFung}) {
      const LawConstants material{kYoung / (2 * (1 + poisson)), kYoung * poisson / ((1 + poisson) * (1 - 2 * poisson)),
                                  kStiffening};
      QuadraticBlock twin(3, kSide, elastic_law(law), material);
      for (const Load& load : kLoads) {
        const std::optional<dvec3> truth = twin.press(load.way, 12);
        ASSERT_TRUE(truth) << load.name;
        const double want = (*truth)[load.axis];
        const auto error = [&](TissueLaw of, int cells) {
          return plate_force(of, poisson, cells, load.way)[load.axis] / want - 1;
        };
        const double off = error(law, 6);
        printf("law %d nu %g %s: %g N %+.1f %%, 4 cells %+.1f %%, corotational %+.1f %%\n", int(law), poisson,
               load.name, want, 100 * off, 100 * error(law, 4), 100 * error(TissueLaw::kCorotational, 6));
        EXPECT_LT(std::abs(off), poisson < 0.45 ? 0.05 : 0.3) << load.name;
      }
    }
}

}  // namespace
}  // namespace pliant
