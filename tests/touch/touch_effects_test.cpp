// Effects at a surface: friction that depends on speed, roughness and knocks (methods.md 1.6, 1.11, 1.12).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "scenes/count_allocations.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/model/friction.h"
#include "systems/touch/model/texture.h"

namespace pliant {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

TEST(StribeckFriction, HasTheSlopeOfItsCurve) {
  const SlidingFriction law{0.6, 0.2, 0.03, 1.5};
  EXPECT_DOUBLE_EQ(law.at(0.0), 0.6);
  EXPECT_DOUBLE_EQ(law.at(0.03), 0.2 + 0.4 * std::exp(-1.0) + 0.045);
  EXPECT_DOUBLE_EQ((SlidingFriction{0.6, 0.2, 0.0, 0.0}.at(1e3)), 0.2);
  for (const double v : {0.001, 0.02, 0.05, 0.3})
    EXPECT_NEAR(law.slope(v), (law.at(v + 1e-6) - law.at(v - 1e-6)) / 2e-6, 1e-6);
}

TEST(StribeckFriction, TakesNoLessThanItStoresOverAnyWalk) {
  std::mt19937 random(5);
  std::normal_distribution<double> g;
  std::uniform_real_distribution<double> u(0, 1);
  for (int walk = 0; walk < 200; ++walk) {
    const double K = 1000 * u(random), B = K * kBristleDampingTime, T = 1e-3;
    const SlidingFriction law{0.3 + u(random), 0.3 * u(random), 0.1 * u(random), 20 * u(random)};
    Bristle bristle;
    dvec3 v(0);
    double work = 0.0, scale = 1e-12;
    for (int n = 0; n < 2000; ++n) {
      v = 0.95 * v + 0.03 * dvec3(g(random), 0, g(random));
      const double normal = 3 * u(random), sliding = normal * law.at(length(v));
      const dvec3 f = step_bristle(bristle, v, K, B, std::max(law.static_value * normal, sliding), sliding, T);
      work += dot(f, v) * T;
      scale = std::max(scale, work);
      ASSERT_GE(work - 0.5 * K * dot(bristle.deflection, bristle.deflection), -1e-12 * scale) << walk << ' ' << n;
    }
  }
}

Deformable stribeck() {
  Deformable d;
  d.reach = 0.02;
  d.friction_static = 0.5;
  d.friction_sliding = 0.2;
  d.friction_stribeck = 0.05;
  return d;
}

TEST(StribeckFriction, SlidesSteadilyWithTheForceOfItsCurve) {
  for (const double viscous : {0.0, 2.0})
    for (const double speed : {0.005, 0.02, 0.05, 0.2}) {
      Stage stage;
      Deformable d = stribeck();
      d.friction_viscous = viscous;
      stage.add(scenes::sheet(60, 0.2), d);
      const Entity probe = stage.add_probe({-0.05, 0.001, 0});
      stage.prepare();
      stage.move(probe, {-0.05, -0.003, 0}, 0.1);
      const double mu = 0.2 + 0.3 * std::exp(-speed * speed / 0.0025) + viscous * speed;
      double last = 0.0;
      stage.move(probe, {0.0, -0.003, 0}, 0.05 / speed,
                 [&](const ProbeReading& r) { last = r.tangential_force / r.normal_force; });
      EXPECT_NEAR(last, mu, 1e-6) << speed << ' ' << viscous;
    }
}

// A probe of mass m on a spring and a damper c that are drawn at speed V. About steady sliding
//   m x'' + (c + N mu'(V)) x' + k x = 0:
// it sticks and slips where c < -N mu'(V).
// Returns the last half second's largest deviation from V, of V.
double swing(double share_of_threshold) {
  Stage stage(4000.0);
  const Deformable d = stribeck();
  stage.add(scenes::sheet(60, 0.4), d);
  const double m = 0.05, k = 200.0, V = 0.035, depth = 0.003, N = d.stiffness * depth;
  const double slope = SlidingFriction{0.5, 0.2, 0.05, 0.0}.slope(V), c = -share_of_threshold * N * slope;
  double x = -0.15, v = V, drawn = x + N * SlidingFriction{0.5, 0.2, 0.05, 0.0}.at(V) / k;
  const Entity probe = stage.add_probe({x, 0.001, 0});
  stage.prepare();
  stage.move(probe, {x, -depth, 0}, 0.1);
  v *= 1.01;
  double last = 0.0;
  for (int n = 0; n < 16000; ++n) {
    const double friction = stage.read(probe).force.x;
    drawn += V * stage.dt();
    v += (k * (drawn - x) + c * (V - v) + (n < 40 ? -N * SlidingFriction{0.5, 0.2, 0.05, 0.0}.at(V) : friction)) / m *
         stage.dt();
    x += v * stage.dt();
    stage.place(probe, {x, -depth, 0});
    stage.tick();
    if (n > 14000) last = std::max(last, std::abs(v - V));
  }
  return last / V;
}

TEST(StribeckFriction, ADrawnProbeSticksAndSlipsBelowTheDampingOfTheKnownThreshold) {
  EXPECT_LT(swing(1.05), 0.01);
  EXPECT_GT(swing(0.95), 0.3);
}

Deformable rough(double amplitude = 2e-5, double wavelength = 2e-3) {
  Deformable d = frictionless();
  d.texture_amplitude = amplitude;
  d.texture_wavelength = wavelength;
  return d;
}

TEST(Texture, HasItsRootMeanSquareIsBoundedAndRepeats) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-0.1, 0.1);
  const Texture texture = texture_of(rough()), same = texture_of(rough());
  Deformable other = rough();
  other.texture_seed = 2;
  const Texture another = texture_of(other);
  double sum = 0, squares = 0, lowest = 0;
  constexpr int kPlaces = 40000;
  int differ = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const dvec3 p(u(random), u(random), u(random));
    const Raised at = texture.at(p);
    EXPECT_LE(at.height, 0.0);
    EXPECT_EQ(at.height, same.at(p).height);
    differ += std::abs(at.height - another.at(p).height) > 1e-6;
    sum += at.height;
    squares += at.height * at.height;
    lowest = std::min(lowest, at.height);
    if (i < 100)
      for (int k = 0; k < 3; ++k) {
        dvec3 e(0);
        e[k] = 1e-7;
        EXPECT_NEAR(at.gradient[k], (texture.at(p + e).height - texture.at(p - e).height) / 2e-7, 1e-6);
      }
  }
  const double mean = sum / kPlaces;
  EXPECT_NEAR(std::sqrt(squares / kPlaces - mean * mean), 2e-5, 1e-6);
  EXPECT_NEAR(mean, -8e-5, 2e-6);
  EXPECT_GE(lowest, -16e-5);
  EXPECT_GT(differ, kPlaces / 2);
}

