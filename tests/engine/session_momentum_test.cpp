// A free body has the momentum that the hand gave it: Newton's third law over the exchange of touch tick and soft step.
#include <gtest/gtest.h>

#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

// [m] In x.
double middle(Session& session, const char* body) {
  std::vector<vec3> now;
  EXPECT_TRUE(session.vertices(body, now));
  double sum = 0.0;
  for (const vec3& x : now) sum += double{x.x} / double(now.size());
  return sum;
}

struct Pushed {
  double momentum, impulse, energy, work;  // [kg m/s], [N s], [J] of the body, [J] of the hand
};

// A probe pushes a floating block 5 cm in a second, and stops.
Pushed push(double mass, double soft_step) {
  Scene scene("space");
  scene.simulation().gravity = dvec3(0);
  scene.simulation().soft_step = soft_step;
  RigidBodyParameters body{.mass = mass};
  body.friction_static = body.friction_sliding = 0.0;
  scene.add_rigid_body("block", box(0.02f), body);
  scene.add_probe("finger", {.radius = 0.005}, {.max_force = 100.0, .max_slew = 1e6});
  Session session = opened(scene);
  Pushed out{};
  double last = -0.03;
  for (int i = 0; i <= 2000; ++i) {
    const double s = std::min(1.0, i / 1000.0), x = -0.03 + 0.05 * s * s * s * (10 - 15 * s + 6 * s * s);
    EXPECT_TRUE(session.move("finger", {x, 0, 0}));
    EXPECT_TRUE(session.step());
    const double force = -session.reading("finger")->force.x;
    out.impulse += 1e-3 * force;
    out.work += (x - last) * force;
    last = x;
  }
  const double before = middle(session, "block");
  EXPECT_TRUE(session.step(500));
  const double speed = (middle(session, "block") - before) / 0.5;
  out.momentum = mass * speed;
  out.energy = 0.5 * mass * speed * speed;
  return out;
}

TEST(SessionMomentum, AFreeBodyHasWhatTheHandGaveIt) {
  for (const double step : {1.0 / 60, 1.0 / 240, 1.0 / 1000})
    for (const double mass : {0.05, 0.5, 2.0}) {
      const Pushed it = push(mass, step);
      EXPECT_NEAR(it.impulse, it.momentum, 0.05 * it.momentum) << mass << " kg, soft_step " << step;
      EXPECT_GT(it.work, it.energy) << mass << " kg, soft_step " << step;
    }
}

}  // namespace
}  // namespace pliant
