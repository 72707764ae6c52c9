// Hard cases of tools: jumps, devices with invalid values, a handle of few nodes or of all, none at all, pinned tissue.
#include <gtest/gtest.h>

#include <limits>

#include "systems/soft/body/rotation_vector.h"
#include "tests/tool/air_tool.h"

namespace pliant {
namespace {

constexpr double kHardStep = 1.0 / 60;  // [s]

TEST(Tool, ArrivesWhereItsDeviceHasJumpedAndFlipped) {
  for (const Attachment attachment : kBoth)
    for (const double dt : {kHardStep, 0.1}) {
      AirTool tool(attachment);
      const Pose jump{{1, 0, 0}, rotation_of({0, 3.14159265358979, 0})};
      tool.state->set_device(jump, join({60, 0, 0}, {0, 180, 0}));  // velocity of a device that jumps in a frame
      tool.run(1, dt, kGravity);
      tool.state->set_device(jump, Vector6::Zero());
      tool.run(static_cast<int>(10 / dt), dt, dvec3(0));
      ASSERT_TRUE(tool.finite() && tool.state->solvable()) << int(attachment) << ' ' << dt;
      EXPECT_LT(length(tool.state->handle().object_pose().position - jump.position), 1e-6)
          << int(attachment) << ' ' << dt;
    }
}

TEST(Tool, StaysFiniteWhateverItsDeviceSays) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kHuge = 1e300;
  for (const Attachment attachment : kBoth)
    for (const double dt : {1e-3, kHardStep, 0.1}) {
      AirTool tool(attachment);
      tool.state->set_device({{kHuge, 0, 0}, {1, 0, 0, 0}}, Vector6::Constant(1e150));
      tool.run(3, dt, kGravity);
      const auto released_by = [&](const Pose& pose, const Vector6& velocity) {
        tool.state->set_device(pose, velocity);
        return !tool.state->held();
      };
      EXPECT_TRUE(released_by({{kNan, 0, 0}, {1, 0, 0, 0}}, Vector6::Zero()));
      EXPECT_TRUE(released_by({{0, 0, 0}, {0, 0, 0, 0}}, Vector6::Zero()));
      EXPECT_TRUE(released_by({}, Vector6::Constant(1 / 0.0)));
      tool.run(2, dt, kGravity);
      EXPECT_TRUE(tool.finite() && tool.state->solvable()) << int(attachment) << ' ' << dt;
    }
}

TEST(Tool, OfASingleRowOfHandleNodesIsSolvable) {
  const Bar bar = make_bar(3, 1, 1, 0.01, [](std::uint32_t i, std::uint32_t j, std::uint32_t) {
    return i == 0 && j == 0 ? Role::kHandle : Role::kFree;
  });
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment, bar);
    tool.state->set_device({{0.02, 0, 0}, rotation_of({0, 0, 1})}, Vector6::Zero());
    tool.run(50, kHardStep, kGravity);
    EXPECT_TRUE(tool.finite() && tool.state->solvable());
  }
}

TEST(Tool, ThatIsAllHandleIsARigidBody) {
  const Bar bar = make_bar(2, 1, 1, 0.01, [](std::uint32_t, std::uint32_t, std::uint32_t) { return Role::kHandle; });
  Handle6 handle;
  for (const SolverKind kind : available_solvers()) {
    SoftBodyState state(bar.tets, bar.collision_mesh, {}, &handle, Pose{}, kind);
    ASSERT_EQ(state.size(), 6);
    for (int i = 0; i < 30; ++i) {
      state.free_step(kHardStep, kGravity);
      state.advance(kHardStep);
    }
    EXPECT_TRUE(state.solvable());
    EXPECT_LT(length(state.handle().object_pose().position - dvec3(0, -9.81 * kHardStep * kHardStep * 30 * 31 / 2, 0)),
              1e-12);
    EXPECT_LT(state.tissue_matrix().norm(), 1e-12 * state.handle_mass().norm());
  }
}

TEST(Tool, WithoutAHandleIsTissueThatFalls) {
  const Bar bar = make_finger(2, 1, 1, 0.01);  // a handle that is not declared
  SoftBody body;
  SoftBodyState state(bar.tets, bar.collision_mesh, body, nullptr, Pose{{0, 1, 0}, {1, 0, 0, 0}},
                      SolverKind::kEigenCholesky);
  EXPECT_FALSE(state.has_handle());
  EXPECT_EQ(state.size(), 3 * static_cast<int>(bar.tets.node_count()));
  for (int i = 0; i < 30; ++i) {
    state.free_step(kHardStep, kGravity);
    state.advance(kHardStep);
  }
  // Implicit Euler falls by g T^2 n (n + 1) / 2.
  for (std::uint32_t i = 0; i < bar.tets.node_count(); ++i)
    EXPECT_LT(length(state.tissue().position()[i] - bar.tets.nodes[i] -
                     dvec3(0, 1 - 9.81 * kHardStep * kHardStep * 30 * 31 / 2, 0)),
              1e-12);
}

TEST(Tool, IsPinnedWhereItIsPinned) {
  const Bar bar = make_bar(4, 1, 1, 0.01, [](std::uint32_t i, std::uint32_t, std::uint32_t) {
    return i == 0 ? Role::kHandle : i == 4 ? Role::kPinned : Role::kFree;
  });
  for (const Attachment attachment : kBoth) {
    AirTool tool(attachment, bar);
    tool.state->set_device({{-0.01, 0, 0}, {1, 0, 0, 0}}, Vector6::Zero());
    tool.run(300, kHardStep, dvec3(0));
    for (std::uint32_t i = bar.tets.pinned_begin(); i < bar.tets.node_count(); ++i)
      EXPECT_EQ(tool.state->tissue().position()[i], bar.tets.nodes[i]);
    // It is stretched; the device resists it.
    EXPECT_LT(linear(tool.state->coupling_wrench()).x, -1e-3);
    EXPECT_NEAR((tool.state->coupling_wrench() + tool.state->tissue_wrench()).norm(), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace pliant
