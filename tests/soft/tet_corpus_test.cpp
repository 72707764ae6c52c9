// Tetrahedral meshes from other sources, including slivers: each is pinned at its lowest nodes and settles under its
// own weight.
#include "tests/scenes/tet_corpus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/soft/fem/tissue_step.h"
#include "tests/scenes/tet_shapes.h"

namespace pliant {
namespace {

const TissueMaterial kGel{
    .young = 1e5, .poisson = 0.45, .density = 1000, .beta = 1e-3};  // a stiff gel: thin legs sag by a few percent

TEST(TetCorpus, EveryMeshSettlesUnderItsWeight) {
  const std::vector<std::filesystem::path> paths = scenes::corpus_tets(PLIANT_CORPUS_DIR);
  if (paths.empty()) GTEST_SKIP() << "the tetrahedral meshes of the corpus are not here";
  for (const std::filesystem::path& path : paths) {
    Result<TetFile> file = load_tets(path);
    ASSERT_TRUE(file) << path;
    const TetMesh mesh = scenes::stand(std::move(*file));
    Tissue tissue(mesh, kGel, mesh.free_count);
    auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
    solver->analyse(tissue.inner());
    double fastest = 0;
    const int steps = std::clamp(static_cast<int>(40000 / mesh.tets.size()), 4, 60);
    for (int i = 0; i < steps; ++i) {
      ASSERT_TRUE(step_tissue(tissue, *solver, 0.6 / steps, {0, -9.81, 0}).solved) << path << " step " << i;
      const double kinetic = kinetic_energy(tissue);
      ASSERT_TRUE(std::isfinite(kinetic)) << path;
      fastest = std::max(fastest, kinetic);
    }
    const double volume = tets::volume(mesh, tissue.position()) / tets::volume(mesh, mesh.nodes);
    EXPECT_LT(kinetic_energy(tissue), 1e-2 * fastest) << path;
    EXPECT_NEAR(volume, 1, 0.05) << path;
    // At rest elasticity carries the weight.
    tissue.assemble(1.0, dvec3(0));
    double carried = 0, weight = 0;
    for (std::uint32_t n = 0; n < mesh.free_count; ++n) {
      carried += tissue.elastic_force()[3 * n + 1];
      weight += 9.81 * tissue.mass()[n];
    }
    EXPECT_NEAR(carried, weight, 1e-2 * weight) << path;
  }
}

}  // namespace
}  // namespace pliant
