// A sampled virtual wall behind a simulated device, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "devices/simulated/loop.h"

namespace pliant {
namespace {

// methods.md, reference problem 7: mass, device damping, wall damping -> limit without and with a sample of delay.
TEST(Wall, ExactStabilityLimitIsTheKnownOne) {
  const struct {
    double m, b, B, none, one;
  } known[] = {{.045, .05, 0, 100, 33.3}, {.045, .1, 0, 200, 66.7},  {.045, .5, 0, 1002, 334},
               {.1, 1, 0, 2003, 669},     {.045, .1, 2, 4019, 1332}, {.1, .1, 5, 9704, 3211}};
  for (const auto& k : known) {
    WallPlant plant{.mass = k.m, .damping = k.b};
    const double none = stability_limit(plant, k.B);
    plant.delay = plant.period;
    const double one = stability_limit(plant, k.B);
    EXPECT_NEAR(none, k.none, 0.006 * k.none) << k.m << ' ' << k.b << ' ' << k.B;
    EXPECT_NEAR(one, k.one, 0.006 * k.one) << k.m << ' ' << k.b << ' ' << k.B;
  }
}

// For the linear wall the characteristic polynomial is exact; if roots are within 0.02 % of the unit circle a run is
// too short.
TEST(Wall, SimulationAgreesWithTheCharacteristicPolynomialCellByCell) {
  int stable = 0, unstable = 0, left_out = 0;
  for (const double delay : {0.0, 0.4e-3, 1e-3, 2.5e-3, 10e-3}) {
    for (double K = 10; K < 2e4; K *= 1.7) {
      for (const double B : {0.0, 0.05, 0.5, 2.0, 5.0}) {
        WallLoop loop;
        loop.plant = {.mass = 0.1, .damping = 0.3, .delay = delay};
        loop.wall = {K, B};
        loop.both_ways = true;
        const bool expected = linearly_stable(loop.plant, loop.wall);
        if (expected != linearly_stable(loop.plant, loop.wall, expected ? 0.9998 : 1.0002)) {
          ++left_out;
          continue;
        }
        const WallResult result = run_wall(loop, {.depth = 1e-3}, 2.0);
        EXPECT_EQ(result.verdict == Verdict::kStable, expected)
            << "K " << K << " B " << B << " delay " << delay << ": " << name_of(result.verdict);
        ++(expected ? stable : unstable);
      }
    }
  }
  EXPECT_GT(stable, 40);
  EXPECT_GT(unstable, 40);
  EXPECT_LT(left_out, 40);
}

TEST(Wall, PassivityIsSufficientForStabilityAtEveryDelay) {
  int passive_cells = 0;
  for (const double delay : {0.0, 0.3e-3, 1e-3, 10e-3})
    for (double K = 1; K < 1e4; K *= 1.2)
      for (const double B : {0.0, 0.2, 0.9}) {
        const WallPlant plant{.mass = 0.1, .damping = 1.0, .delay = delay};
        if (!passive(plant, {K, B})) continue;
        ++passive_cells;
        EXPECT_TRUE(linearly_stable(plant, {K, B})) << K << ' ' << B << ' ' << delay;
      }
  EXPECT_GT(passive_cells, 60);
}

// In any hand: b > KT/2 + |B| does not depend on the hand.
TEST(Wall, PassiveWallIsStableInEveryHand) {
  for (const HandImpedance& hand : hand_impedances()) {
    WallLoop loop;
    loop.plant = {.mass = 0.1, .damping = 1.0};
    loop.hand = hand;
    loop.push = 1.0;
    loop.wall = {0.9 * passivity_limit(loop.plant, 0.1), 0.1};
    EXPECT_NE(run_wall(loop, {.depth = 2e-3, .speed = 0.2}, 4.0).verdict, Verdict::kDivergent) << hand.name;
  }
}

// Energy balance of a bilateral sampled wall without friction or quantisation: it generates energy.
TEST(Wall, SampledSpringGivesEnergyAndFrictionOfTheDeviceTakesIt) {
  WallLoop loop;
  loop.plant = {.mass = 0.1, .damping = 0.0};
  loop.wall = {1000.0, 0.0};
  loop.both_ways = true;
  EXPECT_EQ(run_wall(loop, {.depth = 1e-3}, 1.0).verdict, Verdict::kDivergent);
  EXPECT_GT(run_wall(loop, {.depth = 1e-3}, 1.0).work, 0.0);
  loop.plant.damping = 1000.0 * 0.5e-3 * 1.1;
  EXPECT_EQ(run_wall(loop, {.depth = 1e-3}, 1.0).verdict, Verdict::kStable);
}

// The largest initial speed that comes to rest. [m/s]
double largest_start(const WallLoop& loop, double high) {
  double low = 0.0;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (run_wall(loop, {.speed = middle}, 1.0).verdict == Verdict::kStable ? low : high) = middle;
  }
  return low;
}

// Diolaiti: Coulomb friction stabilises an unstable wall for speeds below s. For a sine the exact friction term has
// 4/pi; the balance uses the largest speed, which is conservative.
TEST(Wall, CoulombFrictionHoldsWhatIsSlowerThanTheBalanceSays) {
  for (const double K : {600.0, 1000.0, 2000.0}) {
    WallLoop loop;
    loop.plant = {.mass = 0.2, .damping = 0.1, .friction = 0.05};
    loop.wall = {K, 0.0};
    loop.both_ways = true;
    const WallBalance expected = balance(loop.plant, K);
    ASSERT_EQ(expected.regime, WallRegime::kLocal);
    const double measured = largest_start(loop, 20.0 * expected.speed);
    EXPECT_GT(measured, expected.speed) << K;
    EXPECT_LT(measured, 1.6 * expected.speed) << K;
  }
}

// Without friction, encoder quantisation keeps a passive wall moving, more slowly than the balance's s.
TEST(Wall, CountsWithoutFrictionMakeALimitCycleSlowerThanTheBalanceSays) {
  int cycles = 0;
  for (const double K : {500.0, 1000.0, 2000.0, 3000.0}) {
    WallLoop loop;
    loop.plant = {.mass = 0.2, .damping = 2.0, .encoder = 50e-6};
    loop.wall = {K, 0.0};
    loop.both_ways = true;
    loop.push = 20.5 * K * loop.plant.encoder;  // between two counts: no wall force gives equilibrium
    const WallBalance expected = balance(loop.plant, K);
    ASSERT_EQ(expected.regime, WallRegime::kCycle);
    const WallResult result = run_wall(loop, {.depth = 1.013e-3}, 4.0);
    EXPECT_NE(result.verdict, Verdict::kDivergent) << K;
    EXPECT_LT(result.speed, expected.speed) << K;
    cycles += result.verdict == Verdict::kCycle && result.amplitude > 1e-7;
    loop.plant.friction = 1.05 * 0.5 * K * loop.plant.encoder;  // Abbott and Okamura
    EXPECT_EQ(run_wall(loop, {.depth = 1.013e-3}, 4.0).verdict, Verdict::kStable) << K;
  }
  EXPECT_GT(cycles, 2);
}

}  // namespace
}  // namespace pliant
