// Tools of handle and tissue: rigid motion, momentum, equilibrium, and the view of collision mesh and device.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstring>
#include <random>

#include "systems/soft/body/rotation_vector.h"
#include "tests/tool/air_tool.h"

namespace pliant {
namespace {

constexpr double T = 1.0 / 60;  // [s]

TEST(Tool, FollowsItsDeviceWithoutStrainOnceTheWayIsDone) {
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment);
    const dvec3 turn{0.4, 1.2, -0.8}, way{0.3, -0.2, 0.1};
    const int steps = 120;
    double largest = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const double part = double(i) / steps, rate = 1 / (steps * T);
      tool.state->set_device({part * way, rotation_of(part * turn)}, join(rate * way, rate * turn));
      tool.run(1, T, dvec3(0));
      largest = std::max(largest, tool.state->tissue().elastic_energy());
    }
    tool.state->set_device({way, rotation_of(turn)}, Vector6::Zero());
    tool.run(600, T, dvec3(0));
    const RigidMotion& handle = tool.state->handle().motion();
    EXPECT_LT(length(tool.state->handle().object_pose().position - way), 1e-9);
    EXPECT_LT(length(vector_of(handle.pose.rotation * glm::conjugate(rotation_of(turn)))), 1e-8);
    EXPECT_GT(largest, 0.0);
    EXPECT_LT(tool.state->tissue().elastic_energy(), 1e-10 * largest);
    for (std::uint32_t i = 0; i < tool.bar.tets.node_count(); ++i)
      ASSERT_LT(
          length(tool.state->tissue().position()[i] - Pose{way, rotation_of(turn)}.to_world(tool.bar.tets.nodes[i])),
          1e-8);
  }
}

TEST(Tool, SlavedNodesAreRigidToTheLastDigit) {
  AirTool tool(Attachment::kSlave);
  tool.state->set_device({{0.1, 0.1, 0}, rotation_of({0, 2, 0})}, Vector6::Zero());
  tool.run(20, T, kGravity);
  const TetMesh& tets = tool.bar.tets;
  for (std::uint32_t i = tets.free_count; i < tets.pinned_begin(); ++i)
    EXPECT_LT(length(tool.state->tissue().position()[i] - tool.state->handle().object_pose().to_world(tets.nodes[i])),
              1e-15);
}

TEST(Tool, LetGoKeepsItsMomentum) {
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment, make_finger(4, 2, 2, 0.01));
    tool.state->set_device({{0.1, 0.02, 0}, rotation_of({0, 1, 2})}, join({1, 0, 0}, {0, 5, 0}));
    tool.run(3, T, dvec3(0));
    tool.state->release_device();
    const Vector6 before = tool.momentum();
    ASSERT_GT(before.norm(), 1e-3);
    tool.run(100, T, dvec3(0));
    EXPECT_LT((tool.momentum() - before).head<3>().norm(), 1e-10 * before.head<3>().norm()) << int(attachment);
    EXPECT_EQ(tool.state->coupling_wrench().norm(), 0.0);
  }
}

TEST(Tool, LetGoKeepsItsAngularMomentumToFirstOrderInTheStep) {
  // Implicit Euler with rotations frozen over the step puts a torque of order T^2 into each step.
  // (Stiffness-proportional damping, left out here, has a torque of second order in the strain at any T: its K' takes
  // the strained body's turning for straining.)
  for (const Attachment attachment : kBoth) {
    const auto drift = [&](double dt) {
      AirTool tool(attachment, make_finger(4, 1, 1, 0.01), kTieStiffness, /*beta*/ 0.0);
      tool.state->set_device({{0.02, 0.01, 0}, rotation_of({0, 0.3, 0.6})}, join({0, 0, 0}, {0, 3, 1}));
      tool.run(10, 5e-3, dvec3(0));
      tool.state->release_device();
      const Vector6 before = tool.momentum();
      tool.run(static_cast<int>(std::lround(4e-3 / dt)), dt, dvec3(0));
      return (tool.momentum() - before).tail<3>().norm() / before.tail<3>().norm();
    };
    EXPECT_NEAR(drift(4e-5) / drift(2e-5), 2.0, 0.2) << int(attachment);
  }
}

