// Friction of a touch, and the energy returned to a hand by press, slide and release.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

using scenes::Stage;
using scenes::WorkMeter;

TEST(Touch, SlidingFrictionStaysOnTheConeAndOpposesTheMotion) {
  Stage stage;
  Deformable d;
  d.reach = 0.03;
  d.friction_static = 0.5;
  d.friction_sliding = 0.35;
  stage.add(scenes::sheet(60, 0.2), d);
  const Entity probe = stage.add_probe({-0.05, 0.001, 0});
  stage.prepare();
  stage.move(probe, {-0.05, -0.004, 0}, 0.1);
  double peak = 0;
  int n = 0;
  stage.move(probe, {0.03, -0.004, 0.02}, 1.0, [&](const ProbeReading& r) {
    peak = std::max(peak, r.tangential_force / r.normal_force);
    ASSERT_LE(r.tangential_force, 0.5 * r.normal_force * (1 + 1e-9));
    if (++n < 200) return;
    ASSERT_NEAR(r.tangential_force, 0.35 * r.normal_force, 1e-6);
    ASSERT_NEAR(dot(normalize(r.force - dot(r.force, r.normal) * r.normal), normalize(dvec3(0.08, 0, 0.02))), -1, 1e-6);
  });
  EXPECT_GT(peak, 0.45);  // the static limit was reached before it slipped
}

// A block on an incline, supported by the probe's friction: a mass whose weight presses the probe into a soft plane.
double slid(double mu, double degrees) {
  Stage stage;
  Deformable d;
  d.reach = 0.03;
  d.stiffness = 2000;
  d.friction_static = d.friction_sliding = mu;
  const double angle = degrees * M_PI / 180;
  Pose pose;
  pose.rotation = glm::angleAxis(angle, dvec3(0, 0, 1));  // downhill is -x in the plane's own frame
  stage.add(scenes::sheet(60, 0.6), d, pose);
  const dvec3 normal = pose.rotation * dvec3(0, 1, 0);
  const double mass = 0.1;
  dvec3 x = pose.to_world({0.2, -mass * 9.81 * std::cos(angle) / d.stiffness, 0}), v(0);
  const Entity probe = stage.add_probe(x + 0.01 * normal);
  stage.prepare();
  stage.tick();
  stage.move(probe, x, 0.5);
  const dvec3 start = x;
  for (int n = 0; n < 3000; ++n) {
    // Strong damping along the normal, so that only the slide remains. The weight's component along the slope is ramped
    // up, so that the bristle is loaded without impact.
    const dvec3 weight = mass * dvec3(0, -9.81, 0), across = dot(weight, normal) * normal;
    dvec3 force = stage.read(probe).force + across + std::min(1.0, n / 1500.0) * (weight - across);
    force -= 5.0 * dot(v, normal) * normal;
    v += force / mass * stage.dt();
    x += v * stage.dt();
    stage.place(probe, x);
    stage.tick();
  }
  return length(x - start);
}

TEST(Touch, MassOnAnInclineSlipsIfAndOnlyIfTheTangentExceedsTheFrictionCoefficient) {
  const double mu = 0.4, limit = std::atan(mu) * 180 / M_PI;
  EXPECT_LT(slid(mu, limit - 0.1), 2e-3);  // it creeps into the bristle and stays
  EXPECT_GT(slid(mu, limit + 0.1), 4e-3);
}

}  // namespace
}  // namespace pliant
