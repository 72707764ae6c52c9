// A device with a rate has a servo between it and the touch tick: the model equals the tick's own law, and the
// session's owner can observe and control the guard.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "devices/servo/local_force.h"
#include "engine/session/session_run.h"
#include "systems/device/device_model.h"
#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::HasSubstr;

struct Served {
  DeviceCapabilities can{.max_force = 5.0, .rate = 1000.0};
  dvec3 position{0, 0.01, 0};  // [m]
  dquat rotation{1, 0, 0, 0};
  dvec3 force{0}, torque{0};
  int reads = 0, closed = 0;
  bool ready = true;
};
class ServedDevice final : public Driver {
 public:
  explicit ServedDevice(Served& served) : served_(served) {}
  Status open(const std::string&) override { return Done{}; }
  DeviceCapabilities capabilities() const override { return served_.can; }
  bool read(DeviceSample& sample) override {
    ++served_.reads;
    sample = {};
    sample.position = served_.position;
    sample.rotation = served_.rotation;
    sample.ready = served_.ready;
    return true;
  }
  void write(const DeviceWrench& wrench) override { served_.force = wrench.force, served_.torque = wrench.torque; }
  void close() override { ++served_.closed; }

 private:
  Served& served_;
};

Scene sheet_scene(const DeformableParameters& surface, const DeviceParameters& device = {}) {
  Scene scene("servo");
  scene.add_surface("tissue", sheet(), surface);
  scene.add_probe("finger", {}, device);
  return scene;
}

void connect(Session& session, Served& served, const char* name = "finger") {
  const Status connected = session.connect(name, std::make_unique<ServedDevice>(served));
  ASSERT_TRUE(connected) << connected.error().message();
}

void go(Session& session, Served& served, dvec3 to) {
  const dvec3 from = served.position;
  const int steps = std::max(1, static_cast<int>(length(to - from) / 1e-5));
  for (int i = 1; i <= steps; ++i) {
    served.position = from + (static_cast<double>(i) / steps) * (to - from);
    ASSERT_TRUE(session.step());
  }
}

DeviceModel model_of(Session& session) {
  SessionRun& run = SessionRun::of(session);
  const SessionEffector& effector = run.effectors.front();
  return device_model(run.world, effector.entity, effector.device, run.last);
}

// The next tick's force at a displacement `dx`, and the prediction of this tick's model.
struct Next {
  dvec3 tick{0}, model{0}, before{0};
};
Next next(const std::function<void(Session&)>& prepare, const Scene& scene, const char* name, dvec3 dx) {
  Session session = opened(scene);
  prepare(session);
  Next out;
  out.before = session.reading(name)->force;
  const DeviceModel model = model_of(session);
  const dvec3 at = model.position + dx;
  out.model = local_force(model, at, model.rotation, dx / 1e-3, dvec3(0), 1e-3).force;
  EXPECT_TRUE(session.move(name, at, model.rotation));
  EXPECT_TRUE(session.step());
  out.tick = session.reading(name)->force;
  return out;
}

TEST(DeviceModel, OfAProbeIsTheNextTicksForce) {
  const Scene scene =
      sheet_scene({.stiffness = 300.0, .contact_damping = 1.5, .friction_static = 2.0, .friction_sliding = 1.5},
                  {.max_force = 20.0, .max_slew = 1e6});
  const auto prepare = [](Session& session) {
    press(session, 0.004);
    for (int i = 0; i < 20; ++i) {  // along the surface too: the bristle is bent, and sticks
      ASSERT_TRUE(session.move("finger", {1e-5 * i, -0.004, 0}));
      ASSERT_TRUE(session.step());
    }
    ASSERT_TRUE(session.step(300));
  };
  for (const dvec3 dx : {dvec3(0, -2e-5, 0), dvec3(0, -5e-6, 0), dvec3(1e-5, 0, 0), dvec3(0, 0, -1e-5),
                         dvec3(5e-6, -1e-5, 5e-6), dvec3(0, -1e-4, 0)}) {
    const Next got = next(prepare, scene, "finger", dx);
    const double changed = length(got.tick - got.before);
    ASSERT_GT(changed, 1e-4);
    EXPECT_LT(length(got.tick - got.model), 0.05 * changed) << dx.x << ' ' << dx.y << ' ' << dx.z;
  }
}

