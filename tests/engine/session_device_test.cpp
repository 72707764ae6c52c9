// Taking over a device: no limit of its driver is raised, no previous force continues, no more energy is returned than
// was put in, whatever part the device renders itself.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <thread>

#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

// A device in the test's hand, in lockstep.
struct Held {
  DeviceCapabilities can;
  dvec3 position{0, 0.01, 0};  // [m] its workspace
  dquat rotation{1, 0, 0, 0};
  dvec3 force{0}, torque{0};    // as written last
  std::vector<double> written;  // [N]
};
class HeldDevice final : public Driver {
 public:
  explicit HeldDevice(Held& held) : held_(held) {}
  Status open(const std::string&) override { return Done{}; }
  DeviceCapabilities capabilities() const override { return held_.can; }
  bool read(DeviceSample& sample) override {
    sample = {held_.position, held_.rotation, true};
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    held_.force = wrench.force, held_.torque = wrench.torque;
    held_.written.push_back(length(wrench.force));
  }
  void close() override {}

 private:
  Held& held_;
};

Scene stiff_scene(const DeviceParameters& device = {}, double stiffness = 600.0) {
  Scene scene("stiff");
  scene.add_surface("tissue", sheet(), {.stiffness = stiffness});
  scene.add_probe("finger", {}, device);
  return scene;
}

void connect(Session& session, Held& held, const char* name = "finger") {
  const Status connected = session.connect(name, std::make_unique<HeldDevice>(held));
  ASSERT_TRUE(connected) << connected.error().message();
}

// By 10 um a tick, in metres of its workspace.
void go(Session& session, Held& held, double height) {
  const double step = height < held.position.y ? -1e-5 : 1e-5;
  while (std::abs(height - held.position.y) > 1e-9) {
    held.position.y += std::abs(height - held.position.y) < 1e-5 ? height - held.position.y : step;
    ASSERT_TRUE(session.step());
  }
}

TEST(SessionDevice, NoEditLiftsTheDriversLimitWhenItWasMadeBeforeIt) {
  Held held{.can = {.max_force = 1.0}};
  Session session = opened(stiff_scene());
  ASSERT_TRUE(session.set("finger", "max_force", 8.0));
  connect(session, held);
  go(session, held, -0.01);
  EXPECT_NEAR(*std::max_element(held.written.begin(), held.written.end()), 1.0, 1e-9);
}

TEST(SessionDevice, ADriversLimitGoesWithIt) {
  Held weak{.can = {.max_force = 1.0}}, strong;
  Session session = opened(stiff_scene());
  connect(session, weak);
  ASSERT_TRUE(session.set("finger", "max_force", 8.0));
  ASSERT_TRUE(session.release("finger"));
  connect(session, strong);
  go(session, strong, -0.01);
  EXPECT_NEAR(length(strong.force), 6.0, 1e-6) << "as it was set, not as the first driver had it";
}

// The previous source pressed deeply; the new one starts there, or elsewhere.
TEST(SessionDevice, ADeviceThatTakesOverBeginsAtZeroBehindTheGate) {
  using Before = std::function<void(Session&, Held&)>;
  const auto deep = Path{.rows = {{0.0, {0, 0.005, 0}}, {1.0, {0, -0.005, 0}}}};
  const Before by_pose = [](Session& s, Held&) { press(s, 0.005); };
  const Before by_path = [&](Session& s, Held&) {
    ASSERT_TRUE(s.follow("finger", deep));
    ASSERT_TRUE(s.step(1200));
  };
  const Before by_orbit = [](Session& s, Held&) {
    ASSERT_TRUE(s.orbit("finger"));
    for (int i = 0; i < 20000 && length(s.reading("finger")->force) < 0.5; ++i) ASSERT_TRUE(s.step());
  };
  const Before by_driver = [](Session& s, Held& first) {
    connect(s, first);
    go(s, first, -0.005);
  };
  const Before by_nobody = [](Session& s, Held&) { ASSERT_TRUE(s.step(10)); };
  for (const Before& before : {by_pose, by_path, by_orbit, by_driver, by_nobody}) {
    for (const double height : {-0.005, 0.02}) {
      Held first, second{.can = {.max_force = 1.0}, .position = {0.01, height, 0}};
      Session session = opened(stiff_scene());
      before(session, first);
      ASSERT_TRUE(session.release("finger"));
      connect(session, second);
      ASSERT_TRUE(session.step(30));
      EXPECT_EQ(*std::max_element(second.written.begin(), second.written.end()), 0.0) << height;
      go(session, second, 0.005);
      go(session, second, -0.005);
      EXPECT_NEAR(length(second.force), 1.0, 1e-6) << "out of contact once, the gate is open";
    }
  }
}

