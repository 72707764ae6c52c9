// The bonded layer against what others have published and against its limits.
#include "content/keys/bonded_layer.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(BondedLayer, TheFactorsAreThoseOfHayesAndOthers) {
  // J. Biomechanics 5 (1972), table 1 (plane-ended indenter): three digits behind the point.
  struct Row {
    double ratio, at30, at40, at50;
  };
  for (const Row& row : {Row{0.2, 1.207, 1.232, 1.281}, Row{0.4, 1.472, 1.542, 1.683}, Row{0.6, 1.784, 1.917, 2.211},
                         Row{0.8, 2.124, 2.337, 2.855}, Row{1.0, 2.480, 2.789, 3.609}}) {
    EXPECT_NEAR(bonded_layer_factor(row.ratio, 0.3) / row.at30, 1.0, 0.003) << row.ratio;
    EXPECT_NEAR(bonded_layer_factor(row.ratio, 0.4) / row.at40, 1.0, 0.003) << row.ratio;
    EXPECT_NEAR(bonded_layer_factor(row.ratio, 0.5) / row.at50, 1.0, 0.004) << row.ratio;
  }
}

TEST(BondedLayer, DeepItIsTheHalfSpaceAndThinItIsPressedLikeAColumn) {
  EXPECT_EQ(bonded_layer_factor(0.0, 0.45), 1.0);
  EXPECT_NEAR(bonded_layer_factor(1e-4, 0.45), 1.0, 2e-4);
  // F = pi a^2 M d / h with the modulus of a column that cannot widen, M = E (1 - nu) / ((1 + nu) (1 - 2 nu)).
  const double nu = 0.3, modulus = (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  EXPECT_NEAR(bonded_layer_factor(20, nu) / (20 * 3.14159265 * (1 - nu * nu) * modulus / 2), 1.0, 0.015);
}

TEST(BondedLayer, ItGrowsWithTheRadiusAndWithPoissonsRatio) {
  for (const double nu : {0.0, 0.3, 0.49, 0.5})
    for (double ratio = 0.1; ratio < 19; ratio *= 1.5)
      EXPECT_GT(bonded_layer_factor(1.5 * ratio, nu), bonded_layer_factor(ratio, nu)) << ratio << ' ' << nu;
  EXPECT_GT(bonded_layer_factor(1, 0.5), bonded_layer_factor(1, 0.49));
}

}  // namespace
}  // namespace pliant