// The centre of a circle that rolls over a sine, by brute force: crest to trough.
double ridden(double amplitude, double wavelength, double radius) {
  double low = 1e9, high = -1e9;
  for (int i = 0; i < 200; ++i) {
    const double x = wavelength * i / 200;
    double y = -1e9;
    for (int j = -2000; j <= 2000; ++j) {
      const double dx = std::min(radius, 3 * wavelength) * j / 2000;
      y = std::max(y, amplitude * std::sin(2 * kHalfTurn * (x + dx) / wavelength) + std::sqrt(radius * radius - dx * dx));
    }
    low = std::min(low, y);
    high = std::max(high, y);
  }
  return high - low;
}

TEST(Texture, ASphereRidesOnItsCrests) {
  EXPECT_EQ(riding_share(1e-5, 1e-3, 0.0), 1.0);
  for (const double amplitude : {1e-6, 1e-5, 1e-4})
    for (const double wavelength : {2e-4, 1e-3, 5e-3})
      for (const double radius : {5e-4, 2e-3, 1e-2}) {
        if (wavelength > 2 * radius) continue;  // nearly vertical flanks
        EXPECT_NEAR(riding_share(amplitude, wavelength, radius),
                    ridden(amplitude, wavelength, radius) / (2 * amplitude),
                    0.2 * riding_share(amplitude, wavelength, radius) + 1e-3)
            << amplitude << ' ' << wavelength << ' ' << radius;
      }
}

