// Rigid bodies with friction against the closed forms of methods.md 3.5 and 3.6, and free bodies against conservation
// laws.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"

namespace pliant {
namespace {

using test::ContactLoop;
constexpr double kRigidStep = 1.0 / 60.0;  // [s]
constexpr double kRigidGravity = 9.81;     // [m/s2]

dquat tilt(double angle) {
  return glm::angleAxis(angle, dvec3(0, 0, 1));
}

// A block on a plane that rises along +x by `angle`; it has `speed` up or down the slope (along +x).
struct Incline {
  Mesh ground = test::block_mesh(vec3(20.0f, 1.0f, 2.0f));
  Mesh block = test::block_mesh(vec3(0.1f));
  ContactLoop loop;
  RigidState* body;
  dvec3 along, up;

  Incline(double angle, double mu_static, double mu_sliding, double speed = 0.0) {
    const dquat r = tilt(angle);
    along = r * dvec3(1, 0, 0);
    up = r * dvec3(0, 1, 0);
    loop.add<FixedBody>(ground, Pose{-0.5 * up, r});
    body = &loop.add<RigidState>(block, Pose{0.05 * up, r}, test::block_mass(dvec3(0.1), 0.5));
    body->set_velocity(speed * along, dvec3(0));
    loop.set_friction(mu_static, mu_sliding);
  }
  double travelled() const { return dot(body->centre(), along); }
  double speed() const { return dot(dvec3(body->velocity()[0], body->velocity()[1], body->velocity()[2]), along); }
  void run(double seconds) {
    for (int i = 0; i < int(std::lround(seconds / kRigidStep)); ++i) loop.step(kRigidStep);
  }
};

TEST(RigidContact, ABlockOnAnInclineHoldsBelowTheFrictionAngleAndSlipsAbove) {
  const double tenth = 0.1 * M_PI / 180.0;
  for (const double mu : {0.2, 0.5, 0.9}) {
    Incline below(std::atan(mu) - tenth, mu, mu), above(std::atan(mu) + tenth, mu, mu);
    below.run(0.1);  // the first impulses are found from nothing and not to the last digit
    const double settled = below.travelled();
    below.run(2.0);
    above.run(2.0);
    EXPECT_LT(std::abs(settled), 1e-5) << mu;
    EXPECT_NEAR(below.travelled(), settled, 1e-6) << mu;
    const double angle = std::atan(mu) + tenth;
    const double expected = 0.5 * kRigidGravity * (std::sin(angle) - mu * std::cos(angle)) * 4.0;
    EXPECT_NEAR(-above.travelled(), expected, 0.02 * expected) << mu;
  }
}

TEST(RigidContact, ASlidingBlockAcceleratesByGravityLessFriction) {
  for (const double angle : {0.4, 0.7}) {
    Incline incline(angle, 0.3, 0.25);
    incline.run(0.5);
    const double v0 = incline.speed();
    incline.run(0.5);
    EXPECT_NEAR(-(incline.speed() - v0) / 0.5, kRigidGravity * (std::sin(angle) - 0.25 * std::cos(angle)), 1e-3)
        << angle;
  }
}

TEST(RigidContact, StaticFrictionHoldsWhereSlidingFrictionWouldNot) {
  const double angle = std::atan(0.4);
  Incline rest(angle, 0.5, 0.3), pushed(angle, 0.5, 0.3, -0.1);
  rest.run(1.0);
  pushed.run(1.0);
  EXPECT_LT(std::abs(rest.travelled()), 1e-6);
  EXPECT_NEAR(-pushed.speed(), 0.1 + kRigidGravity * (std::sin(angle) - 0.3 * std::cos(angle)), 2e-3);
}

TEST(RigidContact, ABlockThatSlidesStopsAfterTheDistanceOfItsEnergy) {
  for (const double angle : {0.0, 0.15}) {
    const double mu = 0.4, v = 1.0, a = kRigidGravity * (mu * std::cos(angle) - std::sin(angle));
    Incline incline(angle, mu, mu, -v);
    incline.run(2.0);
    // Implicit steps brake from the first on: half a step's travel is missing.
    EXPECT_NEAR(-incline.travelled() + 0.5 * v * kRigidStep, v * v / (2 * a), 0.01 * v * v / (2 * a)) << angle;
    const double stopped = incline.travelled();
    incline.run(1.0);
    EXPECT_NEAR(incline.travelled(), stopped, 1e-6);
  }
}

TEST(RigidContact, ARestingBlockDoesNotSink) {
  Incline flat(0.0, 0.4, 0.4);
  flat.run(10.0);
  EXPECT_NEAR(flat.body->centre().y, 0.05, 1e-5);
  EXPECT_LT(length(flat.body->angular_momentum()), 1e-8);
}

TEST(RigidContact, AStackOfFiveStandsForFiveSeconds) {
  const Mesh ground = test::block_mesh(vec3(2.0f, 1.0f, 2.0f)), block = test::block_mesh(vec3(0.1f));
  ContactLoop loop;
  loop.add<FixedBody>(ground, Pose{dvec3(0, -0.5, 0)});
  std::vector<RigidState*> stack;
  for (int i = 0; i < 5; ++i)
    stack.push_back(&loop.add<RigidState>(block, Pose{dvec3(0.004 * (i % 2), 0.05 + 0.1 * i, 0.003 * (i % 3))},
                                          test::block_mass(dvec3(0.1), 0.5)));
  loop.set_friction(0.5, 0.4);
  std::vector<dvec3> start;
  for (const RigidState* s : stack) start.push_back(s->centre());
  for (int i = 0; i < 300; ++i) loop.step(kRigidStep);
  for (std::size_t i = 0; i < stack.size(); ++i) EXPECT_LT(length(stack[i]->centre() - start[i]), 2e-4) << i;
}

TEST(RigidContact, ImpactsConserveMomentumAndGainNoEnergy) {
  const Mesh ball = test::sphere_mesh(0.05f, 3);
  for (const double offset : {0.0, 0.03, 0.06}) {
    ContactLoop loop;
    loop.gravity = dvec3(0);
    RigidState& a = loop.add<RigidState>(ball, Pose{dvec3(-0.2, 0, 0)}, test::sphere_mass(0.05, 0.4));
    RigidState& b = loop.add<RigidState>(ball, Pose{dvec3(0.05, offset, 0.01)}, test::sphere_mass(0.05, 0.7));
    a.set_velocity(dvec3(2, 0, 0), dvec3(0, 3, 5));
    loop.set_friction(0.4, 0.3);
    const auto momentum = [&] {
      const auto p = [](const RigidState& s) {
        const Vector& v = s.velocity();
        return s.mass().mass * dvec3(v[0], v[1], v[2]);
      };
      return p(a) + p(b);
    };
    loop.step(kRigidStep);
    const dvec3 before = momentum();
    double energy = a.kinetic_energy() + b.kinetic_energy();
    const double first = energy;
    for (int i = 0; i < 60; ++i) {
      loop.step(kRigidStep);
      const double now = a.kinetic_energy() + b.kinetic_energy();
      EXPECT_LE(now, energy * (1 + 1e-9)) << offset << ' ' << i;
      energy = now;
    }
    EXPECT_LT(energy, 0.95 * first) << "they should have met";
    EXPECT_LT(length(momentum() - before), 1e-12);
    if (offset == 0.0) {  // e = 0 along the line of centres, nearly the x axis: the common speed of both
      EXPECT_NEAR(a.velocity()[0], 0.4 * 2 / 1.1, 0.08);
      EXPECT_NEAR(b.velocity()[0], 0.4 * 2 / 1.1, 0.08);
    }
  }
}

TEST(RigidContact, AFreeBodyKeepsItsAngularMomentumAndItsEnergy) {
  const Mesh block = test::block_mesh(vec3(0.1f, 0.2f, 0.3f));
  RigidState body(block, Pose{dvec3(0), glm::angleAxis(0.3, normalize(dvec3(1, 2, 3)))},
                  test::block_mass(dvec3(0.1, 0.2, 0.3), 1.0));
  body.set_velocity(dvec3(0), dvec3(0.1, 12.0, 0.2));  // about the middle axis: it tumbles
  const dvec3 momentum = body.angular_momentum();
  const double energy = body.kinetic_energy();
  double lowest = 1e300, highest = 0;
  bool tumbled = false;
  const dvec3 axis = body.rotation() * dvec3(0, 1, 0);
  for (int i = 0; i < 3600; ++i) {
    body.free_step(kRigidStep, dvec3(0));
    body.correct(Vector::Zero(6));
    body.advance(kRigidStep);
    lowest = std::min(lowest, body.kinetic_energy());
    highest = std::max(highest, body.kinetic_energy());
    tumbled |= dot(body.rotation() * dvec3(0, 1, 0), axis) < -0.5;
  }
  EXPECT_EQ(body.angular_momentum(), momentum);
  EXPECT_TRUE(tumbled);
  EXPECT_LT((highest - lowest) / energy, 2e-3);
  EXPECT_NEAR(body.kinetic_energy(), energy, 2e-3 * energy);
}

TEST(RigidContact, AFallIsTheParabola) {
  const Mesh block = test::block_mesh(vec3(0.1f));
  RigidState body(block, Pose{dvec3(0)}, test::block_mass(dvec3(0.1), 1.0));
  body.set_velocity(dvec3(1, 2, 0), dvec3(0));
  for (int i = 0; i < 60; ++i) {
    body.free_step(kRigidStep, dvec3(0, -kRigidGravity, 0));
    body.advance(kRigidStep);
  }
  EXPECT_NEAR(body.centre().x, 1.0, 1e-12);
  EXPECT_NEAR(body.centre().y, 2.0 - 0.5 * kRigidGravity * 1.0 * (1.0 + kRigidStep),
              1e-9);  // implicit Euler's own parabola
}

// Contacts between two rigid bodies: unit impulses on one of them give the entries of W.
TEST(RigidContact, TheDelassusOperatorIsWhatUnitImpulsesDo) {
  const Mesh block = test::block_mesh(vec3(0.1f, 0.05f, 0.08f));
  ContactLoop loop;
  RigidState& low = loop.add<RigidState>(block, Pose{dvec3(0)}, test::block_mass(dvec3(0.1, 0.05, 0.08), 0.3));
  RigidState& high =
      loop.add<RigidState>(block, Pose{dvec3(0.02, 0.0503, 0.01)}, test::block_mass(dvec3(0.1, 0.05, 0.08), 0.7));
  low.set_velocity(dvec3(0.1, 0.2, 0), dvec3(0.1, 0, 0.3));
  high.set_velocity(dvec3(0, -0.1, 0.1), dvec3(0, 0.2, 0.1));
  loop.step(1e-9);  // for the contacts
  ASSERT_GE(loop.contacts.size(), 4u);
  const auto relative_velocity = [&] {
    Vector u = Vector::Zero(3 * Eigen::Index(loop.contacts.size()));
    for (std::size_t i = 0; i < loop.contacts.size(); ++i) {
      const ContactPoint& c = loop.contacts[i];
      const auto at = [&](std::uint32_t b, const SurfacePoint& p) {
        const RigidState& body = b == 0 ? low : high;
        const Vector& v = body.velocity();
        return dvec3(v[0], v[1], v[2]) + cross(dvec3(v[3], v[4], v[5]), p.position - body.centre());
      };
      const dvec3 r = at(c.body_a, c.a) - at(c.body_b, c.b);
      for (int k = 0; k < 3; ++k) u[3 * Eigen::Index(i) + k] = dot(c.axes[k], r);
    }
    return u;
  };
  for (auto& body : loop.bodies) body->free_step(kRigidStep, dvec3(0));
  build_problem(loop.bodies, loop.contacts, kRigidStep, 0.15, loop.delassus, loop.problem);
  const Eigen::Index rows = 3 * Eigen::Index(loop.contacts.size());
  const Eigen::MatrixXd w = Eigen::MatrixXd(loop.problem.W).topLeftCorner(rows, rows);
  EXPECT_TRUE(w.isApprox(w.transpose(), 0.0));

  const Vector before = relative_velocity();
  for (std::size_t i = 0; i < loop.contacts.size(); ++i) {
    const double gap = loop.contacts[i].gap;
    EXPECT_NEAR(loop.problem.bias[3 * Eigen::Index(i)],
                before[3 * Eigen::Index(i)] + (gap < 0 ? 0.15 : 1.0) * gap / kRigidStep, 1e-9);
  }
  for (Eigen::Index k = 0; k < rows; ++k) {
    loop.problem.impulse.setZero();
    loop.problem.impulse[k] = 1.0;
    const Vector last = relative_velocity();
    apply_impulses(loop.bodies, loop.delassus, loop.contacts, loop.problem.impulse);
    EXPECT_LT((relative_velocity() - last - w.col(k)).norm(), 1e-9 * w.col(k).norm()) << k;
  }
}

// Two pads close on a cube and lift it: the pads' compliance is 1e-4 m/N, so they press with a known force.
double dropped_in_grip(double mu) {
  const Mesh finger = test::block_mesh(vec3(0.02f, 0.06f, 0.06f)), cube = test::block_mesh(vec3(0.05f), 2);
  ContactLoop loop;
  const double squeeze = 5e-4;  // [m]
  std::vector<FixedBody*> pads;
  for (const double side : {-1.0, 1.0})
    pads.push_back(&loop.add<FixedBody>(finger, Pose{dvec3(side * (0.035 - squeeze), 0, 0)}));
  for (FixedBody* pad : pads) pad->compliance = 4e-4;  // [m/N] of each of its contacts
  RigidState& body = loop.add<RigidState>(cube, Pose{dvec3(0)}, test::block_mass(dvec3(0.05), 0.2));
  loop.set_friction(mu, mu);
  for (FixedBody* pad : pads) pad->set_velocity(dvec3(0, 0.05, 0), dvec3(0));
  for (int i = 0; i < 60; ++i) loop.step(kRigidStep);
  return pads[0]->pose().position.y - body.centre().y;
}

TEST(RigidContact, AGripLiftsWhatItsConeHolds) {
  // 4 to 9 contacts a side press with squeeze/compliance = 1.25 N each; the weight is 1.96 N.
  EXPECT_LT(std::abs(dropped_in_grip(0.5)), 1e-3);
  EXPECT_GT(dropped_in_grip(0.03), 0.02);
}

}  // namespace
}  // namespace pliant
