// The force at a place is that of a fresh press there, however the hand came: strokes over bumps and organs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "content/level_file.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/collide/surface_query.h"

namespace pliant {
namespace {

struct Bumps {
  double high, length, cell;  // [m]
  bool both = false;          // in x and z
};
Primitive bumpy_sheet(const Bumps& b) {
  constexpr double kX = 0.09, kZ = 0.045;
  const int nx = static_cast<int>(kX / b.cell), nz = static_cast<int>(kZ / b.cell);
  Primitive p;
  for (int j = 0; j <= nz; ++j)
    for (int i = 0; i <= nx; ++i) {
      const double x = (double(i) / nx - 0.5) * kX, z = (0.5 - double(j) / nz) * kZ, k = 2 * M_PI / b.length;
      p.position.push_back(vec3(dvec3(x, b.high * std::sin(k * x) * (b.both ? std::sin(k * z) : 1.0), z)));
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (nx + 1) + i); };
  for (int j = 0; j < nz; ++j)
    for (int i = 0; i < nx; ++i)
      for (const std::uint32_t v : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
        p.index.push_back(v);
  return p;
}

// [N] Elastic force alone: that along the normals.
double pressing(const Stage& stage, Entity probe) {
  double sum = 0.0;
  for (auto [entity, contact] : stage.world.registry.view<const Contact>())
    if (contact.probe == probe) sum += contact.normal_force;
  return sum;
}

constexpr int kSteps = 6400;

class TouchStroke : public testing::TestWithParam<Bumps> {};

TEST_P(TouchStroke, OverBumpsOfAnyScaleTheForceIsThatOfAFreshPress) {
  const Bumps& bumps = GetParam();
  for (const auto& [radius, depth] : {std::pair{0.01, 0.003}, {0.008, 0.002}, {0.005, 0.002}, {0.0, 0.003}}) {
    for (const double friction : {0.0, 0.3}) {
      if (radius > 0 && 3 * radius < bumps.length) continue;
      Deformable d = frictionless();
      d.friction_static = d.friction_sliding = friction;
      Stage stroked, pressed;
      const Primitive sheet = bumpy_sheet(bumps);
      stroked.add(sheet, d);
      pressed.add(sheet, d);
      const double y = bumps.high + radius - depth, from = -0.02;
      const Entity a = stroked.add_probe({from, 0.03, 0.0013}, radius),
                   b = pressed.add_probe({from, 0.03, 0.0013}, radius);
      stroked.prepare();
      pressed.prepare();
      stroked.move(a, {from, y, 0.0013}, 0.2);
      RawMeter meter;
      meter.add(stroked, a, {from, y, 0.0013});
      const double begun = stored(stroked);
      for (int i = 1; i <= kSteps; ++i) {
        const dvec3 x(from + 0.04 * i / kSteps, y, 0.0013);
        stroked.place(a, x);
        stroked.tick();
        meter.add(stroked, a, x);
        if (i % (kSteps / 50)) continue;
        pressed.place(b, {x.x, 0.03, x.z});
        pressed.tick();
        pressed.move(b, x, 0.1);
        pressed.wait(0.002);
        const double is = friction > 0 ? pressing(stroked, a) : length(raw_force(stroked, a)),
                     should = friction > 0 ? pressing(pressed, b) : length(raw_force(pressed, b));
        EXPECT_NEAR(is, should, 0.02 * should + (bumps.both ? 0.05 : 0.003))
            << bumps.high << ' ' << bumps.length << ' ' << radius << ' ' << friction << " at " << x.x;
        pressed.place(b, {x.x, 0.03, x.z});
        pressed.tick();
      }
      if (friction == 0.0)
        EXPECT_LT(meter.work + stored(stroked) - begun, 4e-3 * meter.most) << bumps.length << ' ' << radius;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bumps, TouchStroke,
                         testing::Values(Bumps{0.001, 0.012, 0.001}, Bumps{0.001, 0.012, 0.0005},
                                         Bumps{0.001, 0.012, 0.001, true}, Bumps{0.0003, 0.004, 0.0005},
                                         Bumps{0.002, 0.02, 0.001}, Bumps{0.0005, 0.012, 0.001, true}));

// A dent that a tip beside it has left behind does not weaken its next contact, and nothing is withheld.
TEST(TouchStrokeAtSpeed, OverBumpsTheForceIsThatOfAFreshPress) {
  const Bumps bumps{0.001, 0.012, 0.0005};
  for (const double radius : {0.005, 0.008})
    for (const double speed : {0.05, 0.2, 0.5}) {
      Stage stroked, pressed;
      stroked.add(bumpy_sheet(bumps), frictionless());
      pressed.add(bumpy_sheet(bumps), frictionless());
      const double y = bumps.high + radius - 0.002, from = -0.02;
      const Entity a = stroked.add_probe({from, 0.03, 0.0013}, radius),
                   b = pressed.add_probe({from, 0.03, 0.0013}, radius);
      stroked.prepare();
      pressed.prepare();
      stroked.move(a, {from, y, 0.0013}, 0.2);
      const int steps = static_cast<int>(std::lround(0.04 / (speed * stroked.dt())));
      for (int i = 1; i <= steps; ++i) {
        const dvec3 x(from + 0.04 * i / steps, y, 0.0013);
        stroked.place(a, x);
        stroked.tick();
        if (i % std::max(1, steps / 20)) continue;
        pressed.place(b, {x.x, 0.03, x.z});
        pressed.tick();
        pressed.move(b, x, 0.1);
        const double is = length(raw_force(stroked, a)), should = length(raw_force(pressed, b));
        EXPECT_NEAR(is, should, 0.02 * should + 0.003) << radius << ' ' << speed << " at " << x.x;
        pressed.place(b, {x.x, 0.03, x.z});
        pressed.tick();
      }
      EXPECT_EQ(stroked.world.touch->probes[0].safety.tally.of(SafetyLimit::kWithheld).ticks, 0u) << radius << speed;
    }
}

// Dents part under a shaft as it strokes over them, also where its axis is behind the surface.
TEST(TouchStrokeOfAShaft, OverBumpsTheForceIsThatOfAFreshPress) {
  struct Shaft {
    Bumps bumps;
    double radius, turn;
  };
  for (const Shaft& is : {Shaft{{0.001, 0.012, 0.001, true}, 0.001, M_PI / 2},
                          {{0.0003, 0.004, 0.0005}, 0.001, 0.0},
                          {{0.001, 0.012, 0.001, true}, 0.004, 0.4},
                          {{0.001, 0.012, 0.001}, 0.001, 0.4}}) {
    Stage stroked, pressed;
    constexpr double kLength = 0.03, kFrom = -0.02;
    const dquat turn = glm::angleAxis(is.turn, dvec3(0, 1, 0)) * glm::angleAxis(-M_PI / 2, dvec3(0, 0, 1));
    const double y = is.bumps.high + is.radius - 0.002;
    const auto end = [&](double x, double height) {
      return dvec3(x, height, 0.0013) - turn * dvec3(0, kLength / 2, 0);
    };
    const auto add = [&](Stage& stage) {
      stage.add(bumpy_sheet(is.bumps), frictionless());
      const Entity probe = stage.add_probe(end(kFrom, 0.03), is.radius);
      stage.world.registry.get<Probe>(probe).length = kLength;
      stage.device(stage.world.registry.get<Probe>(probe).device).rotation = turn;
      stage.prepare();
      return probe;
    };
    const Entity a = add(stroked), b = add(pressed);
    stroked.move(a, end(kFrom, y), 0.2);
    constexpr int kTicks = 1000;
    for (int i = 1; i <= kTicks; ++i) {
      const double x = kFrom + 0.04 * i / kTicks;
      stroked.place(a, end(x, y));
      stroked.tick();
      if (i % 83) continue;
      pressed.place(b, end(x, 0.03));
      pressed.tick();
      pressed.move(b, end(x, y), 0.1);
      pressed.wait(0.05);
      const double force = length(raw_force(stroked, a)), should = length(raw_force(pressed, b));
      EXPECT_NEAR(force, should, 0.02 * should + 0.01) << is.bumps.length << ' ' << is.radius << " at " << x;
      pressed.place(b, end(x, 0.03));
      pressed.tick();
      pressed.wait(0.1);
    }
  }
}

}  // namespace
}  // namespace pliant