TEST(Texture, ItsForceIsMinusTheGradientOfTheStoredEnergy) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const SpringLaw kind : {SpringLaw::kLinear, SpringLaw::kExponential})
    for (const int scene : {0, 1, 2, 3})
      for (const double radius : {0.0, 0.006}) {
        Stage stage;
        Deformable d = frictionless(kind);
        d.texture_amplitude = 4e-5;
        d.texture_wavelength = 3e-3;
        const bool ball = scene == 1;
        stage.add(scene == 0   ? painted_sheet(60, 0.2)
                  : ball       ? scenes::sphere(12, 0.1)
                  : scene == 2 ? scenes::valley(30, 0.2, 0.5)
                               : scenes::slab(12, 0.08, 0.06),
                  d);
        std::vector<Entity> probes;
        std::vector<dvec3> x;
        for (int i = 0; i < 2; ++i) {
          x.push_back(ball ? dvec3(0.004 * i, 0.12, 0) : dvec3(0.02 + 0.004 * i, 0.03, 0.01));
          probes.push_back(stage.add_probe(x.back(), radius));
        }
        stage.prepare();
        stage.tick();
        for (int n = 0; n < 6; ++n) {
          for (std::size_t i = 0; i < 2; ++i) {
            const dvec3 a = 0.012 * dvec3(u(random), 0, u(random));
            const double depth = 0.004 + 0.002 * u(random) - radius;
            const dvec3 to = ball ? (0.1 - depth) * normalize(dvec3(0, 1, 0) + 10.0 * a) : a + dvec3(0, -depth, 0);
            for (int s = 1; s <= 20; ++s) {
              stage.place(probes[i], x[i] + (to - x[i]) * (s / 20.0));
              stage.tick();
            }
            x[i] = to;
          }
          stage.wait(0.6);
          for (std::size_t i = 0; i < 2; ++i) {
            dvec3 gradient(0);
            const double h = 1e-6;
            for (int k = 0; k < 3; ++k) {
              dvec3 e(0);
              e[k] = h;
              stage.place(probes[i], x[i] + e);
              stage.tick();
              const double up = stored(stage);
              stage.place(probes[i], x[i] - e);
              stage.tick();
              gradient[k] = (up - stored(stage)) / (2 * h);
            }
            stage.place(probes[i], x[i]);
            stage.tick();
            const dvec3 f = raw_force(stage, probes[i]);
            EXPECT_LT(length(f + gradient), 2e-4 * std::max(0.5, length(f)))
                << int(kind) << " scene " << scene << " radius " << radius << " probe " << i << " n " << n;
          }
        }
      }
}

TEST(Texture, ALoneContactPushesAlongTheSlopeThatIsExtrapolated) {
  Stage stage;
  stage.add(scenes::sheet(60, 0.2), rough(1e-4, 3e-3));
  const Entity probe = stage.add_probe({0.003, 0.001, 0.002});
  stage.prepare();
  double most = 0.0;
  stage.move(probe, {0.003, -0.003, 0.002}, 0.2);
  const dvec3 x(0.003, -0.003, 0.002);
  stage.wait(0.3);
  const Contact contact = stage.contact(probe);
  const dvec3 f = raw_force(stage, probe), direction = normalize(contact.gradient);
  EXPECT_LT(length(f - dot(f, direction) * direction), 1e-9);
  EXPECT_GT(length(direction - dvec3(0, 1, 0)), 1e-3);
  for (int k = 0; k < 3; ++k) {  // what moves the depth moves the force along the slope
    dvec3 e(0);
    e[k] = 1e-6;
    stage.place(probe, x + e);
    stage.tick();
    const double up = length(raw_force(stage, probe)) / length(stage.contact(probe).gradient);
    stage.place(probe, x - e);
    stage.tick();
    const double slope = (up - length(raw_force(stage, probe)) / length(stage.contact(probe).gradient)) / 2e-6;
    EXPECT_NEAR(slope, -contact.stiffness * contact.gradient[k], 1e-3 * contact.stiffness);
    most = std::max(most, std::abs(slope));
  }
  EXPECT_GT(most, 100.0);
}

TEST(Texture, AWalkGetsNoEnergyOutOfIt) {
  std::mt19937 random(3);
  std::normal_distribution<double> g;
  Stage stage(4000.0);
  stage.add(scenes::sheet(60, 0.2), rough(5e-5, 4e-3));
  dvec3 x(0, 0.004, 0), v(0);
  const Entity probe = stage.add_probe(x);
  stage.prepare();
  RawMeter meter;
  for (int n = 0; n < 20000; ++n) {
    v +=
        0.002 * dvec3(g(random), g(random), g(random)) + 0.125 * (dvec3(0.9 * x.x, -0.003, 0.9 * x.z) - x) - 0.0125 * v;
    x += v * stage.dt();
    stage.place(probe, x);
    stage.tick();
    meter.add(stage, probe, x);
  }
  EXPECT_GT(meter.most, 1e-3);
  EXPECT_LT(meter.work + stored(stage), 1e-3 * meter.most);
}

// Standard deviation of the force along the normal in a stroke at this speed.
double shaking(double speed, double wavelength, std::uint32_t& dropped) {
  Stage stage;
  stage.add(scenes::sheet(60, 0.2), rough(2e-5, wavelength));
  const Entity probe = stage.add_probe({-0.08, 0.001, 0});
  stage.prepare();
  stage.move(probe, {-0.08, -0.002, 0}, 0.2);
  double n = 0, sum = 0, squares = 0;
  stage.move(probe, {0.08, -0.002, 0.01}, 0.16 / speed, [&](const ProbeReading&) {
    const double f = raw_force(stage, probe).y;
    n += 1, sum += f, squares += f * f;
  });
  dropped = stage.world.dropped;
  return std::sqrt(std::max(0.0, squares / n - sum * sum / n / n));
}

