// A capsule touches as a segment: alike anywhere along its shaft, with a force by its length, and a torque.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/collide/capsule.h"

namespace pliant {
namespace {

Entity add_capsule(Stage& stage, dvec3 at, double radius, double length) {
  const Entity probe = stage.add_probe(at, radius);
  stage.world.registry.get<Probe>(probe).length = length;
  return probe;
}

void turn(Stage& stage, Entity probe, dquat rotation) {
  stage.device(stage.world.registry.get<Probe>(probe).device).rotation = rotation;
}

dvec3 raw_torque(const Stage& stage, Entity probe) {
  return stage.world.registry.get<Probe>(probe).torque;
}

const dquat kAlongX = glm::angleAxis(-M_PI / 2, dvec3(0, 0, 1));  // +Y to +X

// A ball's own depth, felt at any place of the shaft.
TEST(TouchCapsule, ABallUnderTheShaftIsFeltAlikeAnywhereAlongIt) {
  for (const auto& [ball, radius, long_] :
       {std::tuple{0.01, 0.002, 0.3}, {0.01, 0.004, 0.05}, {0.03, 0.003, 0.3}, {0.03, 0.0, 0.1}}) {
    Stage stage;
    stage.add(scenes::sphere(24, ball), frictionless());
    const Entity probe = add_capsule(stage, {0, 1, 0}, radius, long_);
    turn(stage, probe, kAlongX);
    stage.prepare();
    constexpr double kDepth = 0.0015;
    for (int i = 0; i <= 40; ++i) {
      const double along = long_ * i / 40;
      stage.place(probe, {-along, ball + radius + 0.002, 0});
      stage.tick();
      stage.move(probe, {-along, ball + radius - kDepth, 0}, 0.05);
      stage.wait(0.002);
      EXPECT_NEAR(raw_force(stage, probe).y, 300 * kDepth, 0.01 * 300 * kDepth)
          << ball << ' ' << radius << ' ' << along;
      EXPECT_NEAR(raw_torque(stage, probe).z, along * raw_force(stage, probe).y, 1e-3 * long_) << along;
      stage.move(probe, {-along, ball + radius + 0.002, 0}, 0.02);
      EXPECT_EQ(raw_force(stage, probe), dvec3(0));
    }
  }
}

// As a sphere of any radius: one contact, in the middle. Tilted, it is under the deeper end.
TEST(TouchCapsule, FlatOnAPlaneTheForceIsTheLawsForAnyLength) {
  constexpr double kDepth = 0.002;
  for (const double long_ : {0.002, 0.01, 0.03, 0.1, 0.2, 0.3}) {
    for (const double reach : {0.01, 0.04}) {
      Stage stage;
      Deformable d = frictionless();
      d.reach = reach;
      const Entity sheet = stage.add(scenes::sheet(96, 0.5), d);
      const Entity probe = add_capsule(stage, {-0.5 * long_, 1, 0.003}, 0.004, long_);
      turn(stage, probe, kAlongX);
      stage.prepare();
      stage.place(probe, {-0.5 * long_, 0.01, 0.003});
      stage.tick();
      stage.move(probe, {-0.5 * long_, 0.004 - kDepth, 0.003}, 0.05);
      stage.wait(0.5);
      EXPECT_NEAR(raw_force(stage, probe).y, 300 * kDepth, 1e-9) << long_;
      EXPECT_NEAR(raw_torque(stage, probe).z, 0.5 * long_ * raw_force(stage, probe).y, 1e-6 * long_);
      // The drawn surface is dented under the whole shaft.
      const Mesh& mesh = stage.mesh(sheet);
      for (std::size_t v = 0; v < mesh.px.size(); ++v)
        if (std::abs(mesh.px[v]) < 0.5 * long_ && std::abs(mesh.pz[v] - 0.003) < 1e-3)
          EXPECT_LT(stage.field(sheet).stream[v].w, -0.7 * kDepth) << long_ << " at " << mesh.px[v];
      // Tilted about the middle: under the deeper end, that of the probe's place.
      const dquat tilt = glm::angleAxis(0.02, dvec3(0, 0, 1));
      turn(stage, probe, tilt * kAlongX);
      stage.place(probe, dvec3(0, 0.004 - kDepth, 0.003) - tilt * dvec3(0.5 * long_, 0, 0));
      stage.tick();
      const double deeper = kDepth + 0.5 * long_ * std::sin(0.02);
      EXPECT_NEAR(raw_force(stage, probe).y, 300 * deeper, 300 * 6.1e-6) << long_;
      EXPECT_NEAR(raw_torque(stage, probe).z, 0.0, 1e-9) << long_;
    }
  }
}

// Force and torque are minus the gradient of the stored energy, by moving and by turning.
TEST(TouchCapsule, ForceAndTorqueAreMinusTheEnergysGradient) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  int tried = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Stage stage;
    Deformable d = frictionless();
    d.reach = 0.02;
    const bool sheet = trial % 2;
    Primitive surface = sheet ? scenes::sheet(40, 0.2) : scenes::sphere(16, 0.06);
    for (const vec3& x : surface.position) surface.stiffness.push_back(1.0f + 0.5f * std::sin(80 * x.x + 30 * x.z));
    stage.add(surface, d);
    const Entity probe = add_capsule(stage, {0, 1, 0}, 0.006, 0.05);
    const Entity other = trial % 3 ? kNoEntity : stage.add_probe({0, 1, 0}, 0.004);
    stage.prepare();
    const double top = sheet ? 0.0 : 0.06;
    const dquat tilt =
        glm::angleAxis(0.05 * any(random), dvec3(0, 0, 1)) * glm::angleAxis(3 * any(random), dvec3(0, 1, 0)) * kAlongX;
    dvec3 at = dvec3(0.01 * any(random), top + 0.006 - 0.002, 0.01 * any(random)) - tilt * dvec3(0, 0.025, 0);
    const auto set = [&](dvec3 x, dquat q) {
      stage.place(probe, x);
      turn(stage, probe, q);
      for (int i = 0; i < 3; ++i) stage.tick();
      return stored(stage);
    };
    set(at + dvec3(0, 0.05, 0), tilt);
    stage.move(probe, at, 0.05);
    if (other != kNoEntity) {
      const dvec3 beside(0.02 * any(random), top + 0.004 - 0.0015, 0.02 * any(random));
      stage.place(other, beside + dvec3(0, 0.05, 0));
      stage.tick();
      stage.move(other, beside, 0.05);
    }
    if (!(set(at, tilt) > 1e-6)) continue;
    ++tried;
    const dvec3 force = raw_force(stage, probe), torque = raw_torque(stage, probe);
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 e(0);
      e[axis] = 1;
      constexpr double h = 1e-7, a = 1e-6;
      const double up = set(at + h * e, tilt), down = set(at - h * e, tilt);
      EXPECT_NEAR(force[axis], -(up - down) / (2 * h), 2e-4 * length(force) + 1e-6) << trial << ' ' << axis;
      const double left = set(at, glm::angleAxis(a, e) * tilt), right = set(at, glm::angleAxis(-a, e) * tilt);
      EXPECT_NEAR(torque[axis], -(left - right) / (2 * a), 2e-4 * length(force) * 0.05 + 1e-7) << trial << ' ' << axis;
      set(at, tilt);
    }
  }
  EXPECT_GT(tried, 40);
}

