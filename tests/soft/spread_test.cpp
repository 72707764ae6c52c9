// Force distribution and motion of a point of a soft body's collision mesh, against its explicit Jacobian over all of
// up to twelve nodes.
#include <gtest/gtest.h>

#include <limits>

#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/body/soft_body_state.h"
#include "tests/soft/bar.h"

namespace pliant {
namespace {

const dmat3 kAxes = glm::mat3_cast(rotation_of({0.2, 0.4, -0.7}));
const dvec3 kPlaces[]{{1, 0, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0.2, 0.5, 0.3}};  // barycentric

// A finger whose last layer is pinned. Its collision mesh vertices are nodes, or embedded in its tetrahedra.
struct SpreadFinger {
  Bar bar = make_bar(4, 2, 2, 0.01, [](std::uint32_t i, std::uint32_t, std::uint32_t) {
    return i == 4 ? Role::kPinned : i <= 1 ? Role::kHandle : Role::kFree;
  });
  Handle6 handle;
  std::unique_ptr<SoftBodyState> state;

  explicit SpreadFinger(bool inside) {
    if (inside)
      for (Embedding& place : bar.tets.embedding) place.weight = {0.1, 0.2, 0.3, 0.4};
    handle.attachment = Attachment::kSlave;
    state = std::make_unique<SoftBodyState>(bar.tets, bar.collision_mesh, SoftBody{}, &handle,
                                            Pose{{0.1, 0.2, -0.1}, rotation_of({0.3, -0.5, 0.2})});
    state->free_step(1.0 / 60, {0, -9.81, 0});
  }

  Rows jacobian(const SurfacePoint& point) const {
    const TetMesh& tets = bar.tets;
    Rows out = Rows::Zero(3, state->size());
    for (int corner = 0; corner < 3; ++corner)
      for (std::size_t k = 0; k < 4; ++k) {
        const Embedding& place = tets.embedding[bar.collision_mesh.triangles[point.triangle][corner]];
        const std::uint32_t node = tets.tets[place.tet][k];
        const double weight = point.barycentric[corner] * place.weight[k];
        if (node < tets.free_count)
          out.middleCols<3>(3 * node) += weight * Block::Identity();
        else if (node < tets.pinned_begin())
          out.rightCols<6>() += weight * grip_matrix(state->handle().arm(node - tets.free_count));
      }
    return out;
  }
};

Eigen::Matrix3d axes() {
  return Eigen::Map<const Eigen::Matrix3d>(&kAxes[0][0]);
}

TEST(Spread, AndGatherAreTheJacobianOfTwelveNodes) {
  for (const bool inside : {false, true}) {
    const SpreadFinger finger(inside);
    const SoftBodyState& state = *finger.state;
    const Rows x = Rows::Random(state.size(), 7);
    for (std::uint32_t t = 0; t < finger.bar.collision_mesh.triangles.size(); ++t)
      for (const dvec3 place : kPlaces) {
        const SurfacePoint point{t, place, {}};
        const Rows J = finger.jacobian(point);
        Rows columns = Rows::Ones(state.size(), 5), moved = Rows::Ones(3, 7);
        state.spread(point, kAxes, -1.0, columns, 1);
        state.gather(point, kAxes, -1.0, x, moved);
        Rows expected = Rows::Ones(state.size(), 5);
        expected.middleCols<3>(1) -= J.transpose() * axes();
        EXPECT_LT((columns - expected).cwiseAbs().maxCoeff(), 1e-12) << t;
        EXPECT_LT((moved - Rows::Ones(3, 7) + axes().transpose() * J * x).cwiseAbs().maxCoeff(), 1e-12) << t;
      }
  }
}

TEST(Spread, AndGatherLeaveNodesOfNoWeightAlone) {
  const SpreadFinger finger(false);
  const SoftBodyState& state = *finger.state;
  for (std::uint32_t t = 0; t < finger.bar.collision_mesh.triangles.size(); ++t)
    for (const dvec3 place : kPlaces) {
      const SurfacePoint point{t, place, {}};
      const Rows J = finger.jacobian(point);
      Rows x = Rows::Ones(state.size(), 2);
      for (int row = 0; row < state.size() - 6; ++row)  // by nodes: three rows of J each
        if (J.middleCols<3>(row / 3 * 3).isZero(0)) x.row(row).setConstant(std::numeric_limits<double>::quiet_NaN());
      Rows moved = Rows::Zero(3, 2);
      state.gather(point, kAxes, 1.0, x, moved);
      EXPECT_TRUE(moved.allFinite()) << t;
    }
}

}  // namespace
}  // namespace pliant
