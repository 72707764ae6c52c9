// The linear model of a soft step's handle, against the full solve with a prescribed handle.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <random>

#include "systems/tool/tool_tick.h"
#include "tests/tool/press_scene.h"

namespace pliant {
namespace {

constexpr SweepLimits kThorough{2000, 1e-12, 0};

Vector6 offset(int axis, double size) {
  Vector6 by = Vector6::Zero();
  by[axis] = axis < 3 ? size : size / 0.05;  // [m], or [rad] at a lever of 5 cm
  return by;
}

Vector6 twist(PressScene& scene) {
  return scene.tool().velocity().tail<6>();
}

// Settled under a press, then one more step of T with the handle displaced; the model is of the step before.
struct Moved {
  HandleModel model;
  Vector6 full, twist;
  bool same_contacts = true;  // none opened, closed, or changed between sticking and slipping

  Moved(double T, double tick, double friction, const Vector6& by) {
    PressScene scene(firm_tissue(), firm_handle(), friction);
    const Pose at = scene.settle(T, 2e-3, 120, tick, model);
    const std::vector<ContactPoint> before = scene.contacts;
    scene.step(T, moved(at, by));
    full = scene.wrench();
    twist = pliant::twist(scene);
    for (std::size_t i = 0; i < before.size(); ++i)
      same_contacts = same_contacts && (before[i].impulse.x > 0) == (scene.contacts[i].impulse.x > 0) &&
                      before[i].sliding == scene.contacts[i].sliding;
  }
  TickHandle handle() const {
    TickHandle handle;
    handle.moved = true;
    handle.next = twist;
    handle.velocity = model.handle.velocity;
    return handle;
  }
};

TEST(Linearise, LinearModelIsTheWholeStepWhileContactsStayAsTheyAre) {
  constexpr double T = 0.01;
  int compared = 0;
  for (const double friction : {0.0, 0.5, 20.0})
    for (int axis = 0; axis < 6; ++axis)
      for (const double size : {1e-4, -3e-4, 1e-3}) {
        const Moved m(T, T, friction, offset(axis, size));
        if (!m.same_contacts) continue;
        TickHandle handle = m.handle();
        const Vector6 linear = linear_tick(m.model.linear, m.model.handle.velocity, Vector6::Zero(), T, handle);
        EXPECT_LT((linear - m.full).norm(), 1e-6 * (m.full - m.model.force).norm()) << friction << ' ' << axis;
        ++compared;
      }
  EXPECT_GE(compared, 36);
}

TEST(Linearise, ATickOfTheStepsOwnLengthIsThatStepWhateverBecomesOfTheContacts) {
  constexpr double T = 0.01;
  int changed = 0;
  for (const double friction : {0.0, 0.5})
    for (int axis = 0; axis < 6; ++axis)
      for (const double size : {3e-4, -1e-3, 3e-3, -3e-3}) {
        const Moved m(T, T, friction, offset(axis, size));
        changed += !m.same_contacts;
        CondensedState state;
        state.resize(kMaxCondensed, kMaxModes);
        state.start(m.model.contacts);
        TickHandle handle = m.handle();
        const Vector6 condensed = condensed_tick(m.model.contacts, state, kThorough, handle);
        EXPECT_LT((condensed - m.full).norm(), 1e-7 * (m.full - m.model.force).norm()) << friction << ' ' << axis;
      }
  EXPECT_GE(changed, 12);
}

// A bar between its handle and a wall, settled at every offset with steps so long that inertia is negligible: the force
// on a slow hand. (Under load the tissue's K' = R K R^T neglects the change of R with stress, an error of first order.)
class Tied {
 public:
  static constexpr double T = 1.0;
  Tied()
      : bar_(make_bar(5, 2, 2, 0.01,
                      [](auto i, auto, auto) {
                        return i == 0 ? Role::kHandle : i == 5 ? Role::kPinned : Role::kFree;
                      })),
        handle_(firm_handle()) {
    bodies_.push_back(std::make_unique<SoftBodyState>(bar_.tets, bar_.collision_mesh, firm_tissue(), &handle_, Pose{}));
    delassus_.of.resize(1);
    model.contacts.resize(kMaxCondensed, kMaxModes);
  }
  void settle(const Vector6& by) {
    for (int i = 0; i < 12; ++i) {
      tool().set_device(moved(Pose{}, by), Vector6::Zero());
      tool().free_step(T, dvec3(0));
      tool().correct(Vector::Zero(tool().size()));
      reduce_tool({bodies_, {}, delassus_, problem_, T, 0.15}, 0, 1e-3, model);
      tool().advance(T);
    }
  }
  HandleModel model;

