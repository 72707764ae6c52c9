// A soft body with several rigid parts against the whole matrix, dense, of tissue whose nodes all have rows; and what
// it conserves.
#include "systems/soft/body/rigid_parts.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <deque>
#include <random>

#include "systems/prepare_world.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/body/soft_body_state.h"
#include "tests/soft/bar.h"
#include "tests/soft/jointed.h"

namespace pliant {
namespace {

constexpr double kPartsStep = 1.0 / 60;  // [s]
constexpr dvec3 kPartsGravity{0, -9.81, 0};

enum class Held : std::uint8_t { kSlave, kSpring, kNothing };

// Eight cells long: the handle, tissue, a bone, tissue, a bone beside it that shares its elements, tissue.
struct Digit {
  Bar bar;
  SoftBody body;
  Handle6 handle;
  std::unique_ptr<SoftBodyState> state;

  explicit Digit(Held held, SolverKind solver = SolverKind::kDense, double alpha = 0.3) {
    bar = make_bar(8, 2, 2, 0.01, [](std::uint32_t i, std::uint32_t, std::uint32_t k) {
      if (i <= 1) return Role::kHandle;
      if (i == 3 || i == 4) return k > 0 ? Role::kBoneA : Role::kFree;
      return i == 5 || i == 6 ? Role::kBoneB : i == 2 && k == 2 ? Role::kBoneA : Role::kFree;
    });
    body.rayleigh = {alpha, 2e-3};
    handle.attachment = held == Held::kSpring ? Attachment::kSpring : Attachment::kSlave;
    handle.carried = false;  // the compensation is not part of the matrix
    const bool has_handle = held != Held::kNothing;
    if (!has_handle) {  // its nodes are tissue
      bar.tets.free_count += bar.tets.handle_count;
      bar.tets.handle_count = 0;
    }
    const Pose placement{{0.1, 0.2, -0.1}, rotation_of({0.3, -0.5, 0.2})};
    state = std::make_unique<SoftBodyState>(bar.tets, bar.collision_mesh, body, has_handle ? &handle : nullptr,
                                            placement, solver);
    if (has_handle)
      state->set_device({{0.12, 0.21, -0.1}, rotation_of({0.6, -0.5, 0.9})}, join({0.1, 0.05, 0}, {1, 2, 0}));
    else
      state->start_with({0.2, -0.1, 0.4});
  }
  // A step in which impulses [N s] tear at its surface.
  void step(double pull, dvec3 gravity = kPartsGravity) {
    state->free_step(kPartsStep, gravity);
    Rows kick = Rows::Zero(state->size(), 1);
    state->push({.triangle = 3}, pull * dvec3(0, 1, 2), kick, 0);
    state->push({.triangle = 100}, pull * dvec3(0, -1, -2), kick, 0);
    state->solve(kick);
    state->correct(kick.col(0));
    state->advance(kPartsStep);
  }
};

struct Twin {
  Eigen::MatrixXd A, P;  // P: all nodes' velocities by the unknowns
  Vector b;
};

// At the state that a step begins with.
Twin dense_twin(const Digit& digit) {
  const SoftBodyState& state = *digit.state;
  const TetMesh& tets = digit.bar.tets;
  TetMesh loose = tets;
  loose.free_count = tets.node_count(), loose.handle_count = 0, loose.rigid_counts.clear();
  Tissue whole(loose, {.young = digit.body.young, .alpha = digit.body.rayleigh[0], .beta = digit.body.rayleigh[1]},
               tets.node_count());
  whole.position() = state.tissue().position();
  whole.velocity() = state.tissue().velocity();
  whole.assemble(kPartsStep, kPartsGravity);

  Twin out;
  const Eigen::Index free = 3 * tets.free_count;
  out.P = Eigen::MatrixXd::Zero(3 * tets.node_count(), state.size());
  out.P.topLeftCorner(free, free).setIdentity();
  const auto ride = [&](const RigidHandle& part, std::uint32_t first, std::uint32_t count, Eigen::Index column) {
    for (std::uint32_t i = first; i < first + count; ++i)
      out.P.block<3, 6>(3 * i, column) = grip_matrix(state.tissue().position()[i] - part.motion().pose.position);
  };
  std::uint32_t first = tets.rigid_begin();
  for (std::size_t part = 0; part < tets.rigid_counts.size(); ++part) {
    ride(state.rigid_part(static_cast<int>(part)), first, tets.rigid_counts[part],
         free + 6 * static_cast<Eigen::Index>(part));
    first += tets.rigid_counts[part];
  }
  if (state.has_handle()) ride(state.handle(), tets.free_count, tets.handle_count, state.size() - 6);
  out.A = out.P.transpose() * whole.inner().dense() * out.P;
  out.b = out.P.transpose() * whole.right();
  if (state.has_handle()) {
    const RigidMotion motion = state.handle().motion(), device = state.device_target();
    const CouplingStep coupling =
        coupling_step(coupling_force(digit.handle, motion, device), motion, device, kPartsStep);
    out.A.diagonal().tail<6>() += coupling.matrix;
    out.b.tail<6>() += coupling.right;
  }
  return out;
}

double error_of(const Eigen::MatrixXd& x, const Eigen::MatrixXd& truth) {
  return (x - truth).norm() / truth.norm();
}

TEST(RigidParts, TheirStepAndContactsAreThoseOfTheWholeMatrix) {
  for (const Held held : {Held::kSlave, Held::kNothing})
    for (const SolverKind kind : {SolverKind::kDense, SolverKind::kBlockCholesky}) {
      SCOPED_TRACE(testing::Message() << "held " << int(held) << ", solver " << int(kind));
      Digit digit(held, kind);
      for (int i = 0; i < 4; ++i) digit.step(2e-3);
      SoftBodyState& state = *digit.state;
      const Twin twin = dense_twin(digit);
      ASSERT_EQ(state.size(), twin.b.size());
      const Eigen::MatrixXd inverse = twin.A.inverse();
      state.free_step(kPartsStep, kPartsGravity);
      EXPECT_LT(error_of(state.velocity(), inverse * twin.b), 1e-10);
      std::mt19937 random(1);
      std::uniform_real_distribution<double> uniform(-1, 1);
      const Eigen::MatrixXd columns = Eigen::MatrixXd::NullaryExpr(state.size(), 5, [&] { return uniform(random); });
      Rows solved = columns;
      state.solve(solved);
      EXPECT_LT(error_of(solved, inverse * columns), 1e-10);
      if (state.has_handle()) {
        EXPECT_LT(error_of(state.reduced().inverse(), inverse.bottomRightCorner<6, 6>()), 1e-10);
      }

      // Contacts on tissue, on bones' surfaces, at bones (joints) and between two places of the body.
      const dmat3 axes = glm::mat3_cast(rotation_of({0.2, 0.4, -0.7}));
      std::vector<SurfacePoint> points;
      for (std::uint32_t i = 0; i < 8; ++i) points.push_back({.triangle = 19 * i, .barycentric = {0.2, 0.5, 0.3}});
      for (int part = 0; part < state.rigid_count(); ++part)
        points.push_back({.position = state.tissue().position()[7], .part = part});
      const auto count = static_cast<Eigen::Index>(points.size());
      std::vector<PushedSide> sides;
      for (Eigen::Index i = 0; i < count; ++i) {
        sides.push_back({i, &points[static_cast<std::size_t>(i)], &axes, 1.0});
        if (i > 5) sides.push_back({i, &points[static_cast<std::size_t>(i - 5)], &axes, -1.0});
      }
      Rows J = Rows::Zero(state.size(), 3 * count);
      for (const PushedSide& side : sides) state.spread(*side.point, axes, side.sign, J, 3 * side.contact);
      Compliance compliance;
      state.respond(sides, count, compliance);
      EXPECT_LT(
          error_of(compliance.held + compliance.lever * compliance.lever.transpose(), J.transpose() * inverse * J),
          1e-10);
      // The same motion of a point of tissue or bone, by J, and by all nodes.
      Rows moved = Rows::Zero(3, 5);
      state.gather(points[4], axes, 1.0, solved, moved);
      EXPECT_LT(error_of(moved, J.middleCols<3>(12).transpose() * solved), 1e-12);
      Rows weighed;
      state.weigh(columns, weighed);
      Vector mass(3 * digit.bar.tets.node_count());
      for (Eigen::Index i = 0; i < mass.size(); ++i) mass[i] = state.tissue().mass()[static_cast<std::size_t>(i / 3)];
      EXPECT_LT(error_of(weighed, twin.P.transpose() * mass.asDiagonal() * twin.P * columns), 1e-12);
    }
}

TEST(RigidParts, StayRigidAndKeepTheMomentumOfWhatNothingHolds) {
  Digit digit(Held::kNothing, SolverKind::kDense, 0.0);  // damping of mass slows it
  const SoftBodyState& state = *digit.state;
  const TetMesh& tets = digit.bar.tets;
  const auto momentum = [&] {
    dvec3 sum(0);
    for (std::uint32_t i = 0; i < tets.node_count(); ++i)
      sum += state.tissue().mass()[i] * state.tissue().velocity()[i];
    return sum;
  };
  const dvec3 before = momentum();
  double stretched = 0.0;
  for (int i = 0; i < 30; ++i) {
    digit.step(i < 5 ? 2e-3 : 0.0, dvec3(0));  // pairs of impulses
    std::uint32_t first = tets.rigid_begin();
    for (const std::uint32_t count : tets.rigid_counts) {
      for (std::uint32_t n = first + 1; n < first + count; ++n)
        EXPECT_NEAR(length(state.tissue().position()[n] - state.tissue().position()[first]),
                    length(tets.nodes[n] - tets.nodes[first]), 1e-15);
      first += count;
    }
    stretched = std::max(stretched, state.tissue().elastic_energy());
  }
  EXPECT_GT(stretched, 1e-6);  // [J] it was pulled at
  EXPECT_LT(length(momentum() - before), 1e-12 * length(before));
}

TEST(RigidParts, MoveWithTheirBodyWithoutForces) {
  for (const Held held : {Held::kSlave, Held::kSpring}) {
    Digit digit(held);
    SoftBodyState& state = *digit.state;
    const Pose there{{0.3, -0.2, 0.1}, rotation_of({0.9, 0.4, -1.2})};
    state.set_device(there, Vector6::Zero());
    state.set_back();
    for (int i = 0; i < 5; ++i) {
      state.free_step(kPartsStep, dvec3(0));
      state.advance(kPartsStep);
    }
    for (std::uint32_t n = 0; n < digit.bar.tets.node_count(); ++n)
      EXPECT_LT(length(state.tissue().position()[n] - there.to_world(digit.bar.tets.nodes[n])), 1e-13);
  }
}

// A finger along +X, its axis through the origin: the handle, and two bones hinged to it and to each other.
struct GripFinger {
  test::Jointed scene{0.01};
  Entity tool, ground;

