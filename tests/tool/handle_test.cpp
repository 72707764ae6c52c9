// The rigid handle by itself, and tools of handle and flesh: rigid motion, momentum, equilibrium, hard cases.
#include "systems/tool/handle.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstring>
#include <limits>
#include <random>

#include "systems/tool/rotation_vector.h"
#include "systems/tool/soft_body_state.h"
#include "tests/tool/bar.h"

namespace pliant {
namespace {

constexpr double T = 1.0 / 60;  // [s]
constexpr dvec3 kGravity{0, -9.81, 0};
constexpr std::array<Attachment, 2> kBoth{Attachment::kSlave, Attachment::kSpring};

dvec3 random_vector(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random), y = uniform(random);
  return {x, y, uniform(random)};
}

// Points of different masses, none on a line with two others.
RigidHandle uneven_handle(std::vector<dvec3>& nodes, std::vector<double>& mass) {
  std::mt19937 random(1);
  for (int i = 0; i < 7; ++i) {
    nodes.push_back(random_vector(random) * dvec3(0.01, 0.02, 0.05));
    mass.push_back(1e-3 * (1 + i));
  }
  return RigidHandle(nodes, mass, dvec3(0.1), {{0.1, 0.2, 0.3}, rotation_of({0.4, -1.0, 0.3})});
}

TEST(RigidHandle, HasTheKineticEnergyOfItsNodes) {
  std::vector<dvec3> nodes;
  std::vector<double> mass;
  RigidHandle handle = uneven_handle(nodes, mass);
  const Vector6 w = join({0.3, -0.2, 0.5}, {3, 1, -2});
  double energy = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Vector3d v = grip_matrix(handle.arm(i)) * w;
    energy += 0.5 * mass[i] * v.squaredNorm();
  }
  EXPECT_NEAR(0.5 * w.dot(handle.mass_matrix() * w), energy, 1e-14 * energy);
  EXPECT_EQ(handle.lent_mass().norm(), 0.0);
}

TEST(RigidHandle, NodesKeepTheirPlacesInTheObject) {
  std::vector<dvec3> nodes;
  std::vector<double> mass;
  RigidHandle handle = uneven_handle(nodes, mass);
  handle.set_velocity(join({0.1, 0, 0}, {20, 3, -9}));
  for (int i = 0; i < 100; ++i) handle.advance(T);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const dvec3 rides = handle.motion().pose.position + handle.arm(i);
    EXPECT_LT(length(rides - handle.object_pose().to_world(nodes[i])), 1e-15);
  }
}

TEST(RigidHandle, SpinsFreelyWithItsMomentumKeptAndItsEnergyBounded) {
  std::vector<dvec3> nodes;
  std::vector<double> mass;
  RigidHandle handle = uneven_handle(nodes, mass);
  handle.set_velocity(join({0, 0, 0}, {10, 7, -5}));
  const Vector6 momentum = handle.mass_matrix() * handle.motion().velocity;
  const Eigen::Vector3d moments =
      handle.mass_matrix().bottomRightCorner<3, 3>().selfadjointView<Eigen::Lower>().eigenvalues();
  for (int i = 0; i < 10000; ++i) {
    handle.advance(0.05);  // half a radian a step
    const Vector6& w = handle.motion().velocity;
    ASSERT_LT((handle.mass_matrix() * w - momentum).norm(), 1e-10 * momentum.norm());
    const double energy = 0.5 * w.dot(momentum), square = momentum.squaredNorm();
    ASSERT_LE(energy, 0.5 * square / moments[0] * (1 + 1e-9));
    ASSERT_GE(energy, 0.5 * square / moments[2] * (1 - 1e-9));
  }
}