 private:
  SoftBodyState& tool() { return static_cast<SoftBodyState&>(*bodies_[0]); }
  Bar bar_;
  Handle6 handle_;
  std::vector<std::unique_ptr<Body>> bodies_;
  Delassus delassus_;
  ContactProblem problem_;
};

TEST(Linearise, LinearModelErrsByTheSquareOfTheOffsetWhereTissueIsSmooth) {
  Tied rest;
  rest.settle(Vector6::Zero());
  for (int axis = 0; axis < 6; ++axis) {
    std::vector<double> error;
    for (const double size : {1e-4, 3e-4, 1e-3, 3e-3}) {
      Tied there;
      there.settle(offset(axis, size));
      const RigidMotion &from = rest.model.handle, &to = there.model.handle;
      const Vector6 d =
          join(to.pose.position - from.pose.position, vector_of(to.pose.rotation * glm::conjugate(from.pose.rotation)));
      error.push_back((there.model.force - (rest.model.linear.force - rest.model.linear.stiffness * d)).norm());
      EXPECT_LT(error.back(), 0.3 * there.model.force.norm());
    }
    for (int k = 0; k < 2; ++k)
      EXPECT_NEAR(std::log(error[2 + k] / error[k]) / std::log(10.0), 2.0, 0.3) << "axis " << axis;
  }
}

TEST(Linearise, NoPartOfTheLinearModelCanGiveOutEnergy) {
  for (const double friction : {0.0, 0.3, 20.0}) {
    PressScene scene(firm_tissue(), firm_handle(), friction);
    HandleModel model;
    Pose at = scene.settle(0.01, 3e-3, 60, 1e-3, model);
    for (int i = 0; i < 20; ++i) {  // drag it: with little friction everything slips
      at.position += dvec3(1e-3, 0, 0.5e-3);
      scene.step(0.01, at);
      scene.reduce(1e-3, model);
      scene.advance();
      for (const Matrix6& m : {model.linear.stiffness, model.linear.damping, model.linear.mass}) {
        EXPECT_LT((m - m.transpose()).norm(), 1e-12 * (1.0 + m.norm()));
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix6>(m).eigenvalues().minCoeff(), -1e-9 * (1.0 + m.norm()));
      }
    }
    const bool slips = std::any_of(scene.contacts.begin(), scene.contacts.end(), [](auto& c) { return c.sliding; });
    EXPECT_EQ(slips, friction < 1.0);
  }
}

// The tissue starts at rest, unloaded, a little above the ground: all that it ever gives back, the hand has put in.
TEST(Linearise, CondensedTissueNeverGivesOutMoreThanTheHandPutIn) {
  for (const double friction : {0.0, 0.5}) {
    PressScene scene(firm_tissue(), firm_handle(), friction);
    HandleModel model;
    scene.settle(0.016, -0.5e-3, 40, 1e-3, model);
    CondensedState state;
    state.resize(kMaxCondensed, kMaxModes);
    state.start(model.contacts);
    std::mt19937 dice(7);
    std::normal_distribution<double> any(0.0, 1.0);
    Vector6 w = Vector6::Zero();
    double work = 0.0, most = 0.0;  // [J] done on the hand
    for (int i = 0; i < 4000; ++i) {
      TickHandle handle;
      handle.moved = true;
      handle.velocity = w;
      for (int k = 0; k < 6; ++k) w[k] += (k < 3 ? 0.01 : 0.2) * any(dice);
      w -= 0.02 * w + (Vector6() << 0.3 * state.d.head<3>(), 0.3 * state.d.tail<3>()).finished();
      handle.next = w;
      work += 1e-3 * condensed_tick(model.contacts, state, kThorough, handle).dot(w);
      most = std::max(most, work);
    }
    EXPECT_LT(most, 1e-10);
    EXPECT_LT(work, -1e-6);
  }
}

// Pressing and sliding: forces at 1 kHz from steps of 16 ms, each published one step late, against steps of 1 ms.
struct Rates {
  double held = 0, linear = 0, condensed = 0;  // [1] RMS errors over RMS force
};
Rates compare_rates(double friction) {
  constexpr double tick = 1e-3;
  constexpr int ticks = 720, n = 16;
  const auto path = [](const Pose& start, double t) {
    const auto wave = [t](double hz) { return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * hz * t); };
    Vector6 by = Vector6::Zero();
    by << 15e-3 * wave(1.4), -4e-3 * wave(2.8), 0, 0, 0, 0.05 * wave(1.4);
    return moved(start, by);
  };
  std::vector<Vector6> truth, twists;
  PressScene full(firm_tissue(), firm_handle(), friction), coarse(firm_tissue(), firm_handle(), friction);
  for (int i = 0; i <= ticks; ++i) {
    full.step(tick, path(full.start(), i * tick));
    truth.push_back(full.wrench());
    twists.push_back(twist(full));
    full.advance();
  }
  CondensedState state;
  state.resize(kMaxCondensed, kMaxModes);
  HandleModel model;
  double sum = 0;
  Rates rates;
  for (int k = 0; (k + 2) * n <= ticks; ++k) {
    coarse.step(n * tick, path(coarse.start(), k * n * tick));
    coarse.reduce(tick, model);
    coarse.advance();
    state.start(model.contacts);
    Vector6 w = model.handle.velocity, d = Vector6::Zero();
    for (int j = 1; j <= 2 * n; ++j) {
      const auto i = static_cast<std::size_t>(k * n + j);
      TickHandle handle;
      handle.moved = true;
      handle.velocity = w;
      handle.next = twists[i];
      TickHandle same = handle;
      const Vector6 condensed = condensed_tick(model.contacts, state, {20, 1e-4, 0}, handle);
      const Vector6 linear = linear_tick(model.linear, model.handle.velocity, d, tick, same);
      d += tick * twists[i];
      w = twists[i];
      if (j <= n) continue;
      sum += truth[i].head<3>().squaredNorm();
      rates.held += (model.force - truth[i]).head<3>().squaredNorm();
      rates.linear += (linear - truth[i]).head<3>().squaredNorm();
      rates.condensed += (condensed - truth[i]).head<3>().squaredNorm();
    }
  }
  for (double* r : {&rates.held, &rates.linear, &rates.condensed}) *r = std::sqrt(*r / sum);
  return rates;
}

