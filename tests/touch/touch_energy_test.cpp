// The elastic force on all probes is minus the gradient of one stored energy: against finite differences and closed
// loops, on surfaces that people bring (methods.md 1.10).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

TEST(TouchEnergy, ForceIsMinusTheGradientOfTheStoredEnergyForAnyProbesLawAndSurface) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const auto& [kind, alpha] : {std::pair{SpringLaw::kLinear, 100.0},
                                    {SpringLaw::kCubic, 100.0},
                                    {SpringLaw::kExponential, 100.0},
                                    {SpringLaw::kExponential, -60.0}}) {
    for (const int scene : {0, 1, 2, 3, 4}) {
      for (const Shape shape : {Shape::kVolume, Shape::kHertz}) {
        Stage stage;
        Deformable d = frictionless(kind);
        d.shape = shape;
        d.stiffening = alpha;
        d.contact_radius = alpha < 0 ? 0.012 : 0.0;  // of the shape hertz: its kernel is computed for this ratio
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
            if (i == 0) stage.wait(0.6);  // recovery has ended
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
          // A random walk of the hand, attracted to a few millimetres of depth and to the middle.
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
      EXPECT_LT(work + energy, 1e-3 * most) << count << ' ' << scene;  // no energy is created
      EXPECT_GT(work + energy, -0.05 * most) << count << ' ' << scene;
    }
  }
}

}  // namespace
}  // namespace pliant