  explicit GripFinger(double ground_at, const std::string& tip = "tip") {
    scene.stage.world.simulation.gravity = dvec3(0);
    const Bar bar = make_bar(9, 2, 2, 0.01, [](std::uint32_t i, std::uint32_t j, std::uint32_t) {
      if (i <= 2) return Role::kHandle;
      if (j > 0 && (i == 4 || i == 5)) return Role::kBoneA;
      return j > 0 && (i == 7 || i == 8) ? Role::kBoneB : Role::kFree;
    });
    SoftBody body;
    body.young = 3e4, body.rayleigh = {0.5, 0.01};
    body.friction_static = body.friction_sliding = 0.0;
    body.rigid = {{"middle", {}}, {"tip", {}}};
    Handle6 handle;
    handle.translation = {2000, 20}, handle.rotation = {20, 0.2};
    handle.max_force = 50, handle.max_torque = 5;
    tool = scene.stage.add_soft(bar.tets, body, {{0, -0.01, -0.01}}, &handle);
    RigidBody fixed;
    fixed.fixed = true, fixed.friction_static = fixed.friction_sliding = 0.0;
    ground = scene.stage.add_rigid(scenes::box({0.3, 0.02, 0.1}), fixed, {{0.05, ground_at - 0.01, 0}});
    JointParameters hinge{.kind = JointKind::kHinge,
                          .part_a = "middle",
                          .part_b = kHandlePart,
                          .stiffness = 1.0,
                          .damping = 0.02,
                          .closed = -0.5,
                          .max_force = 0.4};
    scene.join(hinge, tool, tool, {0.03, 0, 0}, test::kAcross, tool);
    hinge.part_a = tip, hinge.part_b = "middle";
    scene.join(hinge, tool, tool, {0.06, 0, 0}, test::kAcross, tool);
    if (tip == "tip") scene.stage.prepare();
  }
  HapticDevice& device() { return scene.stage.device_of(tool); }
  // [rad] of a bone against the handle, about +Z.
  double bent(int bone) {
    const SoftBodyState& state = scene.stage.tissue(tool);
    const dquat q =
        glm::conjugate(state.handle().motion().pose.rotation) * state.rigid_part(bone).motion().pose.rotation;
    return vector_of(q).z;
  }
  void close(double grip, double seconds) {
    const double from = device().grip;
    for (int i = 1; i <= 100; ++i) {
      device().grip = from + (grip - from) * 0.01 * i;
      scene.stage.run(0.01 * seconds);
    }
  }
};

TEST(RigidParts, AJointOfAPartThatABodyHasNotIsRefused) {
  GripFinger finger(-1.0, "nail");
  const Status status = prepare_world(finger.scene.stage.world);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message().find("`nail`"), std::string::npos) << status.error().message();
  EXPECT_NE(status.error().message().find("`middle`, `tip`, `handle`"), std::string::npos) << status.error().message();
}

TEST(RigidParts, BendByAGripToWhereTheirDrivesAreAtRest) {
  GripFinger finger(-1.0);
  finger.close(1.0, 0.5);
  finger.scene.stage.run(0.5);
  // Springs of 1 N m/rad against tissue of E I / gap, some 0.04: within a tenth.
  EXPECT_NEAR(finger.bent(0), -0.5, 0.05);
  EXPECT_NEAR(finger.bent(1), -1.0, 0.10);
  EXPECT_LT(finger.scene.joints().report(0).apart, 1e-5);
  EXPECT_LT(length(finger.device().force_sent), 1e-3);  // nothing holds it outside: inner forces cancel
  EXPECT_LT(length(finger.device().torque_sent), 1e-4);
}

TEST(RigidParts, TheHandFeelsWhatABentTipPressesAndLoopsGiveNothing) {
  GripFinger finger(-0.025);
  scenes::ToolStage& stage = finger.scene.stage;
  finger.close(1.0, 0.5);
  stage.run(0.5);
  EXPECT_GT(finger.bent(1), -0.9);  // it is in the way
  const dvec3 pressed = stage.contact_force(finger.tool, finger.ground), felt = finger.device().force_sent;
  EXPECT_GT(pressed.y, 0.5);
  EXPECT_LT(length(felt - pressed), 0.01 * pressed.y) << felt.x << ' ' << felt.y << ' ' << felt.z;
  // Down and up with a closed grip, without friction: no work comes back that was not put in.
  double work = 0.0, most = 0.0, fed = finger.scene.joints().fed();
  dvec3 before = finger.device().position;
  const auto count = [&] {
    const dvec3 now = finger.device().position;
    work -= dot(finger.device().force_sent, now - before);
    before = now;
    most = std::max(most, length(finger.device().force_sent));
    EXPECT_TRUE(std::isfinite(most));
  };
  const dvec3 start = before;
  double deepest = 0.0;
  for (const double down : {0.004, 0.0, 0.004, 0.0}) {
    stage.lead(finger.tool, start - dvec3(0, down, 0), 0.2, count);
    deepest = std::max(deepest, work);
  }
  stage.run(0.3);
  EXPECT_GT(deepest, 1e-4);  // [J]
  EXPECT_GE(work, -0.01 * deepest);
  EXPECT_NEAR(finger.scene.joints().fed(), fed, 1e-12);
  EXPECT_LT(most, 20.0);
}

// A hand of 0.3 kg on the arm's spring and damper, whose device gives the force after a delay [s].
TEST(RigidParts, AHandThatPressesABentTipComesToRestWithAndWithoutDelay) {
  for (const int delay : {0, 10}) {
    GripFinger finger(-0.025);
    scenes::ToolStage& stage = finger.scene.stage;
    finger.close(1.0, 0.3);
    const dvec3 aim = finger.device().position - dvec3(0, 0.006, 0);
    dvec3 x = finger.device().position, v(0), swing(0);
    std::deque<dvec3> felt(static_cast<std::size_t>(delay), finger.device().force_sent);
    double most = 0.0;
    for (int i = 0; i < 1000; ++i) {
      felt.push_back(finger.device().force_sent);
      v += 1e-3 / 0.3 * (300.0 * (aim - x) - 8.0 * v + felt.front());
      felt.pop_front();
      x += 1e-3 * v;
      finger.device().position = x;
      stage.run(1e-3);
      most = std::max(most, length(finger.device().force_sent));
      if (i >= 800) swing = glm::max(swing, glm::abs(v));
    }
    EXPECT_GT(finger.device().force_sent.y, 0.5) << delay;
    EXPECT_LT(most, 10.0) << delay;
    EXPECT_LT(length(swing), 2e-3) << delay << " [m/s]";
  }
}

}  // namespace
}  // namespace pliant
