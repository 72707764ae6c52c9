// The study `fidelity` against known results: P1's own law and shape, and small strains.
#include "lab/study/fidelity/study_fidelity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

TEST(StudyFidelity, APressedSurfaceHasTheLawsForceAndItsShapesProfile) {
  const Indented what;
  DeformableParameters d;
  d.stiffness = 120;
  d.shape = Shape::kPunch;
  d.reach = 5 * what.radius;
  const auto model = press_surface(what, d);
  ASSERT_TRUE(model);
  for (std::size_t i = 0; i < what.depths.size(); ++i)
    EXPECT_NEAR(model->force[i], d.stiffness * what.depths[i], 1e-3 * model->force[i]);
  const PressTruth same{"the same", what.radius, engine_share(d.shape, what.radius, d.reach)};
  EXPECT_LT(surface_error(*model, same), 1e-3);
  d.shape = Shape::kGaussian;
  const auto other = press_surface(what, d);
  ASSERT_TRUE(other);
  EXPECT_GT(surface_error(*other, same), 0.05);
}

TEST(StudyFidelity, ABlockOfCorotationalTissueIsTheLinearOneWhileTheDentIsSmall) {
  Indented what;
  BlockPress press = what.block(1);
  const auto turning = press_block(press, 2e-6);
  press.strain = Strain::kLinear;
  const auto linear = press_block(press, 2e-6);
  ASSERT_TRUE(turning && linear);
  EXPECT_NEAR(turning->force, linear->force, 1e-3 * linear->force);
}

TEST(StudyFidelity, AFittedLawIsFoundAgainWhereTheTruthIsOne) {
  const std::vector<double> depths{0.0005, 0.001, 0.002};
  DeformableParameters law;
  law.spring = SpringLaw::kExponential;
  Indentation truth;
  const double alpha = 0.1 / depths.back();  // a value in the fit's list
  for (const double d : depths) truth.force.push_back(90 * std::expm1(alpha * d) / alpha);
  const DeformableParameters found = fitted_law(law, depths, truth.force);
  EXPECT_NEAR(found.stiffness, 90, 1e-6);
  EXPECT_NEAR(found.stiffening, alpha, 1e-9 * alpha);
  Indentation half = truth;
  for (double& f : half.force) f *= 0.5;
  EXPECT_NEAR(force_error(half, truth), 0.5, 1e-12);
}

TEST(StudyFidelity, NoLawIsJudgedWhereItWasFitted) {
  const Indented what;
  for (const double depth : what.depths)
    EXPECT_EQ(std::count(what.fit_depths.begin(), what.fit_depths.end(), depth), 0) << depth;
}

TEST(StudyFidelity, ErrorsAreTheSameBitsInEveryRun) {
  Indented what;
  what.depths = {0.001};
  PressRun coarse{0.012, 0.05};
  const auto first = press_tissue(what, coarse), second = press_tissue(what, coarse);
  ASSERT_TRUE(first && second);
  EXPECT_GT(first->force[0], 0.0);
  EXPECT_EQ(first->force, second->force);
  EXPECT_EQ(first->surface, second->surface);
}

}  // namespace
}  // namespace pliant
