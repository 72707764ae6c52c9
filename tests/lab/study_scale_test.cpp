// The study `scale`: its fit against known powers, and the contents of its scenes.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/study/scale/drawn_frame.h"
#include "lab/study/scale/power_law.h"
#include "lab/study/scale/step_cost.h"
#include "lab/study/scale/tick_cost.h"
#include "scenes/scenes.h"
#include "systems/touch/feed/publish.h"
#include "systems/visual/gpu/context.h"

namespace pliant {
namespace {

TEST(StudyScale, AnExactPowerIsFittedWithoutUncertainty) {
  std::vector<double> size{1, 10, 100, 1000}, cost;
  for (const double n : size) cost.push_back(3.0 * std::pow(n, 1.5));
  const PowerLaw law = fit_power(size, cost);
  EXPECT_NEAR(law.power, 1.5, 1e-12);
  EXPECT_NEAR(law.factor, 3.0, 1e-11);
  EXPECT_NEAR(law.within, 0.0, 1e-7);
}

// y = x with errors of -a, 0, +2a, 0, -a in the logarithm, at even steps of 1: orthogonal to constant and slope.
TEST(StudyScale, TheIntervalIsStudentsOfTheResiduals) {
  const double a = 0.1, shape[] = {-a, 0, 2 * a, 0, -a};
  std::vector<double> size, cost;
  for (int i = 0; i < 5; ++i) {
    size.push_back(std::exp(i));
    cost.push_back(std::exp(i + shape[i]));
  }
  const PowerLaw law = fit_power(size, cost);
  EXPECT_NEAR(law.power, 1.0, 1e-12);
  EXPECT_NEAR(law.within, 3.182 * std::sqrt(6 * a * a / 3 / 10), 1e-12);
  EXPECT_TRUE(std::isinf(fit_power({1, 2}, {1, 4}).within));
}

TEST(StudyScale, ACostWithAConstantPartIsFoundCurvedAndFittedWhereItCountsLittle) {
  std::vector<double> size, cost, plain;
  for (int i = 0; i < 10; ++i) {
    size.push_back(std::pow(4.0, i));
    cost.push_back(3000.0 + size.back());
    plain.push_back(size.back());
  }
  const PowerLaw law = fit_power(size, cost);
  EXPECT_FALSE(law.straight());
  EXPECT_GT(law.curvature, 0.0);
  EXPECT_GT(law.power_at_end, law.power);
  EXPECT_NEAR(law.from, size[5], 1e-9 * size[5]);
  EXPECT_TRUE(fit_power({1, 2}, {1, 2}).straight()) << "two points say nothing of it";
}

// log y = x + c x^2 over -2 ... 2, and errors of +-a that are orthogonal to it: the power is that of the tangent.
TEST(StudyScale, TheParabolaAndItsIntervalAreThoseOfTheClosedForm) {
  const double c = 0.25, a = 0.01, shape[] = {-a, 2 * a, 0, -2 * a, a};
  std::vector<double> size, cost;
  for (int i = 0; i < 5; ++i) {
    const double x = i - 2;
    size.push_back(std::exp(x));
    cost.push_back(std::exp(x + c * x * x + shape[i]));
  }
  const PowerLaw law = fit_power(size, cost);
  EXPECT_NEAR(law.curvature, 2 * c, 1e-12);
  EXPECT_NEAR(law.power_at_end, 1 + 2 * c * 2, 1e-12);
  // The variance of the second coefficient is that of the residuals over the sum of (x^2 - 2)^2, 14.
  EXPECT_NEAR(law.curvature_within, 2 * 4.303 * std::sqrt(10 * a * a / 2 / 14), 1e-12);
  EXPECT_FALSE(law.straight());
}

TEST(StudyScale, ASizeThatWasNotMeasuredIsLeftOutOfTheFit) {
  GrowthCurve curve{"some", {2, 4, std::nan(""), 16, std::nan("")}, {}};
  const PowerLaw law = fit_power({1, 2, 4, 8, 16}, curve.cost);
  EXPECT_NEAR(law.power, 1.0, 1e-12);
  EXPECT_NEAR(law.factor, 2.0, 1e-12);
  EXPECT_EQ(curve.last(), 3u);
}

TEST(StudyScale, AsManyVerticesMoveHoweverLargeTheMeshIs) {
  const TickCost small = measure_tick(6'000, 500, 200), large = measure_tick(60'000, 500, 200);
  EXPECT_NEAR(small.vertices, 6'000, 300);
  EXPECT_NEAR(large.vertices, 60'000, 3'000);
  EXPECT_NEAR(large.awake / small.awake, 1.0, 0.4);
  EXPECT_GT(large.p50_us, 0.0);
}

TEST(StudyScale, APaddleHasItsTetrahedraAndMoreStudsMeanMoreContacts) {
  const StepCost few = measure_step(scenes::kPaddles[0], scenes::kBeds[0], 3),
                 many = measure_step(scenes::kPaddles[0], scenes::kBeds[1], 3);
  EXPECT_EQ(few.tetrahedra, 540u);
  EXPECT_GT(few.contacts, 4.0);
  EXPECT_GT(many.contacts, 2.0 * few.contacts);
  EXPECT_GE(few.ms[0], few.ms[1] + few.ms[2]);
}

TEST(StudyScale, WhatAStepAndATickHoldIsTheSameInEveryRun) {
  EXPECT_EQ(measure_tick(6'000, 500, 200).awake, measure_tick(6'000, 500, 200).awake);
  EXPECT_EQ(measure_step(scenes::kPaddles[0], scenes::kBeds[0], 3).contacts,
            measure_step(scenes::kPaddles[0], scenes::kBeds[0], 3).contacts);
}

TEST(StudyScale, ADrawnFrameTakesAllThatChangedAndShowsIt) {
  const auto context = HeadlessContext::create();
  if (!context) GTEST_SKIP() << context.error().message();
  scenes::Stage stage;
  const Entity surface = stage.add(scenes::sphere(12, 0.1), Deformable{});
  const Entity probe = stage.add_probe({0, 0.101, 0});
  stage.prepare();
  auto frames = DrawnFrames::create(stage.world, surface, draws_with_cpu((*context)->renderer_name()));
  ASSERT_TRUE(frames) << frames.error().message();
  EXPECT_GT(frames->draw(stage.world, {}), 0.0);
  const Image before = frames->picture();
  stage.move(probe, {0, 0.06, 0}, 0.1);
  EXPECT_GT(frames->draw(stage.world, {}), 0.0);
  EXPECT_NE(before.rgba, frames->picture().rgba);
  publish(stage.world, {});
  stage.world.snapshots->acquire();
  for (const ObjectSnapshot& object : stage.world.snapshots->read().objects) EXPECT_EQ(object.zone_count, 0u);
}

TEST(StudyScale, RenderersThatDrawWithTheCpuAreKnownByName) {
  EXPECT_TRUE(draws_with_cpu("llvmpipe (LLVM 15.0.6, 256 bits)"));
  EXPECT_TRUE(draws_with_cpu("Google SwiftShader"));
  EXPECT_FALSE(draws_with_cpu("NVIDIA H100 80GB HBM3/PCIe/SSE2"));
}

}  // namespace
}  // namespace pliant