TEST(RigidHandle, TumblesAsEulersEquationsSay) {
  // Against d(omega)/dt = -I^-1 (omega x I omega) in the body's frame, RK4 at a fine step. First order in T.
  std::vector<dvec3> nodes;
  std::vector<double> mass;
  const dvec3 spin{4, 9, -6};
  const auto error = [&](double dt) {
    nodes.clear(), mass.clear();
    RigidHandle handle = uneven_handle(nodes, mass);
    const dquat start = handle.motion().pose.rotation;
    const Eigen::Matrix3d R = Eigen::Quaterniond(start.w, start.x, start.y, start.z).toRotationMatrix();
    const Eigen::Matrix3d I = R.transpose() * handle.mass_matrix().bottomRightCorner<3, 3>() * R;
    Eigen::Vector3d w = R.transpose() * Eigen::Vector3d(spin.x, spin.y, spin.z);
    const auto rate = [&](const Eigen::Vector3d& o) -> Eigen::Vector3d { return I.ldlt().solve((I * o).cross(o)); };
    const double h = 1e-4;
    for (int i = 0; i < 5000; ++i) {
      const Eigen::Vector3d a = rate(w), b = rate(w + h / 2 * a), c = rate(w + h / 2 * b), d = rate(w + h * c);
      w += h / 6 * (a + 2 * b + 2 * c + d);
    }
    handle.set_velocity(join(dvec3(0), spin));
    for (int i = 0; i < static_cast<int>(std::lround(0.5 / dt)); ++i) handle.advance(dt);
    const dvec3 now = glm::conjugate(handle.motion().pose.rotation) * angular(handle.motion().velocity);
    return (Eigen::Vector3d(now.x, now.y, now.z) - w).norm();
  };
  EXPECT_NEAR(error(4e-4) / error(2e-4), 2.0, 0.1);
  EXPECT_NEAR(error(2e-4) / error(1e-4), 2.0, 0.05);
}

TEST(RigidHandle, OfNodesOnALineCanStillBeTurnedAboutIt) {
  const std::vector<dvec3> line{{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0}}, point{{0.3, 0, 0}};
  const std::vector<double> masses{1e-3, 1e-3, 1e-3}, mass{1e-3};
  for (const RigidHandle& handle :
       {RigidHandle(line, masses, {0.05, 0.02, 0.02}, {}), RigidHandle(point, mass, {0.05, 0.02, 0.02}, {})}) {
    const Matrix6 m = handle.mass_matrix();
    const Eigen::Vector3d moments = m.bottomRightCorner<3, 3>().selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GT(moments.minCoeff(), 1e-2 * m(0, 0) * 0.02 * 0.02);
    EXPECT_GT(handle.lent_mass().norm(), 0.0);
  }
}

// A tool in the air: a finger whose first cells are rigid.
struct Tool {
  Bar bar;
  SoftBody body;
  Handle6 handle;
  std::unique_ptr<SoftBodyState> state;

  explicit Tool(Attachment attachment, Bar shape = make_finger(4, 1, 1, 0.01), double tie = kTieStiffness,
                double beta = 5e-3, bool carried = true)
      : bar(std::move(shape)) {
    body.young = 2e4;
    body.rayleigh = {0.0, beta};
    handle.attachment = attachment;
    handle.carried = carried;
    state = std::make_unique<SoftBodyState>(bar.tets, bar.skin, body, &handle, Pose{}, SolverKind::kEigenCholesky);
    state->set_tie_stiffness(tie);
  }
  void run(int steps, double dt, dvec3 gravity) {
    for (int i = 0; i < steps; ++i) {
      state->free_step(dt, gravity);
      state->advance(dt);
    }
  }
  double mass() const {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < bar.tets.pinned_begin(); ++i) sum += state->flesh().mass()[i];
    return sum;
  }
  // [kg m/s], [kg m2/s about the world's origin]; the handle's nodes are the handle's, however they are attached.
  Vector6 momentum() const {
    const Flesh& flesh = state->flesh();
    const Vector6 h = state->handle().mass_matrix() * state->handle().motion().velocity;
    dvec3 p = linear(h), L = angular(h) + cross(state->handle().motion().pose.position, linear(h));
    for (std::uint32_t i = 0; i < bar.tets.free_count; ++i) {
      p += flesh.mass()[i] * flesh.velocity()[i];
      L += cross(flesh.position()[i], flesh.mass()[i] * flesh.velocity()[i]);
    }
    return join(p, L);
  }
  bool finite() const {
    for (const dvec3 x : state->flesh().position())
      if (!std::isfinite(dot(x, x))) return false;
    return state->velocity().allFinite();
  }
};

