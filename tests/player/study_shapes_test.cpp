// The study `shapes` against what is known: the closed forms' own integrals, and the block against the half-space.
#include "player/study/study_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pliant {
namespace {

constexpr double kContact = 0.004;  // [m]

TEST(StudyShapes, TheTrueProfilesAreContinuousAtTheContactsEdgeAndFallAsAPointLoadFarAway) {
  // Far away both are the point load's F / (pi E* r): a flat punch's 2 a d / (pi r), a sphere's 4/3 a d / (pi r).
  const PressTruth punch = punch_truth(kContact), ball = hertz_truth(kContact);
  EXPECT_NEAR(punch.share(kContact), 1.0, 1e-12);
  EXPECT_NEAR(ball.share(kContact * (1 - 1e-9)), ball.share(kContact * (1 + 1e-9)), 1e-6);
  const double far = 200 * kContact;
  EXPECT_NEAR(punch.share(far) * M_PI * far / kContact, 2.0, 1e-4);
  EXPECT_NEAR(ball.share(far) * M_PI * far / kContact, 4.0 / 3.0, 1e-4);
}

TEST(StudyShapes, TheEnginesPunchAndHertzAreTheTruthInsideHalfTheirReach) {
  for (const auto& [shape, truth] :
       {std::pair{Shape::kPunch, punch_truth(kContact)}, std::pair{Shape::kHertz, hertz_truth(kContact)}})
    EXPECT_LT(shape_error(engine_share(shape, kContact, 11 * kContact), truth).profile, 1e-5) << name_of(shape);
}

TEST(StudyShapes, NoShapeThatIsNotAPunchIsNearOne) {
  // methods.md 1.3 has 34 % for Wendland's at its best.
  const PressTruth punch = punch_truth(kContact);
  const double reach = best_reach(Shape::kWendland, punch);
  EXPECT_NEAR(shape_error(engine_share(Shape::kWendland, kContact, reach), punch).profile, 0.336, 0.005);
  EXPECT_GT(shape_error(engine_share(Shape::kWendland, kContact, 1.3 * reach), punch).profile, 0.336);
  EXPECT_GT(shape_error(engine_share(Shape::kWendland, kContact, 0.7 * reach), punch).profile, 0.336);
}

TEST(StudyShapes, TheForceOnABlockIsLinearInTheDepthAndNearsTheHalfSpacesAsItGetsDeep) {
  BlockPress press{10e3, 0.3, kContact, 2 * kContact, 8 * kContact, 2};
  const auto thin = press_block(press, 1e-4), twice = press_block(press, 2e-4);
  press.thickness = 8 * kContact;
  const auto deep = press_block(press, 1e-4);
  ASSERT_TRUE(thin && twice && deep);
  EXPECT_NEAR(twice->force / thin->force, 2.0, 1e-6);
  const double half_space = 2 * 10e3 / (1 - 0.09) * kContact * 1e-4;
  EXPECT_GT(thin->force, 1.3 * half_space);
  EXPECT_GT(deep->force, half_space);  // bonded, finite, and of few elements: each makes it stiffer
  EXPECT_LT(deep->force, 1.3 * half_space);
  EXPECT_NEAR(deep->share.front(), 1.0, 1e-9);
}

TEST(StudyShapes, ErrorsAreTheSameBitsInEveryRun) {
  const auto measured = [] {
    const auto block = press_block({10e3, 0.45, kContact, 2 * kContact, 8 * kContact, 1}, 1e-4);
    const PressTruth truth = block_truth("block", kContact, *block);
    const ShapeError error =
        shape_error(engine_share(Shape::kPunch, kContact, best_reach(Shape::kPunch, truth)), truth);
    return std::vector{block->force, error.profile, error.volume};
  };
  const std::vector<double> first = measured();
  EXPECT_GT(first[1], 0.0);
  EXPECT_EQ(first, measured());
}

}  // namespace
}  // namespace pliant
