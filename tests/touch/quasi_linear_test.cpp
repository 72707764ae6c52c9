// Laws that stiffen and relax: quasi-linear viscoelasticity (Fung), F(t) = int G(t - s) dFe/ds ds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/touch/model/contact_law.h"

namespace pliant {
namespace {

using scenes::Stage;

constexpr SpringLaw kRelaxing[] = {SpringLaw::kStandardLinearSolid, SpringLaw::kQuasiLinearCubic,
                                   SpringLaw::kQuasiLinearExponential, SpringLaw::kQuasiLinearTable};

Deformable relaxing(SpringLaw law, double share, double time) {
  Deformable d = frictionless(law);
  d.relaxation_stiffness = share * d.stiffness;
  d.relaxation_time = time;
  return d;
}

// Fung's integral by brute force: a sum over the whole history for every tick, each with an elastic force that is
// linear in time between ticks. G(t) = 1 + (k1 / k) e^(-t/tau).
std::vector<double> fung(const Deformable& d, const std::vector<double>& depth, double dt) {
  const double share = d.relaxation_stiffness / d.stiffness, tau = d.relaxation_time;
  std::vector<double> out;
  for (std::size_t n = 0; n < depth.size(); ++n) {
    double force = law(d, depth[n]);
    for (std::size_t i = 1; i <= n; ++i) {
      const double rise = law(d, depth[i]) - law(d, depth[i - 1]);
      force += share * rise * (tau / dt) * -std::expm1(-dt / tau) * std::exp(-static_cast<double>(n - i) * dt / tau);
    }
    out.push_back(std::max(0.0, force));
  }
  return out;
}

TEST(QuasiLinear, AProbeFeelsFungsIntegral) {
  for (const SpringLaw kind : kRelaxing) {
    const Deformable d = relaxing(kind, 1.5, 0.15);
    Stage stage;
    stage.add(scenes::sheet(40, 0.2), d);
    const Entity probe = stage.add_probe({0, 0, 0});  // on a vertex
    stage.prepare();
    stage.tick();
    std::vector<double> depth{0.0}, felt{0.0};
    for (int i = 1; i <= 600; ++i) {  // in, a rest, deeper, part of the way out
      const double t = 1e-3 * i;
      depth.push_back(0.006 * std::min(1.0, t / 0.05) + 0.002 * std::clamp((t - 0.2) / 0.1, 0.0, 1.0) -
                      0.003 * std::clamp((t - 0.4) / 0.15, 0.0, 1.0));
      stage.place(probe, {0, -depth.back(), 0});
      stage.tick();
      felt.push_back(stage.read(probe).normal_force);
    }
    const std::vector<double> want = fung(d, depth, stage.dt());
    for (std::size_t i = 1; i < want.size(); ++i)
      ASSERT_NEAR(felt[i], want[i], 2e-5 * want[i] + 5e-6) << int(kind) << ' ' << i;
    EXPECT_LT(want.back(), 0.99 * law(d, depth.back()) * 2.5);
  }
}

// The ratio of a step's first force to its last is 1 + k1 / k at every depth, and not that of a linear arm beside a
// stiffening spring.
TEST(QuasiLinear, RelaxationIsTheSameShareAtEveryDepth) {
  for (const SpringLaw kind : kRelaxing)
    for (const double depth : {5e-4, 2e-3, 7e-3}) {
      const Deformable d = relaxing(kind, 0.8, 0.02);
      Stage stage;
      stage.add(scenes::sheet(40, 0.2), d);
      const Entity probe = stage.add_probe({0, 0, 0});
      stage.prepare();
      stage.tick();
      stage.place(probe, {0, -depth, 0});
      stage.tick();
      const double mean = 0.02 / stage.dt() * -std::expm1(-stage.dt() / 0.02);  // over the tick of the step
      EXPECT_NEAR(stage.read(probe).normal_force, (1 + 0.8 * mean) * law(d, depth), 1e-3 * law(d, depth)) << int(kind);
      stage.wait(0.4);
      EXPECT_NEAR(stage.read(probe).normal_force, law(d, depth), 1e-3 * law(d, depth)) << int(kind);
    }
}

// The stored energy of one contact: what the spring holds, and r1 (P(d) - P(e) - S(q) (d - e)) >= 0 of the arm.
double energy_of(const ContactLaw& law, double depth) {
  double low = 0.0, high = 0.1;  // e: the law's depth of its relaxed part
  for (int i = 0; i < 200; ++i) (-law.law->force(-0.5 * (low + high)) < law.relaxed ? low : high) = 0.5 * (low + high);
  const double arm = law.potential(depth) - law.potential(low) - law.force(low) * (depth - low);
  EXPECT_GE(arm, -1e-12 * law.potential(depth));
  return law.potential(depth) + law.arm * arm;
}

// The work of a hand on any walk is at least what is stored at its end: no closed loop gives anything out. Within a
// step the elastic force is linear in time, for which the recursion is exact; the work over it is integrated finely.
TEST(QuasiLinear, NoWalkTakesMoreOutThanItPutIn) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const SpringLaw kind : kRelaxing)
    for (const double radius : {0.0, 0.004})
      for (int walk = 0; walk < 4; ++walk) {
        Deformable d = relaxing(kind, std::pow(10.0, 2 * share(random) - 1), std::pow(10.0, -3 + 3 * share(random)));
        if (radius > 0 && d.table.count == 0) d.young = 1e4;
        const Motion moves = motion(d, 1e-3);
        ContactLaw contact = contact_law(d, moves, 1.0, radius);
        const auto z_of = [&](double depth) { return -contact.law->force(-depth); };
        constexpr double kDt = 5e-5;
        const double left = std::exp(-kDt / d.relaxation_time);
        double depth = 0.0, goal = 0.0, speed = 0.0, force = 0.0, work = 0.0, most = 0.0;
        for (int i = 0; i < 20000; ++i) {
          if (i % 500 == 0) {
            goal = share(random) < 0.25 ? 0.0 : 0.008 * share(random);
            speed = std::pow(10.0, -3 + 2.5 * share(random));
          }
          const double next = depth + std::clamp(goal - depth, -speed * kDt, speed * kDt);
          const double mean = 0.5 * (z_of(next) + z_of(depth));
          contact.relaxed = mean + left * (contact.relaxed - mean);
          const double now = contact.stored(next).force;
          work += 0.5 * (now + force) * (next - depth);
          depth = next, force = now;
          most = std::max(most, work);
          if (i % 100 == 0)
            ASSERT_GE(work, energy_of(contact, depth) * (1 - 1e-3) - 1e-3 * most) << int(kind) << ' ' << i;
        }
        ASSERT_GT(most, 0.0);
      }
}

