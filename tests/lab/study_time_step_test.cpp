// The study `time_step` against known results: free fall, the order of each scheme, and the deepest dent of a spring.
#include "lab/study/time_step/study_time_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lab/study/time_step/engine_step.h"

namespace pliant {
namespace {

TEST(StudyTimeStep, AFallingBlockIsWhereTheClosedFormOfEachSchemeHasIt) {
  TissueScene fall = step_scenes(1)[3];
  fall.obstacle = {};
  constexpr double kStep = 0.01, kEnd = 0.1;
  for (const StepScheme scheme : {StepScheme::kEuler, StepScheme::kMidpoint, StepScheme::kMidpointTwice}) {
    fall.seconds = kEnd;
    const StepTrace trace = trace_of(fall, scheme, kStep, kEnd);
    ASSERT_EQ(trace.size(), 1u);
    // Implicit Euler uses the velocity at the end of each step: the position is g T t / 2 too far.
    const double late = scheme == StepScheme::kEuler ? 0.5 * kStep * kEnd : 0.0;
    const double way = fall.velocity.y * kEnd + fall.gravity.y * (0.5 * kEnd * kEnd + late);
    for (std::size_t i = 0; i < trace[0].size(); ++i)
      EXPECT_NEAR(trace[0][i].y - fall.mesh.nodes[i].y, way, 1e-9) << name_of(scheme);
  }
}

TEST(StudyTimeStep, EulerIsOfOrderOneAndTheOthersOfOrderTwoWhereTheMotionIsSmooth) {
  TissueScene swing = step_scenes(1)[0];
  swing.seconds = 0.1;
  constexpr double kEvery = 1.0 / 30;
  const StepTrace truth = trace_of(swing, StepScheme::kConverged, kEvery / 512, kEvery);
  const auto order = [&](StepScheme scheme) {
    const double coarse = trace_error(swing, trace_of(swing, scheme, kEvery / 32, kEvery), truth, kEvery),
                 fine = trace_error(swing, trace_of(swing, scheme, kEvery / 64, kEvery), truth, kEvery);
    return std::log2(coarse / fine);
  };
  EXPECT_NEAR(order(StepScheme::kEuler), 1.0, 0.2);
  EXPECT_NEAR(order(StepScheme::kMidpointTwice), 2.0, 0.3);
  EXPECT_NEAR(order(StepScheme::kBdf2), 2.0, 0.6);
}

TEST(StudyTimeStep, TheGroundStopsABlockWhoseEnergyIsThenInTheSpringsAndTheTissue) {
  TissueScene impact = step_scenes(1)[3];
  const StepTrace trace = trace_of(impact, StepScheme::kMidpointTwice, 1.0 / 960, 1.0 / 60);
  double lowest = 0.0, last = 0.0;
  for (const std::vector<dvec3>& at : trace) {
    last = at[0].y;
    for (const dvec3 p : at) lowest = std::min(lowest, p.y);
  }
  // The block's kinetic energy and weight, acting on four springs alone, bound the dent.
  double mass = 1000 * 0.04 * 0.04 * 0.04;
  const double deepest = 0.5 * std::sqrt(mass / (4 * impact.stiffness)) + 9.81 * mass / (2 * impact.stiffness);
  EXPECT_LT(lowest, -0.01);
  EXPECT_GT(lowest, -0.01 - 2 * deepest);
  EXPECT_GT(last, -0.01 - deepest);
}

TEST(StudyTimeStep, ALevelStepsAsEulerDoesWhereNothingIsTouched) {
  TissueScene swing = step_scenes(1)[0];
  swing.seconds = 0.2;
  const StepTrace engine = engine_trace(swing, StepMethod::kEuler, 1.0 / 60, 1.0 / 30),
                  euler = trace_of(swing, StepScheme::kEuler, 1.0 / 60, 1.0 / 30);
  ASSERT_EQ(engine.size(), euler.size());
  double farthest = 0.0;
  for (std::size_t k = 0; k < euler.size(); ++k)
    for (std::size_t i = 0; i < euler[k].size(); ++i) {
      EXPECT_LT(length(engine[k][i] - euler[k][i]), 1e-9) << k << ' ' << i;
      farthest = std::max(farthest, length(euler[k][i] - swing.mesh.nodes[i]));
    }
  EXPECT_GT(farthest, 0.005) << "it swings";
}

TEST(StudyTimeStep, ALevelsBallPressesAndItsGroundStops) {
  const std::vector<TissueScene> scenes = step_scenes(2);
  const TissueScene& press = scenes[1];
  const StepTrace pressed = engine_trace(press, StepMethod::kEuler, 1.0 / 120, 1.0 / 30);
  ASSERT_FALSE(pressed.empty());
  double deepest = 0.0;
  for (std::size_t i = 0; i < press.mesh.nodes.size(); ++i)
    deepest = std::max(deepest, press.mesh.nodes[i].y - pressed.back()[i].y);
  EXPECT_NEAR(deepest, 0.008, 0.002);  // the depth reached by the ball
  TissueScene impact = scenes[3];
  impact.seconds = 0.1;
  const StepTrace fallen = engine_trace(impact, StepMethod::kEuler, 1.0 / 480, 1.0 / 480);
  double lowest = 0.0;
  for (const std::vector<dvec3>& at : fallen)
    for (const dvec3 x : at) lowest = std::min(lowest, x.y);
  EXPECT_NEAR(lowest, -0.01, 1e-3);  // the ground
  // A thrown block: its first step has the scene's initial velocity plus gravity's.
  const double T = 1.0 / 480, way = impact.velocity.y * T + impact.gravity.y * T * T;
  EXPECT_NEAR(fallen[0][0].y - impact.mesh.nodes[0].y, way, 1e-9);
}

TEST(StudyTimeStep, ErrorsAreTheSameBitsInEveryRun) {
  TissueScene press = step_scenes(1)[1];
  press.seconds = 0.1;
  const StepTrace a = trace_of(press, StepScheme::kBdf2, 1.0 / 120, 1.0 / 30),
                  b = trace_of(press, StepScheme::kBdf2, 1.0 / 120, 1.0 / 30);
  ASSERT_FALSE(a.empty());
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace pliant
