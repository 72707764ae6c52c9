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

// A frustum with `sides` flat sides on the plane y = 0.
Primitive frustum(int sides, double bottom, double top, double high) {
  Primitive p;
  const auto n = static_cast<std::uint32_t>(sides);
  for (const auto& [radius, y] : {std::pair{bottom, 0.0}, {top, high}})
    for (std::uint32_t i = 0; i < n; ++i) {
      const double a = 2 * M_PI * i / n;
      p.position.push_back(vec3(dvec3(radius * std::cos(a), y, radius * std::sin(a))));
    }
  p.position.push_back({0, 0, 0});
  p.position.push_back(vec3(dvec3(0, high, 0)));
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    for (const std::uint32_t v : {i, n + i, j, j, n + i, n + j, 2 * n, i, j, 2 * n + 1, n + j, n + i})
      p.index.push_back(v);
  }
  return p;
}

// Beside the axis two places of one side are as near, beyond its focal distance. Where a foot is on an edge between two
// patches there, the force is minus the gradient of the energy, too.
TEST(TouchFocus, ASphereDeepInAConeFeelsTheEnergysGradient) {
  constexpr double kHigh = 0.03, kRadius = 0.004, kStep = 1e-8;
  Stage stage;
  stage.add(frustum(32, 0.03, 0.0015, kHigh), frictionless());
  const Entity probe = stage.add_probe({0, 1, 0}, kRadius);
  stage.prepare();
  const auto at = [&](dvec3 x) {
    stage.place(probe, x);
    stage.tick();
    return stored(stage);
  };
  for (dvec3 x(0.0002, kHigh + 0.005, 0.0003); x.y > kHigh - 0.0039; x.y -= 2e-5) {
    at(x);
    if (x.y > kHigh - 0.0036) continue;
    const dvec3 force = raw_force(stage, probe);
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 e(0);
      e[axis] = kStep;
      const double up = at(x + e), down = at(x - e);
      EXPECT_NEAR(force[axis], (down - up) / (2 * kStep), 1e-4) << x.y - kHigh << ' ' << axis;
    }
  }
}

// Its centre comes out through the top beside an overhanging rim, where its foot is on the side wall, and gets deeper
// below that: it stays in contact.
TEST(TouchRim, ASphereThatComesOutBesideARimFeelsWhatItFeltOnTheWayIn) {
  constexpr double kHigh = 0.01, kBottom = 0.001, kTop = 0.0015, kRadius = 0.004;
  for (const double inside : {2e-6, 7e-6, 15e-6})
    for (int turn = 0; turn < 8; ++turn) {
      Stage stage;
      stage.add(frustum(32, kBottom, kTop, kHigh), frictionless());
      const double a = 0.3 + 0.8 * turn, far = kTop * std::cos(M_PI / 32) - inside;
      const Entity probe = stage.add_probe({far * std::cos(a), kHigh + 0.005, far * std::sin(a)}, kRadius);
      stage.prepare();
      std::array<double, 260> on_the_way_in{};
      for (int i = -259; i < 260; ++i) {
        const int level = std::abs(i);
        stage.place(probe, {far * std::cos(a), kHigh + 2e-5 * (level - 20), far * std::sin(a)});
        stage.tick();
        const double force = length(raw_force(stage, probe));
        double& in = on_the_way_in[static_cast<std::size_t>(level)];
        if (i < 0) in = force;
        if (i > 0)
          EXPECT_NEAR(force, in, 300 * (inside + kTop * (1 - std::cos(M_PI / 32))) + 1e-6)
              << inside << ' ' << a << ' ' << level;
      }
    }
}

// Where a foot goes over to a minimum beside it, which no search has found yet, the hand gets hardly any energy.
TEST(TouchStrokeOverKinks, AStrokeThereAndBackGivesLittle) {
  for (const double z : {0.0004, 0.0017, 0.0031, 0.0052}) {
    Stage stage;
    stage.add(bumpy_sheet({0.001, 0.0157, 0.004, true}), frictionless());
    const double y = 0.001 + 0.004 - 0.0025;
    const Entity probe = stage.add_probe({-0.03, 0.02, z}, 0.004);
    stage.prepare();
    RawMeter meter;
    const auto go = [&](dvec3 x) {
      stage.place(probe, x);
      stage.tick();
      meter.add(stage, probe, x);
    };
    for (int i = 0; i <= 500; ++i) go({-0.03, y + 2e-5 * (500 - i), z});
    for (int i = 0; i <= 3000; ++i) go({-0.03 + 2e-5 * i, y, z + 3e-6 * i});
    for (int i = 3000; i >= 0; --i) go({-0.03 + 2e-5 * i, y, z + 3e-6 * i});
    for (int i = 500; i >= 0; --i) go({-0.03, y + 2e-5 * (500 - i), z});
    EXPECT_LT(meter.work, 3e-3 * meter.most) << z;
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