TEST(Tool, FollowsItsDeviceWithoutStrainOnceTheWayIsDone) {
  for (const Attachment attachment : kBoth) {
    Tool tool(attachment);
    const dvec3 turn{0.4, 1.2, -0.8}, way{0.3, -0.2, 0.1};
    const int steps = 120;
    double largest = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const double part = double(i) / steps, rate = 1 / (steps * T);
      tool.state->set_device({part * way, rotation_of(part * turn)}, join(rate * way, rate * turn));
      tool.run(1, T, dvec3(0));
      largest = std::max(largest, tool.state->flesh().elastic_energy());
    }
    tool.state->set_device({way, rotation_of(turn)}, Vector6::Zero());
    tool.run(600, T, dvec3(0));
    const RigidMotion& handle = tool.state->handle().motion();
    EXPECT_LT(length(tool.state->handle().object_pose().position - way), 1e-9);
    EXPECT_LT(length(vector_of(handle.pose.rotation * glm::conjugate(rotation_of(turn)))), 1e-8);
    EXPECT_GT(largest, 0.0);
    EXPECT_LT(tool.state->flesh().elastic_energy(), 1e-10 * largest);
    for (std::uint32_t i = 0; i < tool.bar.tets.node_count(); ++i)
      ASSERT_LT(
          length(tool.state->flesh().position()[i] - Pose{way, rotation_of(turn)}.to_world(tool.bar.tets.nodes[i])),
          1e-8);
  }
}

TEST(Tool, SlavedNodesAreRigidToTheLastDigit) {
  Tool tool(Attachment::kSlave);
  tool.state->set_device({{0.1, 0.1, 0}, rotation_of({0, 2, 0})}, Vector6::Zero());
  tool.run(20, T, kGravity);
  const TetMesh& tets = tool.bar.tets;
  for (std::uint32_t i = tets.free_count; i < tets.pinned_begin(); ++i)
    EXPECT_LT(length(tool.state->flesh().position()[i] - tool.state->handle().object_pose().to_world(tets.nodes[i])),
              1e-15);
}

TEST(Tool, LetGoKeepsItsMomentum) {
  for (const Attachment attachment : kBoth) {
    Tool tool(attachment, make_finger(4, 2, 2, 0.01));
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
      Tool tool(attachment, make_finger(4, 1, 1, 0.01), kTieStiffness, /*beta*/ 0.0);
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
    Tool tool(attachment, make_finger(4, 1, 1, 0.01), kTieStiffness, 5e-3, /*carried*/ false);
    tool.state->set_device({}, Vector6::Zero());
    tool.run(500, 0.2, kGravity);
    const double weight = 9.81 * tool.mass();
    EXPECT_LT(weight, tool.handle.max_force);
    EXPECT_LT(length(linear(tool.state->coupling_wrench()) - dvec3(0, weight, 0)), 1e-9 * weight);
    // What flesh adds is the weight of what is not the handle's.
    const dvec3 flesh = linear(tool.state->flesh_wrench() + tool.state->handle_load());
    EXPECT_LT(length(flesh - dvec3(0, -weight, 0)), 1e-9 * weight);
    // And its moment about the handle's centre is what the coupling holds.
    const Vector6 left = tool.state->coupling_wrench() + tool.state->flesh_wrench() + tool.state->handle_load();
    EXPECT_LT(left.tail<3>().norm(), 1e-9 * weight * 0.05);
    EXPECT_GT(length(angular(tool.state->coupling_wrench())), 1e-3 * weight * 0.05);
  }
}

TEST(Tool, CarriedToolPullsAtItsDeviceOnlyByTheMomentOfItsSag) {
  for (const Attachment attachment : kBoth) {
    Tool tool(attachment);
    tool.state->set_device({}, Vector6::Zero());
    tool.run(500, 0.2, kGravity);
    const double weight = 9.81 * tool.mass();
    EXPECT_LT(length(linear(tool.state->coupling_wrench())), 1e-9 * weight);
    // Flesh that bends under its weight moves its centre of mass: that much, and nothing else, is left to the coupling.
    dvec3 centre(0), carried(0);
    const Flesh& flesh = tool.state->flesh();
    for (std::uint32_t i = 0; i < tool.bar.tets.pinned_begin(); ++i) {
      centre += flesh.mass()[i] * flesh.position()[i] / tool.mass();
      carried += flesh.mass()[i] * tool.state->handle().object_pose().to_world(tool.bar.tets.nodes[i]) / tool.mass();
    }
    EXPECT_GT(length(centre - carried), 1e-5);
    const dvec3 moment = cross(centre - carried, dvec3(0, -weight, 0));
    EXPECT_LT(length(angular(tool.state->coupling_wrench()) + moment), 1e-6 * weight * 0.05);
  }
}