TEST(Linearise, ContactsSolvedAgainEachTickStayNearTheFullSolveWhereAHeldForceDoesNot) {
  const Rates smooth = compare_rates(0.0);
  EXPECT_GT(smooth.held, 0.2);
  EXPECT_LT(smooth.condensed, 0.05);
  EXPECT_LT(smooth.condensed, smooth.linear);
  EXPECT_LT(smooth.linear, smooth.held);
  const Rates rough = compare_rates(0.4);
  EXPECT_LT(rough.condensed, 0.5 * rough.held);
  EXPECT_LT(rough.condensed, rough.linear);
  RecordProperty("smooth", std::to_string(smooth.condensed));
  RecordProperty("rough", std::to_string(rough.condensed));
}

TEST(Linearise, ARigidBodyUnderManyContactsIsSixModesWithoutStiffness) {
  const Mesh mesh = ground_mesh();
  const RigidState body(mesh, Pose{}, {.mass = 0.2, .centre = dvec3(0), .inertia = dmat3(1e-4)});
  std::mt19937 dice(3);
  std::uniform_real_distribution<double> any(-0.03, 0.03);
  Rows answers = Rows::Zero(6, 36), columns;
  std::vector<SurfacePoint> points(12);
  for (int i = 0; i < 12; ++i) {
    points[static_cast<std::size_t>(i)].position = {any(dice), any(dice), any(dice)};
    body.spread(points[static_cast<std::size_t>(i)], dmat3(1), 1.0, answers, 3 * i);
  }
  columns = answers;
  RigidState ready = body;
  ready.free_step(0.01, dvec3(0));
  ready.solve(answers);
  const Eigen::MatrixXd gram = columns.transpose() * answers;
  const StepSplit split{0.01, {}};
  const PivotedFactor factor = factor_pivoted(gram, 48, 1e-6);
  ASSERT_EQ(factor.picks.size(), 6u);
  Rows picked(6, 6), weighed;
  for (int k = 0; k < 6; ++k) picked.col(k) = answers.col(factor.picks[static_cast<std::size_t>(k)]);
  ready.weigh(picked, weighed);
  const Modes modes = find_modes(factor, picked.transpose() * weighed, split, 48, 1e3);
  ASSERT_EQ(modes.count(), 6);
  EXPECT_LT(modes.frequency2.maxCoeff(), 1e-6);
  EXPECT_LT(left_flexibility(gram, modes, split).norm(), 1e-9 * gram.norm() * split.elastic());
}

// Sixty rows and not one mode: a product over nothing, of a size at which Eigen's rankUpdate divides by that nothing.
TEST(Linearise, WhatIsTooStiffForAnyModeIsASpringAlone) {
  const Rows lever = Rows::Random(60, 60);
  const Eigen::MatrixXd gram = lever.transpose() * lever;
  const PivotedFactor factor = factor_pivoted(gram, 48, 1e-6);
  const auto picks = static_cast<Eigen::Index>(factor.picks.size());
  const StepSplit split{0.01, {}};
  const Modes modes = find_modes(factor, 1e-9 * Eigen::MatrixXd::Identity(picks, picks), split, 48, 1e2);
  ASSERT_EQ(modes.count(), 0);
  EXPECT_EQ(left_flexibility(gram, modes, split), split.elastic() * gram);
}

}  // namespace
}  // namespace pliant
