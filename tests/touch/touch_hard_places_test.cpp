// Touching where it is hard: vertices, edges, borders and creases, fast probes, thin walls, extreme numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/scenes/scenes.h"
#include "tests/touch/touch_laws.h"

namespace pliant {
namespace {

using scenes::Stage;

TEST(Touch, ProbesOnAVertexAnEdgeABorderAndACreaseFeelFiniteSteadyForces) {
  struct Case {
    const char* name;
    Primitive surface;
    dvec3 above;
    dvec3 pressed;
  };
  const Case cases[] = {
      {"vertex", scenes::sheet(10, 0.1), {0.01, 0.005, 0.01}, {0.01, -0.003, 0.01}},
      {"edge", scenes::sheet(10, 0.1), {0.015, 0.005, 0.01}, {0.015, -0.003, 0.01}},
      {"diagonal", scenes::sheet(10, 0.1), {0.015, 0.005, 0.015}, {0.015, -0.003, 0.015}},
      {"border", scenes::sheet(10, 0.1), {0.05, 0.005, 0.0}, {0.05, -0.003, 0.0}},
      {"corner", scenes::sheet(10, 0.1), {0.05, 0.005, 0.05}, {0.05, -0.003, 0.05}},
      {"valley", scenes::valley(10, 0.1, 0.7), {0, 0.005, 0.003}, {0, -0.003, 0.003}},
      {"ridge", scenes::valley(10, 0.1, -0.7), {0, 0.005, 0.003}, {0, -0.003, 0.003}},
  };
  for (const Case& c : cases) {
    Stage stage;
    const Deformable d = frictionless();
    const Entity surface = stage.add(c.surface, d);
    const Entity probe = stage.add_probe(c.above);
    stage.prepare();
    double before = 0;
    stage.move(probe, c.pressed, 0.2, [&](const ProbeReading& r) {
      ASSERT_TRUE(std::isfinite(length(r.force))) << c.name;
      ASSERT_LT(std::abs(r.normal_force - before), 0.05) << c.name;
      before = r.normal_force;
    });
    // Under a ridge both sides are nearer than its line, and share the push: s = 1.5^(-1/4) cos(0.7) of the depth.
    const double nearer = std::string(c.name) == "ridge" ? std::pow(std::pow(1.5, -0.25) * std::cos(0.7), 2) : 1.0;
    EXPECT_NEAR(stage.read(probe).normal_force, nearer * d.stiffness * 0.003, nearer < 1 ? 1e-3 : 0.12) << c.name;
    stage.wait(0.2);
    for (int i = 0; i < 200; ++i) {  // a hand trembles
      stage.place(probe, c.pressed + 1e-5 * dvec3(std::sin(2.0 * i), std::sin(3.1 * i), std::cos(1.7 * i)) -
                             (std::string(c.name) == "border" || std::string(c.name) == "corner"
                                  ? dvec3(2e-5, 0, std::string(c.name) == "corner" ? 2e-5 : 0)
                                  : dvec3(0)));
      stage.tick();
      ASSERT_TRUE(stage.read(probe).in_contact) << c.name << ' ' << i;
      ASSERT_NEAR(stage.read(probe).normal_force, before, 0.1) << c.name << ' ' << i;
    }
    for (const vec4& s : stage.field(surface).stream) ASSERT_TRUE(std::isfinite(s.x + s.y + s.z + s.w)) << c.name;
  }
}

TEST(Touch, NothingIsTunnelledThroughAtTwentyMetresPerSecond) {
  for (const double thickness : {0.0, 0.001}) {
    for (const double radius : {0.0, 0.002}) {
      Stage stage;
      const Primitive shape = thickness > 0 ? scenes::slab(20, 0.2, thickness) : scenes::sheet(20, 0.2);
      stage.add(shape, frictionless());
      const Entity probe = stage.add_probe({0.003, 0.05, 0.002}, radius);
      stage.prepare();
      stage.tick();
      bool touched = false;
      for (int i = 1; i <= 4; ++i) {
        stage.place(probe, {0.003, 0.05 - 0.02 * i, 0.002});
        stage.tick();
        touched |= stage.read(probe).in_contact;
        if (0.05 - 0.02 * i < 0) {
          EXPECT_TRUE(stage.read(probe).in_contact) << thickness << ' ' << radius << ' ' << i;
          EXPECT_NEAR(stage.read(probe).depth, 0.02 * i - 0.05 + radius, 1e-6);
          EXPECT_GT(stage.read(probe).force.y, 0);
        }
      }
      EXPECT_TRUE(touched);
    }
  }
}

TEST(Touch, HardNumbersStayFinite) {
  Stage stage(10.0);  // 0.1 s steps
  Deformable d = frictionless();
  d.stiffness = 1e5;
  d.settling_time = 5.83 * std::sqrt(1e-3 / 1e5);  // 1e-3 kg
  const Entity sheet = stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0, 0.01, 0});
  stage.prepare();
  for (int n = 0; n < 200; ++n) {
    stage.place(probe, {0.05 * std::sin(0.3 * n), 0.01 * std::sin(1.7 * n), 0.05 * std::cos(0.5 * n)});
    stage.tick();
    const ProbeReading r = stage.read(probe);
    ASSERT_TRUE(std::isfinite(length(r.force)));
    for (const vec4& s : stage.field(sheet).stream) ASSERT_LE(std::abs(s.w), 0.02f);
  }
}

}  // namespace
}  // namespace pliant