TEST(Tool, HangsFromItsDeviceWithItsWeight) {
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment, make_finger(4, 1, 1, 0.01), kTieStiffness, 5e-3, /*carried*/ false);
    tool.state->set_device({}, Vector6::Zero());
    tool.run(500, 0.2, kGravity);
    const double weight = 9.81 * tool.mass();
    EXPECT_LT(weight, tool.handle.max_force);
    EXPECT_LT(length(linear(tool.state->coupling_wrench()) - dvec3(0, weight, 0)), 1e-9 * weight);
    // The tissue contributes the weight of the nodes that are not on the handle.
    const dvec3 tissue = linear(tool.state->tissue_wrench() + tool.state->handle_load());
    EXPECT_LT(length(tissue - dvec3(0, -weight, 0)), 1e-9 * weight);
    // Its moment about the handle's centre is balanced by the coupling.
    const Vector6 left = tool.state->coupling_wrench() + tool.state->tissue_wrench() + tool.state->handle_load();
    EXPECT_LT(left.tail<3>().norm(), 1e-9 * weight * 0.05);
    EXPECT_GT(length(angular(tool.state->coupling_wrench())), 1e-3 * weight * 0.05);
  }
}

TEST(Tool, CarriedToolPullsAtItsDeviceOnlyByTheMomentOfItsSag) {
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment);
    tool.state->set_device({}, Vector6::Zero());
    tool.run(500, 0.2, kGravity);
    const double weight = 9.81 * tool.mass();
    EXPECT_LT(length(linear(tool.state->coupling_wrench())), 1e-9 * weight);
    // Tissue that bends under its weight moves its centre of mass: that much, and nothing else, is left to the
    // coupling.
    dvec3 centre(0), carried(0);
    const Tissue& tissue = tool.state->tissue();
    for (std::uint32_t i = 0; i < tool.bar.tets.pinned_begin(); ++i) {
      centre += tissue.mass()[i] * tissue.position()[i] / tool.mass();
      carried += tissue.mass()[i] * tool.state->handle().object_pose().to_world(tool.bar.tets.nodes[i]) / tool.mass();
    }
    EXPECT_GT(length(centre - carried), 1e-5);
    const dvec3 moment = cross(centre - carried, dvec3(0, -weight, 0));
    EXPECT_LT(length(angular(tool.state->coupling_wrench()) + moment), 1e-6 * weight * 0.05);
  }
}

TEST(Tool, SpringsThatStiffenLeadToTheToolOfSlavedNodes) {
  const auto shape = [](Attachment attachment, double tie) {
    AirTool tool(attachment, make_finger(4, 1, 1, 0.01), tie);
    tool.state->set_device({}, Vector6::Zero());
    tool.run(300, 0.2, kGravity);
    return tool.state->tissue().position();
  };
  const std::vector<dvec3> slaved = shape(Attachment::kSlave, 1.0);
  const auto apart = [&](double tie) {
    const std::vector<dvec3> tied = shape(Attachment::kSpring, tie);
    double most = 0.0;
    for (std::size_t i = 0; i < tied.size(); ++i) most = std::max(most, length(tied[i] - slaved[i]));
    return most;
  };
  const double usual = apart(kTieStiffness);
  EXPECT_LT(usual, 1e-4);                                   // [m] of a finger of 4 cm that sags by millimetres
  EXPECT_NEAR(usual / apart(4 * kTieStiffness), 4.0, 0.5);  // inversely with the springs
}

TEST(Tool, TheHandlesMotionIsWhatTissueCouplingAndWeightMakeOfIt) {
  // M_h (w1 - w0) = T (load + F(w1) + coupling), F linear in w: the momentum balance of one step.
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment);
    tool.state->set_device({{0.05, 0.02, 0}, rotation_of({0, 0.3, 1})}, join({1, 0, 0}, {0, 2, 0}));
    for (int i = 0; i < 5; ++i) {
      const Vector6 w0 = tool.state->handle().motion().velocity;
      tool.state->free_step(T, kGravity);
      const Vector6 w1 = tool.state->velocity().tail<6>();
      const SoftBodyState& s = *tool.state;
      const Vector6 impulse =
          T * (s.handle_load() + s.tissue_wrench() + s.coupling_wrench()) - s.tissue_matrix() * (w1 - w0);
      EXPECT_LT((s.handle_mass() * (w1 - w0) - impulse).norm(), 1e-10 * (T * s.tissue_wrench()).norm())
          << int(attachment);
      const Eigen::Matrix<double, 6, 1> values = s.tissue_matrix().selfadjointView<Eigen::Lower>().eigenvalues();
      EXPECT_GE(values.minCoeff(), -1e-9 * values.maxCoeff());
      tool.state->advance(T);
    }
  }
}

