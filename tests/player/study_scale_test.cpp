// The study `scale`: its fit against known powers, and what its scenes hold.
#include <gtest/gtest.h>

#include <cmath>

#include "player/study/power_law.h"
#include "player/study/step_cost.h"
#include "player/study/tick_cost.h"

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

// y = x with errors of -a, 0, +2a, 0, -a in the logarithm, even steps of 1: orthogonal to constant and slope.
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

}  // namespace
}  // namespace pliant
