// Tetrahedral meshes that others made, as they are, slivers included: each stands on its lowest nodes and settles under
// its own weight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>

#include "content/tet_file.h"
#include "content/tet_order.h"
#include "systems/tool/flesh_step.h"
#include "tests/scenes/tet_shapes.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr double kSize = 0.1;  // [m] what every mesh is scaled to
const FleshMaterial kGel{
    .young = 1e5, .poisson = 0.45, .density = 1000, .beta = 1e-3};  // a stiff gel: thin legs sag by a few percent

std::vector<fs::path> meshes() {
  std::vector<fs::path> found;
  const fs::path root = fs::path(PLIANT_CORPUS_DIR) / "tet-meshes";
  if (fs::is_directory(root))
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
      if (is_tet_file(entry.path()) && entry.path().extension() != ".node") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

// Of each node, the first node of the piece that it belongs to: a file may hold several.
std::vector<std::uint32_t> pieces(const TetFile& file) {
  std::vector<std::uint32_t> piece(file.nodes.size());
  std::iota(piece.begin(), piece.end(), 0u);
  const auto first = [&](std::uint32_t n) {
    while (piece[n] != n) n = piece[n] = piece[piece[n]];
    return n;
  };
  for (const Tet& t : file.tets)
    for (const std::uint32_t n : t) piece[std::max(first(t[0]), first(n))] = std::min(first(t[0]), first(n));
  for (std::uint32_t n = 0; n < piece.size(); ++n) piece[n] = first(n);
  return piece;
}

// Scaled, each piece held by the lowest quarter of its height: one topples otherwise, as it would.
TetMesh stand(TetFile file) {
  const std::vector<std::uint32_t> piece = pieces(file);
  std::vector<double> low(piece.size(), 1e300), high(piece.size(), -1e300);
  dvec3 min(1e300), max(-1e300);
  for (const dvec3& p : file.nodes) min = glm::min(min, p), max = glm::max(max, p);
  const dvec3 size = max - min;
  for (dvec3& p : file.nodes) p = (p - min) * (kSize / std::max({size.x, size.y, size.z}));
  for (std::size_t n = 0; n < piece.size(); ++n) {
    low[piece[n]] = std::min(low[piece[n]], file.nodes[n].y);
    high[piece[n]] = std::max(high[piece[n]], file.nodes[n].y);
  }
  std::vector<NodeGroup> group;
  for (std::size_t n = 0; n < piece.size(); ++n) {
    const double foot = low[piece[n]] + 0.25 * (high[piece[n]] - low[piece[n]]);
    group.push_back(file.nodes[n].y < foot ? NodeGroup::kPinned : NodeGroup::kFree);
  }
  TetMesh mesh;
  mesh.nodes = std::move(file.nodes), mesh.tets = std::move(file.tets);
  put_in_order(mesh, group);
  return mesh;
}

TEST(TetCorpus, EveryMeshSettlesUnderItsWeight) {
  const std::vector<fs::path> paths = meshes();
  if (paths.empty()) GTEST_SKIP() << "the tetrahedral meshes of the corpus are not here";
  for (const fs::path& path : paths) {
    Result<TetFile> file = load_tets(path);
    ASSERT_TRUE(file) << path;
    const TetMesh mesh = stand(std::move(*file));
    Flesh flesh(mesh, kGel, mesh.free_count);
    auto solver = make_solver(SolverKind::kBlockCholesky, flesh.moving());
    solver->analyse(flesh.inner());
    double fastest = 0;
    const int steps = std::clamp(static_cast<int>(40000 / mesh.tets.size()), 4, 60);
    for (int i = 0; i < steps; ++i) {
      ASSERT_TRUE(step_flesh(flesh, *solver, 0.6 / steps, {0, -9.81, 0}).solved) << path << " step " << i;
      const double kinetic = kinetic_energy(flesh);
      ASSERT_TRUE(std::isfinite(kinetic)) << path;
      fastest = std::max(fastest, kinetic);
    }
    const double volume = tets::volume(mesh, flesh.position()) / tets::volume(mesh, mesh.nodes);
    EXPECT_LT(kinetic_energy(flesh), 1e-2 * fastest) << path;
    EXPECT_NEAR(volume, 1, 0.05) << path;
    // At rest elasticity carries the weight.
    flesh.assemble(1.0, dvec3(0));
    double carried = 0, weight = 0;
    for (std::uint32_t n = 0; n < mesh.free_count; ++n) {
      carried += flesh.elastic_force()[3 * n + 1];
      weight += 9.81 * flesh.mass()[n];
    }
    EXPECT_NEAR(carried, weight, 1e-2 * weight) << path;
  }
}

}  // namespace
}  // namespace pliant