TEST(SessionDevice, ADeviceTakesOverFromALevelsOwnSource) {
  Scene scene = stiff_scene();
  Held held{.position = {0, -0.005, 0}};
  Session session = opened(scene);
  ASSERT_TRUE(session.follow("finger", {.rows = {{0.0, {0, 0.005, 0}}, {1.0, {0, -0.005, 0}}}}));
  ASSERT_TRUE(session.step(1100));
  ASSERT_NEAR(length(session.reading("finger")->force), 3.0, 1e-3);
  ASSERT_TRUE(session.release("finger"));
  ASSERT_TRUE(session.move("finger", {0, -0.005, 0}));
  ASSERT_TRUE(session.step());
  EXPECT_EQ(length(session.reading("finger")->force), 0.0) << "a pose that takes over passes the gate as well";
}

// A stylus over a sheet, in cycles: down, tilt, up, back. An ideal tool returns at most the energy it received.
struct Cycle {
  double work = 0.0;  // [J] on the hand, of the written force
  double largest_force = 0.0, largest_torque = 0.0;
  std::vector<std::string> findings;
};
Cycle cycle(const DeviceCapabilities& can, double scale) {
  Scene scene;
  scene.add_surface("tissue", sheet(), {.stiffness = 800.0});
  scene.add_rigid_body("stylus", box(0.01f), {.mass = 0.05}, {.position = {0, 0.03, 0}});
  EXPECT_TRUE(scene.add_handle("stylus", {.translation = {3000.0, 5.0}, .rotation = {5.0, 0.01}}, {.scale = scale}));
  Held held{.can = can, .position = {0, 0.03 / scale, 0}};
  Session session = opened(scene);
  connect(session, held, "stylus");
  Cycle out;
  double last_angle = 0.0;
  const auto tick = [&](double y, double angle) {
    const dvec3 position = held.position, force = held.force, torque = held.torque;
    held.position = {0, y / scale, 0};
    held.rotation = dquat(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
    ASSERT_TRUE(session.step());
    out.work += 0.5 * dot(force + held.force, held.position - position);
    out.work += 0.5 * (torque.z + held.torque.z) * (angle - last_angle);
    out.largest_force = std::max(out.largest_force, length(held.force));
    out.largest_torque = std::max(out.largest_torque, length(held.torque));
    last_angle = angle;
  };
  for (int n = 0; n < 3; ++n) {
    for (int i = 0; i < 300; ++i) tick(0.03 - 0.018 * i / 300, 0);
    for (int i = 0; i < 300; ++i) tick(0.012, 0.5236 * i / 300);
    for (int i = 0; i < 300; ++i) tick(0.012 + 0.018 * i / 300, 0.5236);
    for (int i = 0; i < 300; ++i) tick(0.03, 0.5236 * (1 - i / 300.0));
  }
  for (const Note& note : *session.findings()) out.findings.push_back(note.message());
  return out;
}

TEST(SessionDevice, AClosedCycleGivesTheHandNoEnergyWhateverItsDeviceRenders) {
  const DeviceCapabilities all{.senses_rotation = true, .renders_torque = true};
  DeviceCapabilities force_only = all, torque_only = all, little_torque = all;
  force_only.renders_torque = false;
  torque_only.renders_force = false;
  little_torque.max_torque = 1e-3;
  for (const double scale : {1.0, 5.0}) {
    for (const DeviceCapabilities& can : {all, force_only, torque_only, little_torque}) {
      const Cycle got = cycle(can, scale);
      EXPECT_LT(got.work, 5e-5) << can.renders_force << can.renders_torque << can.max_torque << " scale " << scale;
      if (can.renders_force)
        EXPECT_GT(got.largest_force, 0.1);
      else
        EXPECT_EQ(got.largest_force, 0.0);
      if (can.renders_torque)
        EXPECT_GT(got.largest_torque, 1e-4);
      else
        EXPECT_EQ(got.largest_torque, 0.0);
      if (can.max_torque > 0.0) EXPECT_LE(got.largest_torque, can.max_torque * (1 + 1e-9));
      if (!can.renders_torque) EXPECT_THAT(got.findings, Not(Contains(HasSubstr("torque"))));
    }
  }
}

TEST(SessionDevice, TheDriversStiffnessIsOfItsOwnWorkspace) {
  for (const double scale : {1.0, 10.0, 0.1}) {
    Held held{.can = {.max_stiffness = 500.0}, .position = {0, 0.005 / scale, 0}};
    Session session = opened(stiff_scene({.scale = scale, .max_force = 50.0, .max_slew = 1e6}, 2000.0));
    connect(session, held);
    double steepest = 0.0;
    for (int i = 0; i <= 1500; ++i) {
      const double before = held.force.y, from = held.position.y;
      held.position.y = (0.005 - 1e-5 * i) / scale;
      ASSERT_TRUE(session.step());
      if (from > held.position.y) steepest = std::max(steepest, (held.force.y - before) / (from - held.position.y));
    }
    EXPECT_LT(steepest, 500.0 * (1 + 1e-6)) << scale;
    // In the hand's metres the sheet has 2000 scale: softer than the limit where the workspace is large.
    EXPECT_NEAR(steepest, std::min(500.0, 2000.0 * scale), 1.0) << scale;
  }
}

TEST(SessionDevice, AStifferSurfaceIsAsStiffAsTheDeviceRendersIntoItAndOutOfIt) {
  Held held{.can = {.max_stiffness = 500.0}, .position = {0, 0.001, 0}};
  Session session = opened(stiff_scene({.max_force = 50.0, .max_slew = 1e6}, 2000.0));
  connect(session, held);
  for (int turn = 0; turn < 3; ++turn)  // a force that rises slowly and falls fast would become weaker in each cycle
    for (int i = -300; i <= 300; ++i) {
      held.position.y = -0.002 + 1e-5 * std::abs(i);
      ASSERT_TRUE(session.step());
      const double depth = std::max(0.0, -held.position.y);
      if (depth > 1e-3) EXPECT_NEAR(held.force.y, 500.0 * depth, 0.05 * 500.0 * depth) << turn << ' ' << i;
    }
  EXPECT_THAT(*session.findings(),
              Contains(AllOf(Field(&Note::code, "device.softened"), Field(&Note::of, "finger"),
                             Field(&Note::what, HasSubstr("renders at most 500 N/m stably: there it got 25 % of the "
                                                          "force")))));
}

TEST(SessionDevice, ADeviceThatIsSteppedTooSlowlyToBeFeltIsNamedOnce) {
  Held held{.position = {0, 0.001, 0}};
  Session session = opened(stiff_scene());
  connect(session, held);
  ASSERT_TRUE(session.step());
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  ASSERT_TRUE(session.step());
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  ASSERT_TRUE(session.step());
  const auto findings = *session.findings();
  EXPECT_EQ(std::count_if(findings.begin(), findings.end(), [](const Note& one) { return one.code == "device.late"; }),
            1);
}

TEST(SessionDevice, AHandIsFastInItsOwnWorkspace) {
  Held held;
  Session session = opened(stiff_scene({.scale = 10.0}));
  connect(session, held);
  ASSERT_TRUE(session.step(10));
  for (int i = 0; i < 10; ++i) {
    held.position.y += 5e-3;  // 5 m/s, which is 50 m/s of the world
    ASSERT_TRUE(session.step());
  }
  EXPECT_THAT(*session.findings(), Not(Contains(Field(&Note::code, "dropped.jump"))));
  held.position.y += 0.05;
  ASSERT_TRUE(session.step());
  EXPECT_THAT(*session.findings(), Contains(Field(&Note::code, "dropped.jump")));
}

TEST(SessionDevice, AReplayFeelsTheLimitsOfTheDriver) {
  const auto file = std::filesystem::path(testing::TempDir()) / "session_device.rec";
  for (const DeviceCapabilities& can :
       {DeviceCapabilities{.max_force = 1.0, .max_stiffness = 300.0}, DeviceCapabilities{.renders_force = false}}) {
    std::filesystem::remove(file);
    const Scene scene = stiff_scene({.scale = 3.0});
    std::vector<double> live;
    {
      Held held{.can = can, .position = {0, 0.001, 0}};
      Session session = opened(scene);
      connect(session, held);
      ASSERT_TRUE(session.record(file));
      go(session, held, -0.0015);
      go(session, held, 0.001);
      live = held.written;
      ASSERT_TRUE(session.end_recording());
    }
    Session session = opened(scene);
    ASSERT_TRUE(session.replay(file));
    EXPECT_THAT(session.notes(), testing::IsEmpty());
    for (std::size_t i = 0; i < live.size(); ++i) {
      ASSERT_TRUE(session.step());
      ASSERT_EQ(length(session.reading("finger")->force), live[i]) << i;
    }
  }
  std::filesystem::remove(file);
}

TEST(SessionDevice, AForceThatIsLetGoFallsWhateverTheSlewLimit) {
  EXPECT_FALSE(opened(stiff_scene()).set("finger", "max_slew", 1e-6));
  for (const bool lifts : {true, false}) {
    Held held;
    Session session = opened(stiff_scene());
    connect(session, held);
    go(session, held, -0.005);
    ASSERT_NEAR(length(held.force), 3.0, 1e-6);
    ASSERT_TRUE(session.set("finger", "max_slew", 1.0));
    if (lifts) {
      double work = 0.0;
      for (int i = 0; i < 1000; ++i) {
        const double before = held.force.y;
        held.position.y += 2e-5;
        ASSERT_TRUE(session.step());
        work += 0.5 * (before + held.force.y) * 2e-5;
      }
      EXPECT_EQ(length(held.force), 0.0) << "in free air";
      EXPECT_LT(work, 0.5 * 600.0 * 0.005 * 0.005 * 1.01) << "no more than it took";
    } else {
      ASSERT_TRUE(session.set("finger", "max_force", 0.5));
      ASSERT_TRUE(session.step(3));
      EXPECT_NEAR(length(held.force), 0.5, 1e-9) << "a lowered limit holds within 2.5 ms";
    }
  }
}

// A device of 250 Hz: after the pause there are ticks before its first sample.
TEST(SessionDevice, AfterAPauseThePoseFromBeforeItOpensNoGate) {
  struct Slow final : Driver {
    explicit Slow(Log& log) : log_(log) {}
    Status open(const std::string&) override { return Done{}; }
    bool read(DeviceSample& sample) override {
      sample.position = {0, log_.height.load(), 0};
      return ++log_.reads % 4 == 0;
    }
    void write(const DeviceWrench& wrench) override {
      ++log_.writes;
      log_.largest = std::max(log_.largest.load(), length(wrench.force));
    }
    void close() override {}
    Log& log_;
  };
  for (int run = 0; run < 12; ++run) {
    Log log;
    Session session = opened(stiff_scene());
    ASSERT_TRUE(session.connect("finger", std::make_unique<Slow>(log)));
    ASSERT_TRUE(session.start());
    ASSERT_TRUE(within_five_seconds([&] { return log.reads > 20; }));
    ASSERT_TRUE(session.pause(true));
    const int paused = log.reads;
    ASSERT_TRUE(within_five_seconds([&] { return log.reads > paused + 10; }));
    log.height = -0.006;
    const int pressed = log.reads;
    ASSERT_TRUE(within_five_seconds([&] { return log.reads > pressed + 8 + run; }));
    ASSERT_TRUE(session.pause(false));
    const int resumed = log.writes;
    ASSERT_TRUE(within_five_seconds([&] { return log.writes > resumed + 40; }));
    EXPECT_EQ(log.largest, 0.0) << "inside the sheet since the pause";
    ASSERT_TRUE(session.stop());
  }
}

}  // namespace
}  // namespace pliant