// A released surface: kinetic energy and both springs only fall, whatever the step is.
TEST(QuasiLinear, AFreeSurfaceOnlyLosesEnergy) {
  for (const SpringLaw kind :
       {SpringLaw::kQuasiLinearCubic, SpringLaw::kQuasiLinearExponential, SpringLaw::kQuasiLinearTable})
    for (const double r1 : {0.3, 3.0})
      for (const double mass : {1e-7, 1e-5, 1e-3})
        for (const double tau : {1e-4, 1e-2, 1.0})
          for (const double damping : {0.0, 1e-3}) {
            const RestoringLaw law = restoring_law(frictionless(kind));
            SolidState s{-6e-3, 0.1, 0.0};
            s.arm = 0.4 * r1 * law.force(s.height);
            const auto energy = [&] {
              // The arm's internal height e: force(e) = force(h) - q / r1.
              const double z = law.force(s.height) - s.arm / r1;
              double low = -0.1, high = 0.1;
              for (int i = 0; i < 200; ++i) (law.force(0.5 * (low + high)) < z ? low : high) = 0.5 * (low + high);
              return 0.5 * mass * s.velocity * s.velocity + law.potential(s.height) +
                     r1 * (law.potential(s.height) - law.potential(low) - law.force(low) * (s.height - low));
            };
            const double first = energy();
            for (int i = 0; i < 400; ++i) {
              const double before = energy();
              s = step_relaxing(law, s, mass, damping, r1, std::exp(-0.5e-3 / tau), 0.0, 1e-3);
              ASSERT_LE(energy(), before * (1 + 1e-9) + 1e-9 * first)
                  << int(kind) << ' ' << mass << ' ' << tau << ' ' << i;
            }
          }
}

// With the linear law the two half relaxations and the step between are the standard linear solid's, to second order.
TEST(QuasiLinear, TheStepConvergesToTheExactSolidWithTheSquareOfTheTick) {
  const RestoringLaw linear{SpringLaw::kLinear};
  const double m = 1e-4, b = 5e-3, r1 = 1.3, tau = 0.03, whole = 0.02;
  const auto exact = solid_step(m, b, 1.0, r1, tau, whole);
  double last = 0.0;
  for (const int steps : {20, 40, 80}) {
    SolidState s{-5e-3, 0.02, -2e-3};
    const double T = whole / steps;
    for (int i = 0; i < steps; ++i) s = step_relaxing(linear, s, m, b, r1, std::exp(-0.5 * T / tau), 0.0, T);
    const double want = exact[0][0] * -5e-3 + exact[0][1] * 0.02 + exact[0][2] * -2e-3, off = std::abs(s.height - want);
    if (last > 0.0) EXPECT_NEAR(last / off, 4.0, 0.3) << steps;
    last = off;
  }
  EXPECT_LT(last, 1e-6);
}

TEST(QuasiLinear, TheTissueRemembersWhereItWasPressedAndForgets) {
  for (const SpringLaw kind :
       {SpringLaw::kQuasiLinearCubic, SpringLaw::kQuasiLinearExponential, SpringLaw::kQuasiLinearTable}) {
    const Deformable d = relaxing(kind, 3.0, 0.1);
    Stage stage;
    const Entity sheet = stage.add(scenes::sheet(100, 0.2), d);
    const Entity probe = stage.add_probe({-0.03, 0.001, 0});
    stage.prepare();
    stage.move(probe, {-0.03, -0.003, 0}, 0.01);
    const double first = stage.read(probe).normal_force;
    stage.wait(1.0);
    EXPECT_NEAR(stage.read(probe).normal_force, law(d, 0.003), 0.01 * law(d, 0.003));
    stage.move(probe, {-0.03, 0.01, 0}, 0.01);
    stage.move(probe, {0.03, 0.001, 0}, 0.01);
    stage.move(probe, {0.03, -0.003, 0}, 0.01);
    EXPECT_NEAR(stage.read(probe).normal_force, first, 0.05 * first) << "fresh tissue";
    stage.move(probe, {0.03, 0.05, 0}, 0.01);
    stage.wait(4.0);
    for (const vec4& z : stage.field(sheet).relaxed) ASSERT_EQ(z, vec4(0));
    stage.move(probe, {-0.03, 0.001, 0}, 0.05);
    stage.move(probe, {-0.03, -0.003, 0}, 0.01);
    EXPECT_NEAR(stage.read(probe).normal_force, first, 0.01 * first) << "recovered tissue";
  }
}

}  // namespace
}  // namespace pliant
