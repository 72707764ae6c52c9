// Every law, shape, probe shape and solver of components/built_in.h, and registered laws: a line in the table is all
// that these tests need.
#include <gmock/gmock.h>

#include <cmath>

#include "components/probe_shape.h"
#include "scenes/touch_laws.h"
#include "systems/touch/model/contact_energy.h"
#include "systems/touch/model/contact_law.h"
#include "systems/touch/model/shape.h"
#include "systems/touch/model/spring_arithmetic.h"

namespace pliant {
namespace {

constexpr double kCubics[] = {0.0, 1e5}, kStiffenings[] = {150.0, -80.0, 1e-6};
constexpr double kHeights[] = {-9e-3, -3.3e-3, -1.001e-3, -1e-6, 1e-6, 1e-3, 5e-3};  // [m]

// Every law that ships, and one that the program registers.
std::vector<SpringLaw> laws() {
  struct Quintic final : SpringFunction {
    double force(double h, const SpringConstants&) const override { return h + 1e9 * std::pow(h, 5); }
    double potential(double h, const SpringConstants&) const override { return h * h / 2 + 1e9 * std::pow(h, 6) / 6; }
    double slope(double h, const SpringConstants&) const override { return 1 + 5e9 * std::pow(h, 4); }
  };
  static const SpringLaw own = *register_spring("quintic", std::make_shared<Quintic>());
  std::vector<SpringLaw> all(kLaws.begin(), kLaws.end());
  all.push_back(own);
  return all;
}

template <class Check>
void for_every_law(Check check) {
  for (const SpringLaw kind : laws())
    for (const double cubic : kCubics)
      for (const double stiffening : kStiffenings) {
        SCOPED_TRACE(std::string(word_of(kind)) + ", cubic " + std::to_string(cubic) + ", stiffening " +
                     std::to_string(stiffening));
        RestoringLaw law{kind, cubic, stiffening};
        law.table = restoring_law(frictionless(SpringLaw::kTable)).table;
        check(law);
      }
}

TEST(LawTable, ForceIsTheDerivativeOfTheEnergyAndTheTangentThatOfTheForce) {
  for_every_law([](const RestoringLaw& law) {
    EXPECT_EQ(law.force(0.0), 0.0);
    EXPECT_EQ(law.potential(0.0), 0.0);
    EXPECT_NEAR(law.slope(0.0), 1.0, 1e-12);
    for (const double h : kHeights) {
      const double e = 1e-4 * std::abs(h);
      EXPECT_NEAR((law.potential(h + e) - law.potential(h - e)) / (2 * e), law.force(h), 1e-6 * std::abs(law.force(h)));
      EXPECT_NEAR((law.force(h + e) - law.force(h - e)) / (2 * e), law.slope(h), 1e-6 * law.slope(h));
      EXPECT_GT(law.slope(h), 0.0);
    }
  });
}

TEST(LawTable, TheMeanForceOfAStepIsTheDifferenceOfTheEnergyOverIt) {
  for_every_law([](const RestoringLaw& law) {
    for (const double h0 : kHeights) {
      for (const double h1 : kHeights) {
        const double work = law.discrete_gradient(h0, h1) * (h1 - h0);
        const double scale = law.potential(h0) + law.potential(h1);
        EXPECT_NEAR(work, law.potential(h1) - law.potential(h0), 1e-9 * scale) << h0 << " to " << h1;
      }
      EXPECT_NEAR(law.discrete_gradient(h0, h0 * (1 + 1e-12)), law.force(h0), 1e-9 * std::abs(law.force(h0))) << h0;
    }
  });
}

// Undamped, the passive step keeps the energy; damped, and as backward Euler, it only loses.
TEST(LawTable, NoStepOfAFreeSurfaceMakesEnergy) {
  for_every_law([](const RestoringLaw& law) {
    for (const double mass : {1e-8, 1e-5, 1e-3})
      for (const double damping : {0.0, 1e-3}) {
        HeightState s{-6e-3, 0.1};
        const auto energy = [&] { return 0.5 * mass * s.velocity * s.velocity + law.potential(s.height); };
        for (int i = 0; i < 300; ++i) {
          const double before = energy();
          const bool keeps = damping == 0.0 && law.slope(s.height) * 1e-6 <= 2.25 * mass;
          s = step_restoring(law, s, mass, damping, 1.0, 0.0, 1e-3);
          ASSERT_LE(energy(), before * (1 + 1e-9) + 1e-18) << mass << ' ' << damping << ' ' << i;
          if (keeps) ASSERT_GE(energy(), before * (1 - 1e-9) - 1e-18) << mass << ' ' << i;
        }
      }
  });
}

// The felt force is the derivative of the stored energy: pressing in and out gains nothing.
TEST(LawTable, AContactStoresTheWorkThatItTakes) {
  for (const SpringLaw kind : laws())
    for (const double radius : {0.0, 0.004})
      for (const double young : {0.0, 5e3}) {
        Deformable d = frictionless(kind);
        if (young > 0.0 && reads_key(kind, "table")) continue;  // both would say the force
        d.young = young;
        const Motion moves = motion(d, 1e-3);
        const ContactLaw law = contact_law(d, moves, 1.0, radius);
        for (const double depth : {1e-4, 1e-3, 5e-3}) {
          const double e = 1e-4 * depth;
          const StoredEnergy at = law.stored(depth);
          EXPECT_GE(at.force, 0.0);
          EXPECT_NEAR((law.stored(depth + e).energy - law.stored(depth - e).energy) / (2 * e), at.force,
                      1e-5 * at.force)
              << word_of(kind) << ' ' << radius << ' ' << young << ' ' << depth;
          EXPECT_NEAR((law.stored(depth + e).force - law.stored(depth - e).force) / (2 * e), law.slope(depth),
                      1e-5 * law.slope(depth))
              << word_of(kind) << ' ' << radius << ' ' << young << ' ' << depth;
        }
      }
}

// The vectorised arithmetic of a law against the exact one, number by number.
template <class Exact, class Lanes>
void expect_same(const char* word, Exact exact, Lanes lanes) {
  for (const double h : kHeights)
    for (const double d : {-4e-3, -1e-7, 2e-5, 7e-3})
      for (const double stiffening : kStiffenings) {
        const MonotoneCubic table = restoring_law(frictionless(SpringLaw::kTable)).table;
        const law_exact::LawConstants k{1e5, stiffening, &table};
        const law_lanes::LawConstants l{1e5, {stiffening, 1 / stiffening}, &table};
        const law_exact::LawAt a = exact(h, d, k);
        const law_lanes::LawAt b = lanes(h, d, l);
        const double scale = std::abs(a.force) + std::abs(h) + std::abs(d);
        EXPECT_NEAR(a.force, b.force, 1e-13 * scale) << word << ' ' << h << ' ' << d;
        EXPECT_NEAR(a.slope, b.slope, 1e-13 * a.slope) << word << ' ' << h << ' ' << d;
        EXPECT_NEAR(a.gradient, b.gradient, 1e-12 * scale) << word << ' ' << h << ' ' << d;
      }
}

TEST(LawTable, TheVectorisedArithmeticIsTheExactOne) {
#define PLIANT_LAW(word, of, ...)                                                                           \
  expect_same(                                                                                              \
      #word,                                                                                                \
      [](double h, double d, law_exact::LawConstants k) {                                                   \
        const law_exact::LawAt at = law_exact::of##_between(h, d, law_exact::of##_keep(h, k), k);           \
        EXPECT_NEAR(at.force, law_exact::of##_force(h + d, k), 1e-12 * (std::abs(at.force) + std::abs(h))); \
        EXPECT_NEAR(at.slope, law_exact::of##_slope(h + d, k), 1e-12 * at.slope);                           \
        return at;                                                                                          \
      },                                                                                                    \
      [](double h, double d, law_lanes::LawConstants k) {                                                   \
        return law_lanes::of##_between(h, d, law_lanes::of##_keep(h, k), k);                                \
      });
  PLIANT_SPRING_LAWS(PLIANT_LAW)
#undef PLIANT_LAW
}

FieldSource unit_source(Shape shape) {
  FieldSource source;
  source.amplitude = 1.0f;
  source.shape = shape;  // of reach 1
  source.parameter = shape_parameter(shape, 0.2, 1.0, 1.0);
  return source;
}

TEST(LawTable, AShapeIsOneAtTheContactAndZeroAtTheReachAndItsGradientIsItsDerivative) {
  for (const Shape shape : kEveryShape) {
    SCOPED_TRACE(word_of(shape));
    const FieldSource source = unit_source(shape);
    const auto at = [&](float x) { return target_at(source, {x, 0, 0}, source.normal); };
    EXPECT_NEAR(at(0.0f).w, -1.0f, 1e-6f);
    EXPECT_NEAR(at(1.0f).w, 0.0f, 1e-6f);
    EXPECT_NEAR(at(1.0f).x, 0.0f, 1e-5f);
    for (float x = 0.03f; x < 0.99f; x += 0.05f) {
      if (std::abs(x - 0.2f) < 0.02f) continue;  // the rim of a punch
      const float e = 2e-3f;
      const double slope = (double(at(x + e).w) - double(at(x - e).w)) / (2.0 * double(e));
      EXPECT_NEAR(-at(x).x, slope, 0.02 + 0.02 * std::abs(slope)) << x;  // the normal leans against the gradient
    }
  }
}

TEST(LawTable, AShapesContactsShareOneEnergyByAKernelThatIsOneAtTheContact) {
  for (const Shape shape : kEveryShape)
    for (const double volume : {0.0, 1.0}) {
      const ShareKernel kernel = share_kernel(shape, 0.03, volume, 0.2);
      EXPECT_NEAR(kernel.at(0.0), 1.0, 1e-12) << word_of(shape);
      EXPECT_GT(kernel.inner, 0.0);
      EXPECT_GE(kernel.outer, kernel.inner);
    }
}

TEST(LawTable, EveryShapeOfAProbeHasParts) {
  EXPECT_EQ(probe_parts({}).size(), 1u);
  EXPECT_FALSE(has_capsule({.radius = 0.004}));
  EXPECT_TRUE(has_capsule({.radius = 0.004, .length = 0.1}));
  const std::vector<ProbePart> both = probe_parts({.length = 0.1, .points = {{0, 0, 0.02f}, {0, 0, -0.02f}}});
  ASSERT_EQ(both.size(), 3u) << "shapes add up";
  EXPECT_EQ(both[2].to, dvec3(0, 0.1, 0));
}

}  // namespace
}  // namespace pliant
