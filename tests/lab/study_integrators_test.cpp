// The study `integrators` against closed forms: its reference, the order of its schemes and their stability limits.
#include "lab/study/integrators/study_integrators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace pliant {
namespace {

TEST(StudyIntegrators, TheTruthOfTheLinearLawIsTheSumOfItsTwoExponentials) {
  for (const double zeta : {0.0, 0.3, 2.0, 50.0}) {
    const VertexProblem p = vertex_problem(SpringLaw::kLinear, 400.0, zeta);
    const std::complex<double> a = p.b / (2 * p.m), s = std::sqrt(a * a - p.k / p.m), r1 = -a + s, r2 = -a - s;
    const std::vector<double> h = true_heights(p, kDent, 1e-3, 50);
    for (int i = 0; i <= 50; ++i) {
      const double t = 1e-3 * i;
      const auto x = (r1 * std::exp(r2 * t) - r2 * std::exp(r1 * t)) / (r1 - r2);
      EXPECT_NEAR(h[static_cast<std::size_t>(i)] / kDent, x.real(), 1e-9) << zeta << ' ' << i;
    }
  }
}

TEST(StudyIntegrators, TheTruthOfTheUndampedCubicReturnsAfterItsEllipticPeriod) {
  const VertexProblem p = vertex_problem(SpringLaw::kCubic, 400.0, 0.0);
  const double k3 = p.k * p.law.cubic, A2 = kDent * kDent, W = std::sqrt((p.k + k3 * A2) / p.m);
  const double period = 4 * std::comp_ellint_1(std::sqrt(k3 * A2 / (2 * (p.k + k3 * A2)))) / W;
  const std::vector<double> h = true_heights(p, kDent, period / 4, 4);
  EXPECT_NEAR(h[1] / kDent, 0.0, 1e-7);
  EXPECT_NEAR(h[2] / kDent, -1.0, 1e-7);
  EXPECT_NEAR(h[4] / kDent, 1.0, 1e-7);
}

TEST(StudyIntegrators, EachSchemeGainsItsOrderWhenTheStepIsHalved) {
  struct Order {
    Integrator integrator;
    double order;
  };
  for (const SpringLaw law : kIntegratedLaws)
    for (const auto& [integrator, order] :
         {Order{Integrator::kExplicit, 1}, Order{Integrator::kSemiImplicit, 1}, Order{Integrator::kImplicit, 1},
          Order{Integrator::kMidpoint, 2}, Order{Integrator::kDiscreteGradient, 2},
          Order{Integrator::kRungeKutta, 4}}) {
      if (law == SpringLaw::kExponential && order == 4) continue;  // its kink at rest reduces the smoothness
      const VertexProblem p = vertex_problem(law, 1.0, 0.3);
      const std::vector<double> truth = true_heights(p, kDent, 5e-4, 40);  // before the first zero crossing
      const double coarse = integration_error(integrator, p, 1e-3, 5e-4, truth),
                   fine = integration_error(integrator, p, 5e-4, 5e-4, truth);
      EXPECT_NEAR(std::log2(coarse / fine), order, 0.15) << name_of(law) << ' ' << name_of(integrator);
    }
}

TEST(StudyIntegrators, TheLinearLawIsStableUpToTheClosedFormLimitsAndNotBeyond) {
  const auto stable = [](Integrator integrator, double x, double zeta) {
    return is_stable(integrator, problem_at(SpringLaw::kLinear, x, zeta), 1e-3);
  };
  for (const double zeta : {0.1, 0.5, 1.0, 3.0}) {
    const double root = std::sqrt(std::max(0.0, zeta * zeta - 1));
    const double forward = zeta <= 1 ? 2 * zeta : 2 / (zeta + root);
    const double symplectic = 2 * (std::sqrt(1 + zeta * zeta) - zeta);
    for (const auto& [integrator, limit] :
         {std::pair{Integrator::kExplicit, forward}, std::pair{Integrator::kSemiImplicit, symplectic}}) {
      EXPECT_TRUE(stable(integrator, 0.97 * limit, zeta)) << name_of(integrator) << zeta;
      EXPECT_FALSE(stable(integrator, 1.03 * limit, zeta)) << name_of(integrator) << zeta;
    }
  }
  EXPECT_TRUE(stable(Integrator::kRungeKutta, 2.80, 0.0));
  EXPECT_FALSE(stable(Integrator::kRungeKutta, 2.85, 0.0));
  EXPECT_FALSE(stable(Integrator::kExplicit, 0.05, 0.0));
  for (const Integrator integrator :
       {Integrator::kImplicit, Integrator::kDiscreteGradient, Integrator::kExact, Integrator::kEngine})
    EXPECT_TRUE(stable(integrator, 300.0, 0.1)) << name_of(integrator);
}

TEST(StudyIntegrators, TheEnginesStepIsTheExactOneOfTheLinearLawsToSinglePrecision) {
  for (const SpringLaw law : {SpringLaw::kLinear, SpringLaw::kStandardLinearSolid}) {
    const VertexProblem p = vertex_problem(law, 300.0, 0.5);
    const std::vector<double> truth = true_heights(p, kDent, 1e-3, 100);
    EXPECT_LT(integration_error(Integrator::kExact, p, 1e-3, 1e-3, truth), 1e-11);
    EXPECT_LT(integration_error(Integrator::kEngine, p, 1e-3, 1e-3, truth), 1e-5);
  }
}

// RK4 is not compared with RK4 at the same step.
TEST(StudyIntegrators, NoSchemeIsItsOwnTruth) {
  for (const SpringLaw law : {SpringLaw::kCubic, SpringLaw::kExponential})
    for (const double k : {1.0, 1e3}) {
      const VertexProblem p = vertex_problem(law, k, 1.0);
      const double error = integration_error(Integrator::kRungeKutta, p, 1e-5, 1e-5, true_heights(p, kDent, 1e-5, 100));
      EXPECT_GT(error, 0.0) << name_of(law) << ' ' << k;
      EXPECT_LT(error, 1e-8) << name_of(law) << ' ' << k;
    }
}

// Explicit Euler's oscillation grows by sqrt(1 + (omega T)^2) per step: too little in 0.1 s to be visible, 2.7 times in
// 2,000 steps.
TEST(StudyIntegrators, ASwingThatGrowsSlowlyIsUnstableInTheGridToo) {
  for (const IntegratorCase& c : integrate_grid({1.0}, {0.0}, {1e-3})) {
    if (c.law != SpringLaw::kLinear) continue;
    EXPECT_EQ(std::isfinite(c.error), c.integrator != Integrator::kExplicit) << name_of(c.integrator);
  }
}

// For any step length, the oscillation to the soft side of the law does not count as growth.
TEST(StudyIntegrators, ASwingIsWatchedForWholePeriods) {
  for (const SpringLaw law : kIntegratedLaws)
    for (const Integrator integrator : {Integrator::kImplicit, Integrator::kDiscreteGradient, Integrator::kExact})
      EXPECT_TRUE(is_stable(integrator, vertex_problem(law, 1.0, 0.0), 1e-5))
          << name_of(law) << ' ' << name_of(integrator);
}

TEST(StudyIntegrators, ErrorsAreTheSameBitsEveryTime) {
  const auto a = integrate_grid({1e3}, {0.0, 1.0}, {1e-4, 1e-3, 1e-2, 1e-1}),
             b = integrate_grid({1e3}, {0.0, 1.0}, {1e-4, 1e-3, 1e-2, 1e-1});
  ASSERT_EQ(a.size(), 4u * 2u * 4u * kIntegrators.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].error, b[i].error);
}

}  // namespace
}  // namespace pliant
