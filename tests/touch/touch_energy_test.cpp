// The elastic force on all probes is minus the gradient of one stored energy: against finite differences and closed
// loops, on surfaces that people bring (methods.md 1.10).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "tests/touch/touch_laws.h"
#include "tests/touch/touch_raw.h"

namespace pliant {
namespace {

TEST(TouchEnergy, ForceIsMinusTheGradientOfTheStoredEnergyForAnyProbesLawAndSurface) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const SpringLaw kind : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential}) {
    for (const int scene : {0, 1, 2, 3, 4}) {
      for (const Shape shape : {Shape::kVolume, Shape::kHertz}) {
        Stage stage;
        Deformable d = frictionless(kind);
        d.shape = shape;
        d.cubic = 3e6;
        const bool ball = scene == 1, box = scene >= 3;
        stage.add(scene == 0   ? painted_sheet(60, 0.2)
                  : ball       ? scenes::sphere(12, 0.1)
                  : scene == 2 ? scenes::valley(30, 0.2, 0.5)
                               : scenes::slab(scene == 3 ? 1 : 24, 0.08, 0.06),
                  d);
        std::vector<Entity> probes;
        std::vector<dvec3> x;
        for (int i = 0; i < 3; ++i) {
          const dvec3 across =
              0.012 * dvec3(u(random), 0, u(random)) + dvec3(0, 0, box ? 0.028 : 0.0);  // near a corner
          const double radius = i == 2 ? 0.006 : 0.0;
          x.push_back(ball ? 0.11 * normalize(dvec3(0, 1, 0) + 10.0 * across)
                           : across + dvec3(box ? 0.03 : 0, 0.02, 0));
          probes.push_back(stage.add_probe(x.back(), radius));
        }
        stage.prepare();
        stage.tick();
        const auto go = [&](std::size_t i, dvec3 to) {
          for (int n = 1; n <= 20; ++n) {
            stage.place(probes[i], x[i] + (to - x[i]) * (n / 20.0));
            stage.tick();
          }
          x[i] = to;
        };
        double largest = 0.0;
        for (int n = 0; n < 5; ++n) {
          for (std::size_t i = 0; i < 3; ++i) {
            const dvec3 a = 0.012 * dvec3(u(random), 0, u(random)) + dvec3(0, 0, box ? 0.028 : 0.0);
            const double depth = 0.0045 + 0.0025 * u(random) - (i == 2 ? 0.006 : 0.0);
            go(i,
               ball ? (0.1 - depth) * normalize(dvec3(0, 1, 0) + 10.0 * a) : a + dvec3(box ? 0.028 : 0.0, -depth, 0));
          }
          for (std::size_t i = 0; i < 3; ++i) {
            if (i == 0) stage.wait(0.6);  // what was recovering has come to rest
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
            largest = std::max(largest, length(f));
            EXPECT_LT(length(f + gradient), 2e-4 * std::max(0.5, length(f)))
                << int(kind) << " scene " << scene << " probe " << i << " n " << n << " f " << f.x << ' ' << f.y << ' '
                << f.z << " -grad " << -gradient.x << ' ' << -gradient.y << ' ' << -gradient.z;
          }
        }
        EXPECT_GT(largest, 0.5);
      }
    }
  }
}

// Press, go along a closed path, lift.
struct Loop {
  double work = 0.0, most = 0.0, largest = 0.0;
};
Loop closed_loop(Stage& stage, Entity probe, const std::vector<dvec3>& path, double speed) {
  RawMeter meter;
  Loop loop;
  dvec3 at = path.front();
  stage.place(probe, at);
  for (int i = 0; i < 3; ++i) stage.tick();
  for (const dvec3& to : path) {
    const int steps = std::max(1, static_cast<int>(std::ceil(length(to - at) / (speed * stage.dt()))));
    const dvec3 from = at;
    for (int i = 1; i <= steps; ++i) {
      at = from + (to - from) * (double(i) / steps);
      stage.place(probe, at);
      stage.tick();
      meter.add(stage, probe, at);
      loop.largest = std::max(loop.largest, length(raw_force(stage, probe)));
    }
  }
  loop.work = meter.work;
  loop.most = meter.most;
  return loop;
}