TEST(Texture, IsFeltUpToTheRateThatTheClockResolvesAndSmoothAbove) {
  std::uint32_t dropped = 0;
  EXPECT_NEAR(shaking(0.1, 2e-3, dropped), 300 * 2e-5, 0.35 * 300 * 2e-5);  // 50 Hz
  EXPECT_EQ(dropped, 0u);
  EXPECT_LT(shaking(0.9, 2e-3, dropped), 0.02 * 300 * 2e-5);  // 450 Hz
  EXPECT_EQ(dropped, std::uint32_t{kDroppedDetail});
}

TEST(Knock, IsADecayingSinusoidInProportionToTheSpeedOfTheImpact) {
  for (const double speed : {0.02, 0.1}) {
    Deformable d = frictionless();
    d.transient_amplitude = 8.0;
    d.transient_frequency = 150.0;
    d.transient_decay = 60.0;
    Stage stage;
    stage.add(scenes::sheet(60, 0.2), d);
    const Entity probe = stage.add_probe({0, 0.00503, 0});
    stage.prepare();
    double y = 0.00503, t = 0.0;
    for (int n = 0; n < 1000 && y > -0.006; ++n) {
      y -= speed * stage.dt();
      stage.place(probe, {0, y, 0});
      stage.tick();
      if (y >= 0) continue;
      t += stage.dt();
      const double law = -300 * y, knock = 8.0 * speed * std::exp(-60 * t) * std::sin(2 * kHalfTurn * 150 * t);
      ASSERT_NEAR(raw_force(stage, probe).y, std::max(0.0, law + knock), 1e-6) << speed << ' ' << t;
    }
    EXPECT_GT(t, 0.05);
  }
}

TEST(Knock, GivesBackNoMoreThanTheHandHasPutIn) {
  std::mt19937 random(4);
  std::normal_distribution<double> g;
  Deformable d = frictionless(), plain = d;
  d.transient_amplitude = 10.0;
  d.transient_frequency = 180.0;
  d.transient_decay = 40.0;
  Stage with, without;
  with.add(scenes::sheet(60, 0.2), d);
  without.add(scenes::sheet(60, 0.2), plain);
  double y = 0.004, v = 0.0, work = 0.0, force = 0.0, most = 0.0, one_tick = 0.0;
  const Entity a = with.add_probe({0, y, 0}), b = without.add_probe({0, y, 0});
  with.prepare();
  without.prepare();
  for (int n = 0; n < 60000; ++n) {
    v += 0.01 * g(random) - 2.0 * (y - 0.0002) - 0.01 * v;
    y += v * with.dt();
    work += force * v * with.dt();
    most = std::max(most, work);
    one_tick = std::max(one_tick, std::abs(force * v * with.dt()));
    for (const auto& [stage, probe] : {std::pair{&with, a}, {&without, b}}) {
      stage->place(probe, {0, y, 0});
      stage->tick();
    }
    force = raw_force(with, a).y - raw_force(without, b).y;
  }
  EXPECT_LT(work, 0.0);
  EXPECT_LE(most, one_tick);
  EXPECT_GT(-work, 10 * one_tick);
}

TEST(Knock, AboveWhatTheClockResolvesThereIsNone) {
  Deformable d = frictionless();
  d.transient_amplitude = 10.0;
  d.transient_frequency = 401.0;
  Stage stage;
  stage.add(scenes::sheet(60, 0.2), d);
  const Entity probe = stage.add_probe({0, 0.001, 0});
  stage.prepare();
  stage.move(probe, {0, -0.004, 0}, 0.05,
             [&](const ProbeReading& r) { EXPECT_NEAR(r.force.y, std::max(0.0, -300 * r.position.y), 1e-9); });
}

TEST(TouchEffects, AllocateNothingInATickAndAreTheSameInEveryRun) {
  std::uint64_t hash[2] = {0, 0};
  for (std::uint64_t& each : hash) {
    Deformable d = rough();
    d.friction_static = 0.5, d.friction_sliding = 0.2, d.friction_stribeck = 0.02, d.friction_viscous = 0.5;
    d.transient_amplitude = 5.0;
    Stage stage;
    stage.add(scenes::sheet(60, 0.2), d);
    const Entity probe = stage.add_probe({-0.05, 0.01, 0}, 0.003);
    stage.prepare();
    stage.tick();
    const CountAllocations allocations;
    stage.move(probe, {-0.05, 0.001, 0}, 0.2);
    stage.move(probe, {0.05, 0.001, 0.02}, 0.5);
    stage.move(probe, {0.05, 0.01, 0.02}, 0.1);
    EXPECT_EQ(allocations.count(), 0u);
    each = stage.hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

}  // namespace
}  // namespace pliant