// A shaft that turns over a box's edge, on to its other face: no step of the force or the torque.
TEST(TouchCapsule, AcrossABoxsEdgeTheForceHasNoStep) {
  for (const int cells : {1, 8}) {
    Stage stage;
    stage.add(scenes::slab(cells, 0.1, 0.04), frictionless());
    const Entity probe = add_capsule(stage, {0, 1, 0}, 0.004, 0.08);
    stage.prepare();
    const auto pose = [&](double t) {  // the axis through a place 1 mm below the edge's, turning from face to face
      const dquat q = glm::angleAxis(0.2 - 1.9 * t, dvec3(0, 0, 1)) * kAlongX;
      const double outside = 0.004 - 0.0025;
      const dvec3 normal = q * dvec3(-1, 0, 0);
      return Pose{dvec3(0.05, 0, 0.01) + outside * normal - q * dvec3(0, 0.03 + 0.02 * t, 0), q};
    };
    const auto go = [&](const Pose& p) {
      stage.place(probe, p.position);
      turn(stage, probe, p.rotation);
      stage.tick();
    };
    for (int i = 100; i >= 0; --i) go({pose(0).position + dvec3(0, 0.0002 * i, 0), pose(0).rotation});
    dvec3 last = raw_force(stage, probe), turned = raw_torque(stage, probe);
    double most = 0.0, step = 0.0, turn_step = 0.0;
    constexpr int kTicks = 20000;
    for (int i = 0; i <= kTicks; ++i) {
      go(pose(double(i) / kTicks));
      const dvec3 f = raw_force(stage, probe), m = raw_torque(stage, probe);
      most = std::max(most, length(f));
      step = std::max(step, length(f - last));
      turn_step = std::max(turn_step, length(m - turned));
      last = f;
      turned = m;
    }
    EXPECT_LT(step, 0.02);
    // Where it lies flat it tips over from end to end within the bend.
    EXPECT_LT(turn_step, most * 0.08 * 0.08 / (8 * kBend * 0.004) * 1.9 / kTicks);
    EXPECT_GT(most, 0.5);
    EXPECT_LT(most, 3.0);
  }
}