TEST(TouchEnergy, ClosedLoopsOnBoxesAndCoarseSpheresGiveOutNothingInBothDirections) {
  for (const int cells : {1, 4, 10}) {  // 12, 192, 1,200 triangles
    for (const bool back : {false, true}) {
      Stage stage;
      stage.add(scenes::slab(cells, 0.08, 0.08), frictionless());
      const Entity probe = stage.add_probe({0, 0.02, 0});
      stage.prepare();
      // Over the top, out over an edge, down beside the wall, in through it, out again, and home.
      std::vector<dvec3> path{{0, 0.02, 0},
                              {0.005, -0.003, 0.004},
                              {0.03, -0.006, 0.011},
                              {0.0385, -0.006, 0.02},
                              {0.0385, -0.02, 0.01},
                              {0.034, -0.03, -0.013},
                              {0.037, -0.004, -0.03},
                              {0.035, -0.003, -0.036},
                              {0.01, -0.005, -0.037},
                              {-0.01, -0.005, 0.003},
                              {0, 0.02, 0}};
      if (back) std::reverse(path.begin(), path.end());
      const Loop loop = closed_loop(stage, probe, path, 0.05);
      EXPECT_GT(loop.largest, 1.0);
      EXPECT_LT(loop.work, 1e-3 * loop.most) << cells << back;
      EXPECT_GT(loop.work, -1e-2 * loop.most) << cells << back;
    }
  }
  for (const int n : {2, 4}) {  // 48, 192 triangles
    for (const bool back : {false, true}) {
      Stage stage;
      stage.add(scenes::sphere(n, 0.1), frictionless());
      const Entity probe = stage.add_probe({0, 0.12, 0});
      stage.prepare();
      std::vector<dvec3> path{{0, 0.12, 0}};
      for (int i = 0; i <= 60; ++i) {
        const double a = 2 * M_PI * i / 60;
        path.push_back((0.094 - 0.002 * std::sin(3 * a)) *
                       normalize(dvec3(std::sin(a), std::cos(a), 0.4 * std::sin(2 * a))));
      }
      path.push_back({0, 0.12, 0});
      if (back) std::reverse(path.begin(), path.end());
      const Loop loop = closed_loop(stage, probe, path, 0.05);
      EXPECT_GT(loop.largest, 1.0);
      EXPECT_LT(loop.work, 1e-3 * loop.most) << n << back;
      EXPECT_GT(loop.work, -1e-2 * loop.most) << n << back;
    }
  }
}

TEST(TouchEnergy, AProbeInAnothersDentFeelsASteadyForceAndLiftsAlongTheSameCurve) {
  for (const Shape shape : {Shape::kVolume, Shape::kWendland, Shape::kHertz}) {
    Stage stage;
    Deformable d = frictionless();
    d.shape = shape;
    stage.add(scenes::sheet(60, 0.2), d);
    const Entity a = stage.add_probe({0, 0.001, 0}), b = stage.add_probe({0.006, 0.004, 0});
    stage.prepare();
    stage.move(a, {0, -0.006, 0}, 0.3);
    // Down until it meets the dent, and 0.1 mm more.
    std::vector<std::pair<double, dvec3>> down;
    double y = 0.004;
    int more = -1;
    while (y > -0.006 && more != 0) {
      y -= 2e-5;
      stage.place(b, {0.006, y, 0});
      stage.tick();
      const dvec3 f = raw_force(stage, b);
      down.push_back({y, f});
      if (more > 0) --more;
      if (more < 0 && length(f) > 0) more = 5;
    }
    ASSERT_LT(y, -0.0005) << "the dent is there before the probe";
    const dvec3 at_rest = raw_force(stage, b);
    ASSERT_GT(length(at_rest), 0.01) << int(shape) << y;
    for (int i = 0; i < 500; ++i) {
      stage.tick();
      ASSERT_LT(length(raw_force(stage, b) - at_rest), 1e-9);
    }
    while (down.size() > 1) {
      down.pop_back();
      stage.place(b, {0.006, down.back().first, 0});
      stage.tick();
      ASSERT_LT(length(raw_force(stage, b) - down.back().second), 1e-9);
    }
  }
}

TEST(TouchEnergy, ManyProbesOnOneSurfaceStoreWhatTheirForcesGiveBack) {
  std::mt19937 random(3);
  std::normal_distribution<double> g;
  for (const int count : {1, 2, 4, 8}) {
    for (const int scene : {0, 1, 2}) {
      Stage stage(4000.0);  // the trapezoid's own error, which falls with the step squared, must not hide the surface's
      Deformable d = frictionless();
      stage.add(scene == 0   ? scenes::sphere(8, 0.1)
                : scene == 1 ? painted_sheet(60, 0.2)
                             : scenes::slab(2, 0.1, 0.1),
                d);
      std::vector<Entity> probes;
      std::vector<dvec3> x, v, f;
      for (int i = 0; i < count; ++i) {
        x.push_back(scene == 0 ? dvec3(0.01 * i - 0.02, 0.106, 0.004 * i) : dvec3(0.01 * i - 0.03, 0.004, 0.004 * i));
        v.push_back({0, -0.05, 0});
        f.push_back(dvec3(0));
        probes.push_back(stage.add_probe(x.back(), i % 3 == 2 ? 0.004 : 0.0));
      }
      stage.prepare();
      double work = 0, most = 0, energy = 0;
      for (int n = 0; n < 4000; ++n) {
        for (int i = 0; i < count; ++i) {
          // A hand that wanders, drawn to a few millimetres of depth and to the middle.
          const dvec3 home = scene == 0 ? 0.097 * normalize(x[i]) : dvec3(0.9 * x[i].x, -0.003, 0.9 * x[i].z);
          v[i] += 0.002 * dvec3(g(random), g(random), g(random)) + 0.125 * (home - x[i]) - 0.0125 * v[i];
          const dvec3 dx = v[i] * stage.dt();
          x[i] += dx;
          stage.place(probes[i], x[i]);
        }
        stage.tick();
        for (int i = 0; i < count; ++i) {
          const dvec3 now = raw_force(stage, probes[i]);
          work += 0.5 * dot(now + f[i], v[i] * stage.dt());
          f[i] = now;
        }
        energy = stored(stage);
        most = std::max(most, energy);
      }
      EXPECT_GT(most, 1e-3);
      EXPECT_LT(work + energy, 1e-3 * most) << count << ' ' << scene;  // nothing came from nowhere
      EXPECT_GT(work + energy, -0.05 * most) << count << ' ' << scene;
    }
  }
}

}  // namespace
}  // namespace pliant