TEST(Tool, SkinMovesWithItsDegreesOfFreedom) {
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment);
    tool.state->set_device({{0.05, 0.02, 0}, rotation_of({0, 0.3, 1})}, join({1, 0, 0}, {0, 2, 0}));
    tool.run(3, T, kGravity);
    SoftBodyState& state = *tool.state;
    const double tiny = 1e-6;
    state.free_step(tiny, kGravity);
    const std::vector<dvec3> before = state.surface_position, rate = state.surface_velocity;
    const Rows v = state.velocity();
    Rows moved = Rows::Zero(static_cast<Eigen::Index>(3 * tool.bar.collision_mesh.triangles.size()), 1);
    const dmat3 axes = glm::mat3_cast(rotation_of({0.3, 0.1, -0.4}));
    for (std::uint32_t t = 0; t < tool.bar.collision_mesh.triangles.size(); ++t)
      state.gather({t, {0.25, 0.25, 0.5}, {}}, axes, 1.0, v, moved.middleRows<3>(3 * t));
    state.advance(tiny);
    for (std::size_t i = 0; i < before.size(); ++i)
      ASSERT_LT(length((state.surface_position[i] - before[i]) / tiny - rate[i]), 1e-4 * (1 + length(rate[i])));
    for (std::uint32_t t = 0; t < tool.bar.collision_mesh.triangles.size(); ++t) {
      const uvec3 c = tool.bar.collision_mesh.triangles[t];
      const dvec3 expected = glm::transpose(axes) * (0.25 * rate[c.x] + 0.25 * rate[c.y] + 0.5 * rate[c.z]);
      ASSERT_LT(length(expected - dvec3(moved(3 * t, 0), moved(3 * t + 1, 0), moved(3 * t + 2, 0))), 1e-12);
    }
  }
}

TEST(Tool, AnImpulseOnASkinPointDoesTheWorkOfThatPointsMotion) {
  // x . (J^T a) = a . (J x): spread and gather are each other's transpose.
  const Bar bar = make_bar(4, 2, 2, 0.01, [](std::uint32_t i, std::uint32_t, std::uint32_t) {
    return i == 0 ? Role::kHandle : i == 4 ? Role::kPinned : Role::kFree;
  });
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment, bar);
    SoftBodyState& state = *tool.state;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Rows x = Rows::NullaryExpr(state.size(), 1, [&] { return uniform(random); });
    const dmat3 axes = glm::mat3_cast(rotation_of({0.3, 0.1, -0.4}));
    for (std::uint32_t t = 0; t < bar.collision_mesh.triangles.size(); ++t) {
      const SurfacePoint point{t, {0.1, 0.3, 0.6}, {}};
      Rows columns = Rows::Zero(state.size(), 3), out = Rows::Zero(3, 1);
      state.spread(point, axes, -1.0, columns, 0);
      state.gather(point, axes, -1.0, x, out);
      ASSERT_LT((columns.transpose() * x - out).norm(), 1e-13);
    }
  }
}

TEST(Tool, TheSamePathGivesTheSameBits) {
  const auto run = [] {
    AirTool tool(Attachment::kSpring);
    tool.state->set_device({{0.05, 0.02, 0}, rotation_of({0, 0.3, 1})}, join({1, 0, 0}, {0, 2, 0}));
    tool.run(10, T, kGravity);
    return tool.state->tissue().position();
  };
  const std::vector<dvec3> a = run(), b = run();
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(dvec3)), 0);
}

TEST(Tool, ShowsItsSkinItsNodesAndWhereItsObjectIs) {
  AirTool tool(Attachment::kSlave);
  SoftObjectSnapshot shown;
  tool.state->show(shown);
  ASSERT_EQ(shown.position.size(), tool.bar.collision_mesh.vertex_count);
  ASSERT_EQ(shown.nodes.size(), tool.bar.tets.node_count());
  EXPECT_LT(length(shown.pose.position), 1e-15);
  const dvec3 middle{0.02, 0.005, 0.005};
  for (std::size_t i = 0; i < shown.normal.size(); ++i) {
    EXPECT_NEAR(length(shown.normal[i]), 1.0f, 1e-6f);
    EXPECT_GT(dot(dvec3(shown.normal[i]), dvec3(shown.position[i]) - middle), 0.0);  // outward
  }
}

}  // namespace
}  // namespace pliant