// Rolling, turning and sliding with a closed loop gives back what it took.
TEST(TouchCapsule, AClosedLoopDoesNoWork) {
  Stage stage;
  Deformable d = frictionless();
  d.reach = 0.02;
  stage.add(scenes::sphere(24, 0.06), d);
  const Entity probe = add_capsule(stage, {0, 1, 0}, 0.005, 0.06);
  stage.prepare();
  const auto pose = [&](double phase) {
    const dquat q = glm::angleAxis(0.4 * std::sin(phase), dvec3(0, 0, 1)) *
                    glm::angleAxis(0.7 * std::cos(phase), dvec3(0, 1, 0)) * kAlongX;
    return Pose{
        dvec3(0.004 * std::sin(phase), 0.06 + 0.005 - 0.002 + 0.001 * std::cos(2 * phase), 0.003 * std::cos(phase)) -
            q * dvec3(0, 0.03 + 0.01 * std::sin(phase), 0),
        q};
  };
  const auto go = [&](const Pose& p) {
    stage.place(probe, p.position);
    turn(stage, probe, p.rotation);
    stage.tick();
  };
  const Pose start = pose(0);
  for (int i = 50; i >= 0; --i) go({start.position + dvec3(0, 0.0002 * i, 0), start.rotation});
  double work = 0.0, most = 0.0;
  dvec3 force = raw_force(stage, probe), torque = raw_torque(stage, probe);
  Pose last = start;
  constexpr int kTicks = 8000;
  for (int i = 1; i <= kTicks; ++i) {
    const Pose now = pose(2 * M_PI * i / kTicks);
    go(now);
    const dquat step = now.rotation * glm::conjugate(last.rotation);
    const dvec3 turned = 2.0 * dvec3(step.x, step.y, step.z);
    work += 0.5 * dot(raw_force(stage, probe) + force, now.position - last.position) +
            0.5 * dot(raw_torque(stage, probe) + torque, turned);
    force = raw_force(stage, probe);
    torque = raw_torque(stage, probe);
    last = now;
    most = std::max(most, stored(stage));
  }
  EXPECT_LT(std::abs(work), 1e-3 * most);
}

