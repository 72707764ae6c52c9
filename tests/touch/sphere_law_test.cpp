// The force of a sphere on tissue of known modulus: Hertz's, Sneddon's exact sphere, and a sphere on a bonded layer.
#include <gtest/gtest.h>

#include <cmath>

#include "components/bonded_layer.h"
#include "components/sphere_curve.h"
#include "content/keys/extensions.h"
#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/touch/model/contact_law.h"

namespace pliant {
namespace {

// Sneddon (1965): depth and force over E* of a sphere of radius 1 by its contact radius a.
struct Sneddon {
  double depth, force;
};
Sneddon sneddon(double a) {
  const double log = std::log((1 + a) / (1 - a));
  return {a / 2 * log, (1 + a * a) / 2 * log - a};
}

TEST(SphereLaw, SneddonsSphereIsItsClosedFormWithItsSlope) {
  for (double a = 0.01; a < 0.999; a += 0.0173) {
    const auto [depth, force] = sneddon(a);
    const SphereCurve::Value at = sneddon_sphere().at(depth);
    EXPECT_NEAR(4.0 / 3.0 * at.value / force, 1.0, 1e-6) << a;
    EXPECT_NEAR(4.0 / 3.0 * at.slope / (2 * a), 1.0, 1e-5) << a;  // dF/dd = 2 E* a
  }
}

TEST(SphereLaw, SneddonsSphereIsHertzsWhereItIsShallowAndElevenPercentSofterAtItsRadius) {
  for (const double x : {1e-8, 1e-6, 1e-4}) EXPECT_NEAR(sneddon_sphere().at(x).value / std::pow(x, 1.5), 1.0, 0.3 * x);
  // a = 0.8336 R where d = R, by bisection on the closed form.
  double low = 0.5, high = 0.99;
  for (int i = 0; i < 60; ++i) (sneddon(0.5 * (low + high)).depth < 1.0 ? low : high) = 0.5 * (low + high);
  const double ratio = 4.0 / 3.0 / sneddon(low).force;
  EXPECT_NEAR(ratio, 1.11, 0.005);
  EXPECT_NEAR(1.0 / sneddon_sphere().at(1.0).value, ratio, 1e-6);
}

TEST(SphereLaw, TheEnergyIsTheIntegralOfTheForceAlsoBeyondTheLastPiece) {
  for (const SphereCurve* curve : {&sneddon_sphere(), &layer_sphere(0.3)}) {
    double sum = 0.0, before = 0.0;
    for (double x = 0.0; x < 400.0;) {
      const double next = x < 1e-3 ? x + 1e-5 : x * 1.003, middle = 0.5 * (x + next);
      sum += (next - x) / 6 * (before + 4 * curve->at(middle).value + curve->at(next).value);
      x = next, before = curve->at(x).value;
      if (x > 1e-3) ASSERT_NEAR(curve->at(x).integral / sum, 1.0, 1e-4) << x;
      const double e = 1e-6 * x;
      ASSERT_NEAR((curve->at(x + e).value - curve->at(x - e).value) / (2 * e), curve->at(x).slope,
                  1e-4 * curve->at(x).slope)
          << x;
    }
  }
}

TEST(SphereLaw, OnADeepLayerItIsHertzsAndStiffensAsTheSeriesOfGarciaAndGarcia) {
  for (const double x : {1e-8, 1e-6}) EXPECT_NEAR(layer_sphere(0.45).at(x).value / std::pow(x, 1.5), 1.0, 2e-3);
  // Biophysical J. 114 (2018) 2923: a sphere on a bonded layer of Poisson's ratio 1/2, chi = sqrt(R d) / h. It corrects
  // the series of Dimitriadis et al. (2002), whose second coefficient, 1.283, is too small.
  for (const double chi : {0.02, 0.05, 0.1, 0.2}) {
    const double series = 1 + chi * (1.133 + chi * (1.497 + chi * (1.469 + 0.755 * chi)));
    EXPECT_NEAR(layer_sphere(0.5).at(chi * chi).value / (chi * chi * chi) / series, 1.0, 1.5e-3) << chi;
  }
}

TEST(SphereLaw, OnAThinLayerItIsABedOfColumns) {
  // p = M d(r) / h over the circle that the sphere cuts out: F = pi R M d^2 / h; x = d R / h^2.
  const double nu = 0.3, modulus = (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * (1 - nu * nu);
  for (const double x : {100.0, 150.0})
    EXPECT_NEAR(4.0 / 3.0 * layer_sphere(nu).at(x).value / (M_PI * modulus * x * x), 1.0, 0.08) << x;
}

// Between the solved contact radii, too.
TEST(SphereLaw, OnALayerItIsTheSolutionOfItsEquationAtEveryContactRadius) {
  for (const double nu : {0.0, 0.3, 0.45, 0.49, 0.5})
    for (double ratio = 0.013; ratio < 19.0; ratio *= 1.37) {
      const LayerPress press = sphere_on_layer(ratio, nu);
      EXPECT_NEAR(4.0 / 3.0 * layer_sphere(nu).at(press.depth).value / press.force, 1.0, 1e-4) << nu << ' ' << ratio;
    }
}

// Force of a probe on a block of known modulus.
TEST(SphereLaw, AProbeFeelsIt) {
  struct Case {
    SphereForce sphere;
    double thickness, radius, depth;
  };
  for (const Case& c :
       {Case{SphereForce::kHertz, 0.0, 0.006, 0.006}, Case{SphereForce::kSneddon, 0.0, 0.006, 0.006},
        Case{SphereForce::kHertz, 0.006, 0.006, 0.0015}, Case{SphereForce::kHertz, 0.003, 0.006, 0.0015}}) {
    Deformable d = frictionless();
    d.young = 1e4;
    d.poisson = 0.45;
    d.thickness = c.thickness;
    d.sphere = c.sphere;
    d.stiffness = calibrated_stiffness(d.young, d.poisson, d.thickness);
    scenes::Stage stage;
    stage.add(scenes::sheet(40, 0.2), d);
    const Entity probe = stage.add_probe({0.013, c.radius + 1e-3, 0.007}, c.radius);
    stage.prepare();
    stage.move(probe, {0.013, c.radius - c.depth, 0.007}, 1.0);
    double want = 0.0;
    const double modulus = d.young / (1 - d.poisson * d.poisson);
    if (c.thickness > 0) {  // by bisection on the contact's radius
      double low = 1e-3, high = 20.0;
      const double h = c.thickness, x = c.depth * c.radius / (h * h);
      for (int i = 0; i < 40; ++i) {
        const double middle = std::sqrt(low * high);
        (sphere_on_layer(middle, d.poisson).depth < x ? low : high) = middle;
      }
      want = modulus * h * h * h / c.radius * sphere_on_layer(low, d.poisson).force;
    } else if (c.sphere == SphereForce::kSneddon) {
      double low = 1e-3, high = 0.999;
      for (int i = 0; i < 60; ++i)
        (c.radius * sneddon(0.5 * (low + high)).depth < c.depth ? low : high) = 0.5 * (low + high);
      want = modulus * c.radius * c.radius * sneddon(low).force;
    } else {
      want = 4.0 / 3.0 * modulus * std::sqrt(c.radius) * std::pow(c.depth, 1.5);
    }
    EXPECT_NEAR(stage.read(probe).normal_force, want, 1e-3 * want) << int(c.sphere) << ' ' << c.thickness;
  }
}

// A sphere on relaxing tissue of known modulus: pressed at once, 1 + k1 / k times the slow force at every depth.
TEST(SphereLaw, TheArmOfARelaxingLawScalesWithIt) {
  for (const SpringLaw spring : {SpringLaw::kStandardLinearSolid, SpringLaw::kQuasiLinearCubic}) {
    Deformable d = frictionless(spring);
    d.young = 1e4;
    d.stiffness = calibrated_stiffness(d.young, d.poisson, 0.0);
    d.relaxation_stiffness = 0.7 * d.stiffness;
    const Motion moves = motion(d, 1e-3);
    const ContactLaw law = contact_law(d, moves, 1.0, 0.004);
    for (const double depth : {1e-5, 1e-4, 1e-3, 4e-3})
      EXPECT_NEAR(law.stored(depth).force / law.force(depth), 1.7, 1e-9) << depth;
  }
}

}  // namespace
}  // namespace pliant