TEST(DeviceModel, OfAToolIsTheNextTicksForce) {
  Scene scene;
  scene.add_surface("tissue", sheet(), {.stiffness = 800.0});
  scene.add_rigid_body("stylus", box(0.01f), {.mass = 0.05}, {.position = {0, 0.03, 0}});
  ASSERT_TRUE(scene.add_handle("stylus", {.translation = {2000.0, 3.0}, .rotation = {5.0, 0.01}},
                               {.max_force = 20.0, .max_slew = 1e6}));
  const auto prepare = [](Session& session) {
    for (int i = 0; i <= 1000; ++i) {
      ASSERT_TRUE(session.move("stylus", {0, 0.03 - 0.022 * i / 1000, 0}));
      ASSERT_TRUE(session.step());
    }
    ASSERT_TRUE(session.step(1003));
  };
  for (const dvec3 dx : {dvec3(0, -2e-5, 0), dvec3(2e-5, 0, 0), dvec3(0, 1e-5, 1e-5)}) {
    const Next got = next(prepare, scene, "stylus", dx);
    const double changed = length(got.tick - got.before);
    ASSERT_GT(changed, 1e-3);
    EXPECT_LT(length(got.tick - got.model), 0.1 * changed) << dx.x << ' ' << dx.y << ' ' << dx.z;
  }
}

// x . A x <= 0 for every x, along many directions.
bool never_gives(const dmat3& m) {
  for (int i = 0; i < 200; ++i) {
    const double a = 0.7 * i, b = std::sin(1.3 * i);
    const dvec3 x(std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b));
    if (dot(x, m * x) > 1e-9) return false;
  }
  return true;
}

TEST(DeviceModel, ItsMatricesNeverGiveAndVanishWithWhatSafetyHolds) {
  for (const double most : {20.0, 0.5, 0.0}) {
    Session session = opened(sheet_scene({.stiffness = 300.0, .contact_damping = 1.5}, {.max_force = most}));
    press(session, 0.004);
    const DeviceModel model = model_of(session);
    EXPECT_TRUE(never_gives(model.force_by_position));
    EXPECT_TRUE(never_gives(model.force_by_velocity));
    const double along = model.force_by_position[1][1];
    if (most == 20.0)
      EXPECT_NEAR(along, -300.0, 1.0);
    else
      EXPECT_EQ(along, 0.0) << "clipped: along it nothing changes";
  }
  Session gated = opened(sheet_scene({.stiffness = 300.0}));
  ASSERT_TRUE(gated.move("finger", {0, -0.004, 0}));
  ASSERT_TRUE(gated.step(10));
  EXPECT_EQ(model_of(gated).force_by_position, dmat3(0.0)) << "behind a closed gate";
}

TEST(SessionServo, ADeviceWithARateFeelsTheSurfaceThroughItsGuard) {
  Served served;
  Session session = opened(sheet_scene({.stiffness = 300.0}));
  connect(session, served);
  ASSERT_TRUE(session.step(400));
  const auto report = session.device_state("finger");
  ASSERT_TRUE(report);
  EXPECT_EQ(report->state, DeviceState::kActive);
  go(session, served, {0, -0.005, 0});
  EXPECT_NEAR(served.force.y, 1.5, 0.03);
  EXPECT_NEAR(session.reading("finger")->force.y, 1.5, 0.03);
  session.emergency_stop();
  ASSERT_TRUE(session.step(2));
  EXPECT_EQ(length(served.force), 0.0);
  EXPECT_EQ(length(session.reading("finger")->force), 0.0) << "nobody feels it, and no reading says so";
  EXPECT_EQ(session.device_state("finger")->state, DeviceState::kTripped);
  EXPECT_THAT(describe(session.device_state("finger")->transition(3)), HasSubstr("emergency stop"));
  ASSERT_TRUE(session.arm("finger"));
  ASSERT_TRUE(session.step(300));
  EXPECT_EQ(length(served.force), 0.0) << "deep in the sheet the gate is closed";
  go(session, served, {0, 0.005, 0});
  go(session, served, {0, -0.005, 0});
  EXPECT_NEAR(served.force.y, 1.5, 0.03);
}

TEST(SessionServo, LockstepGivesTheSameBitsAtEveryRateOfTheDevice) {
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    std::vector<double> first;
    for (int run = 0; run < 2; ++run) {
      Served served{.can = {.max_force = 5.0, .rate = rate}};
      Session session = opened(sheet_scene({.stiffness = 300.0}));
      connect(session, served);
      ASSERT_TRUE(session.step(400));
      std::vector<double> forces;
      for (int i = 0; i < 700; ++i) {
        served.position.y -= 2e-5;
        ASSERT_TRUE(session.step());
        forces.push_back(served.force.y);
      }
      EXPECT_EQ(served.reads, static_cast<int>(1.099 * rate + 1e-6) + 1) << "the periods until the last tick began";
      EXPECT_GT(forces.back(), 0.8);
      if (run == 0)
        first = forces;
      else
        EXPECT_EQ(forces, first) << rate;
    }
  }
}