// The torque goes to the device with the force, in one account of energy.
TEST(TouchCapsule, TheTorqueIsSentAndAHandGetsNoEnergyByTurning) {
  Stage stage;
  Deformable d = frictionless();
  d.reach = 0.02;
  stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = add_capsule(stage, {0, 1, 0}, 0.005, 0.06);
  stage.prepare();
  double work = 0.0, most = 0.0;
  Pose last;
  dvec3 force(0), torque(0);
  bool begun = false;
  const auto go = [&](const Pose& p) {
    stage.place(probe, p.position);
    turn(stage, probe, p.rotation);
    stage.tick();
    const HapticDevice& device = stage.device(stage.world.registry.get<Probe>(probe).device);
    const dquat step = p.rotation * glm::conjugate(last.rotation);
    if (begun)
      work += 0.5 * dot(device.force_sent + force, p.position - last.position) +
              dot(device.torque_sent + torque, dvec3(step.x, step.y, step.z));
    begun = true;
    last = p;
    force = device.force_sent;
    torque = device.torque_sent;
    most = std::max(most, work);
  };
  const Pose start{{-0.03, 0.02, 0.001}, kAlongX};
  for (int i = 0; i <= 100; ++i) go({start.position - dvec3(0, 0.00017 * i, 0), start.rotation});
  EXPECT_NEAR(torque.z, 0.03 * force.y, 1e-3 * 0.03 * force.y);
  EXPECT_LT(torque.z, 0.2);  // below the limit
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  dvec3 at = last.position;
  for (int leg = 0; leg < 60; ++leg) {
    const dvec3 to(-0.03 + 0.01 * any(random), 0.0035 + 0.003 * any(random), 0.01 * any(random));
    const dquat tilt = glm::angleAxis(0.1 * any(random), normalize(dvec3(any(random), any(random), any(random))));
    const dquat from = last.rotation;
    for (int i = 1; i <= 100; ++i)
      go({at + (to - at) * (i / 100.0), glm::slerp(from, normalize(tilt * kAlongX), i / 100.0)});
    at = to;
  }
  for (int i = 1; i <= 200; ++i) go({at + dvec3(0, 0.0002 * i, 0), last.rotation});
  EXPECT_EQ(force, dvec3(0));
  EXPECT_LT(most, 1e-4 * 0.5 * 300 * 0.0055 * 0.0055 + 1e-9);
  const SafetyState& safety = stage.world.touch->probes[0].safety;
  EXPECT_EQ(safety.tally.of(SafetyLimit::kWithheld).ticks, 0u);
}

// Where the force is no number, the torque goes, too.
TEST(TouchCapsule, NoTorqueIsSentWithoutItsForce) {
  Stage stage;
  stage.add(scenes::sheet(40, 0.2), frictionless());
  const Entity probe = add_capsule(stage, {-0.03, 0.01, 0}, 0.005, 0.06);
  turn(stage, probe, kAlongX);
  stage.prepare();
  stage.move(probe, {-0.03, 0.003, 0}, 0.1);
  const HapticDevice& device = stage.device(stage.world.registry.get<Probe>(probe).device);
  ASSERT_GT(length(device.torque_sent), 0.01);
  stage.world.touch->probes[0].safety.added = dvec3(std::numeric_limits<double>::quiet_NaN());
  stage.tick();
  EXPECT_EQ(device.force_sent, dvec3(0));
  EXPECT_EQ(device.torque_sent, dvec3(0));
}

// At its first pose behind the surface nothing is felt, and that is said.
TEST(TouchCapsule, AProbeThatBeginsInsideIsNamed) {
  for (const double radius : {0.0, 0.01}) {
    Stage stage;
    stage.add(scenes::sphere(16, 0.05), frictionless());
    const Entity probe = stage.add_probe({0, 0.05 + radius - 0.002, 0}, radius);
    stage.prepare();
    stage.tick();
    EXPECT_EQ(raw_force(stage, probe), dvec3(0));
    EXPECT_EQ(stage.world.dropped & kDroppedInside, std::uint32_t{kDroppedInside}) << radius;
    Stage outside;
    outside.add(scenes::sphere(16, 0.05), frictionless());
    const Entity free = outside.add_probe({0, 0.051 + radius, 0}, radius);
    outside.prepare();
    outside.move(free, {0, 0.05 + radius - 0.002, 0}, 0.1);
    EXPECT_EQ(outside.world.dropped & kDroppedInside, 0u) << radius;
  }
}

// Deeper than contacts are searched; at the centre every place of the surface is as near.
TEST(TouchCapsule, AProbeThatBeginsDeepInsideIsNamed) {
  for (const double radius : {0.0, 0.004})
    for (const dvec3 begin : {dvec3(0), dvec3(0.01, 0.005, 0), dvec3(0, 0.2, 0)}) {
      Stage stage;
      stage.add(scenes::sphere(16, 0.05), frictionless());
      stage.add_probe(begin, radius);
      stage.prepare();
      stage.tick();
      EXPECT_EQ((stage.world.dropped & kDroppedInside) != 0, begin.y < 0.1) << radius << ' ' << begin.x;
    }
}

}  // namespace
}  // namespace pliant
