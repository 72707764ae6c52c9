// The bonded layer against published values and its limits.
#include "components/bonded_layer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "content/keys/layer_sphere.h"

namespace pliant {
namespace {

constexpr double kPi = 3.14159265358979323846;

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
  // F = pi a^2 M d / h with the modulus of a laterally confined column, M = E (1 - nu) / ((1 + nu) (1 - 2 nu)).
  const double nu = 0.3, modulus = (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  EXPECT_NEAR(bonded_layer_factor(20, nu) / (20 * 3.14159265 * (1 - nu * nu) * modulus / 2), 1.0, 0.015);
}

// Thinner than the integral equation is solved for: against its solution where both can be had, and the column's
// stiffness.
TEST(BondedLayer, AVeryThinLayerGoesOnGettingStiffer) {
  for (const double nu : {0.0, 0.3, 0.45, 0.49})
    for (const double ratio : {20.000001, 25.0, 40.0, 60.0})
      EXPECT_NEAR(bonded_layer_factor(ratio, nu) / BondedLayer(ratio, nu).factor(), 1.0, 0.01) << ratio << ' ' << nu;
  for (const double nu : {0.0, 0.3, 0.49}) {
    const double column = (1 - nu) * (1 - nu * nu) / ((1 + nu) * (1 - 2 * nu));
    EXPECT_NEAR(bonded_layer_factor(1e5, nu) / (1e5 * kPi * column / 2), 1.0, 2e-4) << nu;
  }
  // That cannot be compressed: F = 3 pi G a^4 d / (8 h^3), with the rim's share.
  EXPECT_NEAR(bonded_layer_factor(1e4, 0.5) / (3 * kPi * 1e12 / 64), 1.0, 2e-3);
}

TEST(BondedLayer, ItGrowsWithTheRadiusAndWithPoissonsRatio) {
  for (const double nu : {0.0, 0.3, 0.49, 0.5})
    for (double ratio = 0.1; ratio < 1000; ratio *= 1.5)
      EXPECT_GT(bonded_layer_factor(1.5 * ratio, nu), bonded_layer_factor(ratio, nu)) << ratio << ' ' << nu;
  EXPECT_GT(bonded_layer_factor(1, 0.5), bonded_layer_factor(1, 0.49));
}

TEST(BondedLayer, ItsSurfaceIsTheHalfSpacesWhereItIsDeepAndGoesOnFromThePunch) {
  const BondedLayer deep(1e-5, 0.45);
  for (const double r : {1.01, 1.5, 3.0, 8.0}) EXPECT_NEAR(deep.surface(r), 2 / kPi * std::asin(1 / r), 3e-5) << r;
  for (const double ratio : {0.2, 1.0, 4.0})
    for (const double nu : {0.3, 0.5}) {
      const BondedLayer layer(ratio, nu);
      EXPECT_EQ(layer.surface(0.7), 1.0);
      EXPECT_NEAR(layer.surface(1 + 1e-10), 1.0, 1e-4) << ratio << ' ' << nu;
    }
}

TEST(BondedLayer, WhatAPunchPushesDownRisesBesideItWhereTheLayerKeepsItsVolume) {
  // For a bonded layer with Poisson's ratio 1/2, the integral of u r dr over the whole plane is zero. For smaller
  // ratios it is not.
  const auto volume = [](double nu) {
    const BondedLayer layer(1.0, nu);
    double sum = 0.5;
    constexpr int kSteps = 4000;
    for (int i = 0; i < kSteps; ++i) {  // r = 1 + s^2, to 17
      const double ds = 4.0 / kSteps, s = (i + 0.5) * ds, r = 1 + s * s;
      sum += layer.surface(r) * r * 2 * s * ds;
    }
    return sum;
  };
  EXPECT_NEAR(volume(0.5), 0.0, 2e-3);
  EXPECT_GT(volume(0.3), 0.4);
}

TEST(LayerSphere, DeepItIsHertzs) {
  const double R = 0.004;
  for (const double thickness : {0.0, 100.0}) {
    const LayerSphere sphere(R, thickness, 0.45, 0.001);
    for (const double d : {1e-5, 3e-4, 1e-3})
      EXPECT_NEAR(sphere.force(d) / (4.0 / 3.0 * std::sqrt(R * d) * d), 1.0, 1e-4) << thickness << ' ' << d;
  }
}

TEST(LayerSphere, ItIsTheSeriesOfGarciaAndGarciaWhileTheContactIsNarrow) {
  // Biophysical J. 114 (2018) 2923: a sphere on a bonded layer of Poisson's ratio 1/2, chi = sqrt(R d) / h. It corrects
  // the series of Dimitriadis et al. (2002), whose second coefficient, 1.283, is too small.
  const double R = 0.004;
  for (const double h : {0.02, 0.01, 0.005})
    for (const double d : {5e-5, 1e-4, 2e-4}) {
      const double chi = std::sqrt(R * d) / h;
      const double series = 1 + chi * (1.133 + chi * (1.497 + chi * (1.469 + 0.755 * chi)));
      const LayerSphere sphere(R, h, 0.5, 2e-4);
      EXPECT_NEAR(sphere.force(d) / (4.0 / 3.0 * std::sqrt(R * d) * d * series), 1.0, 1.5e-3) << chi;
    }
}

TEST(LayerSphere, ThinItIsABedOfColumns) {
  // p = E' M d(r) / h over the circle that the sphere cuts out: F = pi R M d^2 / h.
  const double R = 0.004, h = 1e-4, nu = 0.3, d = 4e-4;
  const double modulus = (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * (1 - nu * nu);
  const LayerSphere sphere(R, h, nu, d);
  EXPECT_NEAR(sphere.force(d) / (kPi * R * modulus * d * d / h), 1.0, 0.02);
}

}  // namespace
}  // namespace pliant
