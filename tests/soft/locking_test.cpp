// The Poisson's ratio from which the lattice's linear tetrahedra lock: a block bonded to the ground, with a patch in
// the middle of its top pushed down. The reference is the same block in two finer lattices, extrapolated to cell size
// zero. Each is compared with itself at 0.3, which cancels the patch's discretisation error.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "content/level/spawn_soft.h"
#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

constexpr double kHalf = 0.02;  // [m] of the height

class LockingBlock {
 public:
  explicit LockingBlock(double cell) {
    const Primitive box = scenes::box({0.06, 2 * kHalf, 0.06});
    const Result<BuiltMesh> surface = build_mesh("block", {&box, 1}, mat4(1));
    EXPECT_TRUE(surface.ok());
    Result<TetMesh> mesh = make_lattice(surface->mesh, cell);
    EXPECT_TRUE(mesh.ok());
    mesh_ = std::move(*mesh);
    tets::hold(mesh_, [](dvec3 p) { return p.y < -kHalf + 1e-5; });
  }
  std::size_t size() const { return mesh_.tets.size(); }
  double risen(double poisson) { return stiffness(poisson) / stiffness(0.3); }  // [1] relative to 0.3

 private:
  // [N/m] of the patch's nodes together, each pushed alike
  double stiffness(double poisson) {
    if (const auto known = known_.find(poisson); known != known_.end()) return known->second;
    const double T = 1e5;  // [s] inertia is nothing against stiffness
    Tissue tissue(mesh_, {.young = 1e4, .poisson = poisson, .density = 1, .strain = Strain::kLinear}, mesh_.free_count);
    tissue.assemble(T, dvec3(0));
    if (!solver_) {
      solver_ = make_solver(SolverKind::kBlockCholesky, tissue.moving());
      solver_->analyse(tissue.inner());
    }
    EXPECT_TRUE(solver_->factorise(tissue.inner()));
    Rows down = Rows::Zero(3 * tissue.inner().size, 1);
    std::vector<Eigen::Index> patch;
    for (std::uint32_t i = 0; i < mesh_.free_count; ++i)
      if (mesh_.nodes[i].y > kHalf - 1e-5 && std::hypot(mesh_.nodes[i].x, mesh_.nodes[i].z) < 0.0125)
        patch.push_back(3 * i + 1);
    const auto count = static_cast<double>(patch.size());
    for (const Eigen::Index row : patch) down(row, 0) = T / count;
    solver_->solve_many(down);
    double sum = 0.0;
    for (const Eigen::Index row : patch) sum += T * down(row, 0) / count;
    return known_[poisson] = 1.0 / sum;
  }

  TetMesh mesh_;
  std::unique_ptr<LinearSolver> solver_;
  std::map<double, double> known_;  // [N/m] by Poisson's ratio
};

TEST(Locking, TheBoundIsWhereTheUsualLatticeIsTenPercentTooStiff) {
  const double cell = 0.005, smaller = 0.004;  // [m]
  LockingBlock usual(0.0), fine(cell), finest(smaller);
  EXPECT_LT(usual.size(), 1.3 * kUsualTets);
  const auto excess = [&](double poisson, LockingBlock& block) {
    const double share = smaller * smaller / (cell * cell);
    return block.risen(poisson) / ((finest.risen(poisson) - share * fine.risen(poisson)) / (1 - share)) - 1;
  };
  EXPECT_LT(excess(0.45, usual), 0.06) << "the cure that is named";
  EXPECT_NEAR(excess(kLockingPoisson, usual), 0.10, 0.01);
  EXPECT_GT(excess(0.49, usual), 0.18);
  EXPECT_GT(fine.size(), 7 * usual.size()) << "half the cell";
  EXPECT_LT(excess(0.49, fine), 0.5 * excess(0.49, usual)) << "the other cure";
}

TEST(Locking, IsSaidFromTheBoundOnAndLaterOfManyTetrahedra) {
  SoftBody body;
  const auto said = [&](double poisson, std::size_t tetrahedra) {
    body.poisson = poisson;
    const std::optional<Note> doubt = locking_doubt(body, tetrahedra);
    return doubt ? doubt->message() : std::string();
  };
  EXPECT_EQ(said(0.469, kUsualTets), "");
  EXPECT_NE(said(0.47, kUsualTets).find("0.47 on its 2000 tetrahedra lock"), std::string::npos);
  EXPECT_NE(said(0.499, kUsualTets).find("; lower `poisson`, to 0.45 for instance, or make `cell` smaller"),
            std::string::npos);
  EXPECT_EQ(said(0.48, kManyTets), "");
  EXPECT_NE(said(0.49, kManyTets), "");
}

}  // namespace
}  // namespace pliant
