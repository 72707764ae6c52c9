// The depth below several sides: one value and its derivatives, whatever feet stand for a side (foot_blend.h).
#include "systems/touch/collide/foot_blend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pliant {
namespace {

// A side that is a sphere around x: all of its foot in closed form.
struct RoundSide {
  dvec3 centre;
  double radius;
  Foot foot(dvec3 x) const {
    Foot out;
    const dvec3 r = x - centre;
    const double far = length(r);
    out.normal = r / far;
    out.p = centre + radius * out.normal;
    out.height = far - radius;
    const dmat3 across = dmat3(1.0) - glm::outerProduct(out.normal, out.normal);
    out.turns = across / far;
    out.moves = radius * out.turns;
    return out;
  }
};

struct Sides3 {
  std::array<RoundSide, 3> side;
  dvec3 faced{0};  // normal of the tangent plane of the last side; zero: its foot is not on an edge
  FootBlend at(dvec3 x) const {
    std::array<Foot, kMostFeet> feet;
    for (std::size_t i = 0; i < side.size(); ++i) feet[i] = side[i].foot(x);
    std::array<Facing, kMostFeet> facing{};
    if (faced != dvec3(0)) facing[2] = {dot(feet[2].normal, faced), glm::transpose(feet[2].turns) * faced};
    return blend_feet(feet, 3, facing);
  }
};

dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> g;
  return normalize(dvec3(g(random), g(random), g(random)));
}

TEST(FootBlendTest, AFootTwiceCountsOnce) {
  const Foot foot = RoundSide{{0, 0, 0}, 1.0}.foot({0.1, 0.2, 0.9});
  const RoundSide beside{{0.3, 0.1, 0}, 1.0};
  const Foot other = beside.foot({0.1, 0.2, 0.9});
  const FootBlend once = blend_feet({foot, other}, 2), twice = blend_feet({foot, foot, other, foot}, 4);
  EXPECT_NEAR(blend_feet({foot, foot}, 2).height, foot.height, 1e-8 * -foot.height);
  EXPECT_NEAR(twice.height, once.height, 1e-8 * -once.height);
  EXPECT_LT(length(twice.gradient - once.gradient), 1e-7);
}

TEST(FootBlendTest, TwoSidesThatTurnIntoOneLeaveItsDepth) {
  double last = 0.0;
  for (const double angle : {0.5, 0.1, 0.02, 0.004}) {
    const FootBlend blend = Sides3{
        {RoundSide{{0, 0, -0.9}, 1.0},
         {{0.9 * std::sin(angle), 0, -0.9 * std::cos(angle)}, 1.0},
         {{0, 0, -0.9}, 1.0}}}.at({0, 0, 0});
    const double lost = 1 - blend.height / -0.1;
    EXPECT_GT(lost, 0.0);
    if (last > 0) EXPECT_LT(lost, 0.1 * last);  // as the square of the angle
    last = lost;
  }
}

TEST(FootBlendTest, SidesAtRightAnglesHaveTheClosedForm) {
  const std::array<Foot, kMostFeet> feet{RoundSide{{-1e4, 0, 0}, 1e4 + 1e-3}.foot({0, 0, 0}),
                                         RoundSide{{0, -1e4, 0}, 1e4 + 1e-3}.foot({0, 0, 0})};
  const FootBlend blend = blend_feet(feet, 2);
  EXPECT_NEAR(blend.height, -1e-3 * std::exp(-0.25 * std::log(kBlendRatio)), 1e-9);
  EXPECT_NEAR(blend.weight[0], 0.5, 1e-6);
}

TEST(FootBlendTest, DerivativesAreThoseOfTheDepth) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const double h = 1e-6;
  int blended = 0;
  for (int n = 0; n < 2000; ++n) {
    Sides3 sides;
    const dvec3 common = random_direction(random);
    const double spread = 0.02 + u(random);
    for (RoundSide& side : sides.side) {
      const dvec3 normal = normalize(common + spread * random_direction(random));
      const double depth = 0.08 + 0.04 * u(random), far = 0.5 + u(random);
      side = {-far * normal, far + depth};
    }
    if (n % 2) sides.faced = normalize(sides.side[2].foot(dvec3(0)).normal + 0.3 * random_direction(random));
    const FootBlend here = sides.at(dvec3(0));
    if (here.count < 2) continue;
    ++blended;
    double sum = 0.0;
    for (std::uint32_t f = 0; f < here.count; ++f) sum += here.weight[f];
    EXPECT_NEAR(sum, 1.0, 1e-9);
    const dvec3 along = random_direction(random);
    const FootBlend ahead = sides.at(h * along), behind = sides.at(-h * along);
    if (ahead.count != here.count || behind.count != here.count) continue;
    EXPECT_NEAR((ahead.height - behind.height) / (2 * h), dot(here.gradient, along), 1e-6) << n;
    EXPECT_LT(length((ahead.normal - behind.normal) / (2 * h) - here.turns * along),
              1e-4 * (1 + length(here.turns * along)));
    EXPECT_LT(length((ahead.p - behind.p) / (2 * h) - here.moves * along), 1e-4 * (1 + length(here.moves * along)));
  }
  EXPECT_GT(blended, 1000);
}

}  // namespace
}  // namespace pliant