TEST(SessionServo, ADeviceThatAnswersInItsOwnTimeIsRefusedInLockstep) {
  Served served{.can = {.max_force = 5.0, .rate = 1000.0, .loop = DeviceLoop::kReply}};
  Session session = opened(sheet_scene({.stiffness = 300.0}));
  connect(session, served);
  const Status stepped = session.step();
  ASSERT_FALSE(stepped);
  EXPECT_THAT(stepped.error().message(), HasSubstr("call Session::start()"));
}

TEST(SessionServo, WhatHasNoDriverSaysSoAndAGuardOfNonsenseIsRefused) {
  Log log;
  Session session = opened(press_scene());
  EXPECT_THAT(session.device_state("finger").error().message(), HasSubstr("has no driver"));
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  EXPECT_FALSE(session.disarm("thumb"));
  EXPECT_FALSE(session.guard("finger", {.max_force = -1.0}));
  EXPECT_FALSE(session.guard("finger", {.slew = 0.0}));
  EXPECT_TRUE(session.guard("finger", {.arming = Arming::kByHand}));
}

TEST(SessionServo, TheEmergencyStopLatchesADeviceWithoutAServoUntilItIsArmed) {
  Log log;
  log.can = {.max_force = 5.0};
  Session session = opened(press_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  ASSERT_TRUE(session.step(5));
  EXPECT_EQ(session.device_state("finger")->state, DeviceState::kActive);
  lower(session, log, -0.004);
  ASSERT_TRUE(session.step(20));
  ASSERT_GT(log.last, 0.5);
  session.emergency_stop();
  ASSERT_TRUE(session.step());
  EXPECT_EQ(log.last, 0.0);
  EXPECT_EQ(length(session.reading("finger")->force), 0.0) << "no reading says what nobody feels";
  ASSERT_TRUE(session.step(300));
  EXPECT_EQ(log.last, 0.0) << "it is latched";
  const DeviceReport stopped = *session.device_state("finger");
  EXPECT_EQ(stopped.state, DeviceState::kTripped);
  EXPECT_EQ(stopped.cause, DeviceCause::kEmergencyStop);
  EXPECT_GT(length(stopped.wanted.force), 0.5);
  EXPECT_EQ(length(stopped.sent.force), 0.0);
  EXPECT_NEAR(stopped.sample.position.y, -0.004, 1e-9);
  ASSERT_TRUE(session.arm("finger"));
  ASSERT_TRUE(session.step(300));
  EXPECT_EQ(session.device_state("finger")->state, DeviceState::kActive);
  EXPECT_EQ(log.last, 0.0) << "deep in the sheet the gate is closed";
  log.height = 0.01;
  ASSERT_TRUE(session.step(5));
  lower(session, log, -0.004);
  ASSERT_TRUE(session.step(20));
  EXPECT_GT(log.last, 0.5);
  ASSERT_TRUE(session.disarm("finger"));
  ASSERT_TRUE(session.step());
  EXPECT_EQ(log.last, 0.0);
  EXPECT_EQ(session.device_state("finger")->state, DeviceState::kIdle);
  log.silent = true;
  ASSERT_TRUE(session.arm("finger"));
  ASSERT_TRUE(session.step(300));
  EXPECT_EQ(session.device_state("finger")->state, DeviceState::kDisconnected);
}

TEST(SessionServo, InRealTimeItRunsBesideTheTouchClockAndEndsAtZero) {
  Log log;
  log.can = {.max_force = 0.5, .rate = 2000.0};
  {
    Session session = opened(press_scene());
    ASSERT_TRUE(session.guard("finger", {.arming = Arming::kByHand}));
    ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
    ASSERT_TRUE(session.start());
    ASSERT_TRUE(within_five_seconds([&] { return session.device_state("finger")->state == DeviceState::kIdle; }));
    EXPECT_EQ(log.largest, 0.0);
    ASSERT_TRUE(within_five_seconds([&] {
      if (session.device_state("finger")->state == DeviceState::kIdle ||
          session.device_state("finger")->state == DeviceState::kTripped)
        EXPECT_TRUE(session.arm("finger"));
      return session.device_state("finger")->state == DeviceState::kActive;
    }));
    EXPECT_GT(session.device_state("finger")->figures.periods, 0u);
    ASSERT_TRUE(session.pause(true));
    ASSERT_TRUE(within_five_seconds([&] { return session.device_state("finger")->state != DeviceState::kActive; }));
    ASSERT_TRUE(session.pause(false));
    ASSERT_TRUE(session.stop());
    EXPECT_EQ(log.last, 0.0);
    ASSERT_TRUE(session.restart());
    ASSERT_TRUE(session.step(3)) << "and in lockstep afterwards";
  }
  EXPECT_EQ(log.last, 0.0);
  EXPECT_EQ(log.closed, 1);
}

}  // namespace
}  // namespace pliant