TEST(Tool, SpringsThatStiffenLeadToTheToolOfSlavedNodes) {
  const auto shape = [](Attachment attachment, double tie) {
    Tool tool(attachment, make_finger(4, 1, 1, 0.01), tie);
    tool.state->set_device({}, Vector6::Zero());
    tool.run(300, 0.2, kGravity);
    return tool.state->flesh().position();
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

TEST(Tool, TheHandlesMotionIsWhatFleshCouplingAndWeightMakeOfIt) {
  // M_h (w1 - w0) = T (load + F(w1) + coupling), F linear in w: the books of one step balance.
  for (const Attachment attachment : kBoth) {
    Tool tool(attachment);
    tool.state->set_device({{0.05, 0.02, 0}, rotation_of({0, 0.3, 1})}, join({1, 0, 0}, {0, 2, 0}));
    for (int i = 0; i < 5; ++i) {
      const Vector6 w0 = tool.state->handle().motion().velocity;
      tool.state->free_step(T, kGravity);
      const Vector6 w1 = tool.state->velocity().tail<6>();
      const SoftBodyState& s = *tool.state;
      const Vector6 impulse =
          T * (s.handle_load() + s.flesh_wrench() + s.coupling_wrench()) - s.flesh_matrix() * (w1 - w0);
      EXPECT_LT((s.handle_mass() * (w1 - w0) - impulse).norm(), 1e-10 * (T * s.flesh_wrench()).norm())
          << int(attachment);
      const Eigen::Matrix<double, 6, 1> values = s.flesh_matrix().selfadjointView<Eigen::Lower>().eigenvalues();
      EXPECT_GE(values.minCoeff(), -1e-9 * values.maxCoeff());
      tool.state->advance(T);
    }
  }
}

TEST(Tool, SkinMovesWithItsDegreesOfFreedom) {
  for (const Attachment attachment : kBoth) {
    Tool tool(attachment);
    tool.state->set_device({{0.05, 0.02, 0}, rotation_of({0, 0.3, 1})}, join({1, 0, 0}, {0, 2, 0}));
    tool.run(3, T, kGravity);
    SoftBodyState& state = *tool.state;
    const double tiny = 1e-6;
    state.free_step(tiny, kGravity);
    const std::vector<dvec3> before = state.skin_position, rate = state.skin_velocity;
    const Rows v = state.velocity();
    Rows moved = Rows::Zero(static_cast<Eigen::Index>(3 * tool.bar.skin.triangles.size()), 1);
    const dmat3 axes = glm::mat3_cast(rotation_of({0.3, 0.1, -0.4}));
    for (std::uint32_t t = 0; t < tool.bar.skin.triangles.size(); ++t)
      state.gather({t, {0.25, 0.25, 0.5}, {}}, axes, 1.0, v, moved.middleRows<3>(3 * t));
    state.advance(tiny);
    for (std::size_t i = 0; i < before.size(); ++i)
      ASSERT_LT(length((state.skin_position[i] - before[i]) / tiny - rate[i]), 1e-4 * (1 + length(rate[i])));
    for (std::uint32_t t = 0; t < tool.bar.skin.triangles.size(); ++t) {
      const uvec3 c = tool.bar.skin.triangles[t];
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
    Tool tool(attachment, bar);
    SoftBodyState& state = *tool.state;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Rows x = Rows::NullaryExpr(state.size(), 1, [&] { return uniform(random); });
    const dmat3 axes = glm::mat3_cast(rotation_of({0.3, 0.1, -0.4}));
    for (std::uint32_t t = 0; t < bar.skin.triangles.size(); ++t) {
      const SurfacePoint point{t, {0.1, 0.3, 0.6}, {}};
      Rows columns = Rows::Zero(state.size(), 3), out = Rows::Zero(3, 1);
      state.spread(point, axes, -1.0, columns, 0);
      state.gather(point, axes, -1.0, x, out);
      ASSERT_LT((columns.transpose() * x - out).norm(), 1e-13);
    }
  }
}

TEST(Tool, ArrivesWhereItsDeviceHasJumpedAndFlipped) {
  for (const Attachment attachment : kBoth)
    for (const double dt : {T, 0.1}) {
      Tool tool(attachment);
      const Pose jump{{1, 0, 0}, rotation_of({0, 3.14159265358979, 0})};
      tool.state->set_device(jump, join({60, 0, 0}, {0, 180, 0}));  // as a device's speed reads that jumps in a frame
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
    for (const double dt : {1e-3, T, 0.1}) {
      Tool tool(attachment);
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
    Tool tool(attachment, bar);
    tool.state->set_device({{0.02, 0, 0}, rotation_of({0, 0, 1})}, Vector6::Zero());
    tool.run(50, T, kGravity);
    EXPECT_TRUE(tool.finite() && tool.state->solvable());
  }
}

TEST(Tool, ThatIsAllHandleIsARigidBody) {
  const Bar bar = make_bar(2, 1, 1, 0.01, [](std::uint32_t, std::uint32_t, std::uint32_t) { return Role::kHandle; });
  Handle6 handle;
  for (const SolverKind kind : available_solvers()) {
    SoftBodyState state(bar.tets, bar.skin, {}, &handle, Pose{}, kind);
    ASSERT_EQ(state.size(), 6);
    for (int i = 0; i < 30; ++i) {
      state.free_step(T, kGravity);
      state.advance(T);
    }
    EXPECT_TRUE(state.solvable());
    EXPECT_LT(length(state.handle().object_pose().position - dvec3(0, -9.81 * T * T * 30 * 31 / 2, 0)), 1e-12);
    EXPECT_LT(state.flesh_matrix().norm(), 1e-12 * state.handle_mass().norm());
  }
}

TEST(Tool, WithoutAHandleIsFleshThatFalls) {
  const Bar bar = make_finger(2, 1, 1, 0.01);  // whose handle nobody declares
  SoftBody body;
  SoftBodyState state(bar.tets, bar.skin, body, nullptr, Pose{{0, 1, 0}, {1, 0, 0, 0}}, SolverKind::kEigenCholesky);
  EXPECT_FALSE(state.has_handle());
  EXPECT_EQ(state.size(), 3 * static_cast<int>(bar.tets.node_count()));
  for (int i = 0; i < 30; ++i) {
    state.free_step(T, kGravity);
    state.advance(T);
  }
  // Implicit Euler falls by g T^2 n (n + 1) / 2.
  for (std::uint32_t i = 0; i < bar.tets.node_count(); ++i)
    EXPECT_LT(length(state.flesh().position()[i] - bar.tets.nodes[i] - dvec3(0, 1 - 9.81 * T * T * 30 * 31 / 2, 0)),
              1e-12);
}

TEST(Tool, IsPinnedWhereItIsPinned) {
  const Bar bar = make_bar(4, 1, 1, 0.01, [](std::uint32_t i, std::uint32_t, std::uint32_t) {
    return i == 0 ? Role::kHandle : i == 4 ? Role::kPinned : Role::kFree;
  });
  for (const Attachment attachment : kBoth) {
    Tool tool(attachment, bar);
    tool.state->set_device({{-0.01, 0, 0}, {1, 0, 0, 0}}, Vector6::Zero());
    tool.run(300, T, dvec3(0));
    for (std::uint32_t i = bar.tets.pinned_begin(); i < bar.tets.node_count(); ++i)
      EXPECT_EQ(tool.state->flesh().position()[i], bar.tets.nodes[i]);
    // It is stretched; the hand holds against it.
    EXPECT_LT(linear(tool.state->coupling_wrench()).x, -1e-3);
    EXPECT_NEAR((tool.state->coupling_wrench() + tool.state->flesh_wrench()).norm(), 0.0, 1e-6);
  }
}

TEST(Tool, TheSamePathGivesTheSameBits) {
  const auto run = [] {
    Tool tool(Attachment::kSpring);
    tool.state->set_device({{0.05, 0.02, 0}, rotation_of({0, 0.3, 1})}, join({1, 0, 0}, {0, 2, 0}));
    tool.run(10, T, kGravity);
    return tool.state->flesh().position();
  };
  const std::vector<dvec3> a = run(), b = run();
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(dvec3)), 0);
}

TEST(Tool, ShowsItsSkinItsNodesAndWhereItsObjectIs) {
  Tool tool(Attachment::kSlave);
  SoftObjectSnapshot shown;
  tool.state->show(shown);
  ASSERT_EQ(shown.position.size(), tool.bar.skin.vertex_count);
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
