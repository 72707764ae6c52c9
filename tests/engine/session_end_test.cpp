// However a session ends, whatever a driver does: the force is zero, and the error gives the cause.
#include <gmock/gmock.h>
#include <pthread.h>

#include <cmath>
#include <limits>

#include "pliant/linear_solver.h"
#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Scene two_fingers() {
  Scene scene = press_scene();
  scene.add_probe("thumb", {}, {}, {.position = {0.02, 0.01, 0}});
  return scene;
}

TEST(SessionEnd, WhatOneDriverThrowsLeavesNoForceOnAnother) {
  for (const bool real_time : {false, true}) {
    Log first, second;
    Session session = opened(two_fingers());
    ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(first)));
    ASSERT_TRUE(session.connect("thumb", std::make_unique<LoggedDevice>(second)));
    if (real_time) ASSERT_TRUE(session.start());
    for (int i = 0; i < 400; ++i) {
      first.height = second.height = std::max(-0.003, 0.005 - 2e-5 * i);
      if (real_time)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      else
        ASSERT_TRUE(session.step());
    }
    ASSERT_TRUE(!real_time || within_five_seconds([&] { return second.last > 0.1; }));
    ASSERT_GT(second.last, 0.1);
    first.write_throws = true;
    if (real_time) {
      ASSERT_TRUE(within_five_seconds([&] { return !session.running(); }));
      EXPECT_THAT(session.stop().error().message(), HasSubstr("bus off"));
    } else {
      EXPECT_THAT(session.step().error().message(), HasSubstr("bus off"));
      EXPECT_THAT(session.step().error().message(), HasSubstr("restart()")) << "no tick runs on without its device";
    }
    EXPECT_EQ(first.last, 0.0);
    EXPECT_EQ(second.last, 0.0);
    const Reading felt = *session.reading("thumb");
    EXPECT_FALSE(felt.ready);
    EXPECT_EQ(length(felt.force), 0.0) << "the reading says what is";
    first.write_throws = false;
    ASSERT_TRUE(session.restart());
    EXPECT_TRUE(session.step(3)) << "its sources stay";
  }
}

TEST(SessionEnd, ARestartLeavesNoForceOnADeviceThatPushes) {
  Log log;
  Session session = opened(press_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  lower(session, log, -0.002);
  ASSERT_GT(log.last, 0.1);
  ASSERT_TRUE(session.restart());
  EXPECT_EQ(log.last, 0.0);
  EXPECT_EQ(log.closed, 0) << "it stays connected";
}

TEST(SessionEnd, AfterRealTimeNoTickRunsUntilARestart) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.move("finger", {0, 0.01, 0}));
  ASSERT_TRUE(session.start());
  ASSERT_TRUE(session.stop());
  EXPECT_THAT(session.step().error().message(), HasSubstr("restart()"));
  ASSERT_TRUE(session.restart());
  EXPECT_TRUE(session.step());
}

struct BadDriver final : Driver {
  enum class Throws { kOpen, kCapabilities, kClose, kNothing };
  BadDriver(Throws throws, DeviceCapabilities can, int& closed) : throws_(throws), can_(can), closed_(closed) {}
  Status open(const std::string&) override {
    if (throws_ == Throws::kOpen) throw 42;
    return Done{};
  }
  DeviceCapabilities capabilities() const override {
    if (throws_ == Throws::kCapabilities) throw std::runtime_error("no answer");
    return can_;
  }
  bool read(DeviceSample& sample) override {
    sample.position = {0, 0.01, 0};
    return true;
  }
  void write(const DeviceWrench&) override {}
  void close() override {
    ++closed_;
    if (throws_ == Throws::kClose) throw std::runtime_error("stuck");
  }
  Throws throws_;
  DeviceCapabilities can_;
  int& closed_;
};

TEST(SessionEnd, ADriverThatThrowsOrSaysNonsenseIsNotConnected) {
  using Throws = BadDriver::Throws;
  Session session = opened(press_scene());
  int closed = 0;
  const auto connect = [&](Throws throws, DeviceCapabilities can) {
    return session.connect("finger", std::make_unique<BadDriver>(throws, can, closed));
  };
  EXPECT_THAT(connect(Throws::kOpen, {}).error().message(), HasSubstr("threw"));
  EXPECT_EQ(closed, 0) << "it was not open";
  EXPECT_THAT(connect(Throws::kCapabilities, {}).error().message(), HasSubstr("no answer"));
  EXPECT_EQ(closed, 1);
  EXPECT_THAT(connect(Throws::kNothing, {.max_force = kNaN}).error().message(), HasSubstr("must say a number"));
  EXPECT_THAT(connect(Throws::kNothing, {.max_stiffness = -1.0}).error().message(), HasSubstr("must say a number"));
  EXPECT_EQ(closed, 3);
  ASSERT_TRUE(connect(Throws::kClose, {}));
  ASSERT_TRUE(session.step(5));
  EXPECT_TRUE(session.release("finger")) << "what close throws is nobody's harm";
  EXPECT_EQ(closed, 4);
  ASSERT_TRUE(register_driver("session_end_thrower", []() -> std::unique_ptr<Driver> { throw 7; }));
  EXPECT_THAT(session.connect("finger", "session_end_thrower").error().message(), HasSubstr("factory"));
}

TEST(SessionEnd, NoLimitGoesBeyondWhatTheDriverCanRender) {
  Log log;
  Session session = opened(press_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  ASSERT_TRUE(session.set("finger", "max_force", 5.0));
  lower(session, log, -0.004);
  ASSERT_TRUE(session.step(20));
  EXPECT_NEAR(log.last, 0.5, 1e-9);
  const auto findings = session.findings();
  ASSERT_TRUE(findings);
  EXPECT_THAT(*findings, Contains(AllOf(Field(&Note::code, "force.clipped"), Field(&Note::of, "finger"))));
  ASSERT_TRUE(session.release("finger"));
  EXPECT_EQ(log.last, 0.0);
  EXPECT_EQ(*session.get("finger", "max_force"), 5.0);
  EXPECT_FALSE(session.set("finger", "max_force", kNaN));
  EXPECT_FALSE(session.set("finger", "max_force", -1.0));
}

TEST(SessionEnd, ADeviceIsWrittenOnlyWhatItRenders) {
  Log log;
  log.can = {.renders_force = false};
  Session session = opened(press_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  lower(session, log, -0.002);
  EXPECT_EQ(log.largest, 0.0);
  EXPECT_TRUE(session.reading("finger")->touching);
}

TEST(SessionEnd, NumbersOfAScenePassTheSameChecksAsAFiles) {
  const auto error_of = [](auto change) {
    Scene scene;
    DeformableParameters surface;
    DeviceParameters device;
    ProbeParameters probe;
    change(scene, surface, device, probe);
    scene.add_surface("tissue", sheet(), surface);
    scene.add_probe("finger", probe, device);
    const auto session = Session::open(scene);
    return session ? std::string() : session.error().message();
  };
  using D = DeformableParameters;
  using H = DeviceParameters;
  using P = ProbeParameters;
  EXPECT_EQ(error_of([](Scene&, D&, H&, P&) {}), "");
  EXPECT_THAT(error_of([](Scene&, D&, H& h, P&) { h.max_force = kNaN; }), HasSubstr("max_force"));
  EXPECT_THAT(error_of([](Scene&, D&, H& h, P&) { h.max_force = 1e6; }), HasSubstr("max_force"));
  EXPECT_THAT(error_of([](Scene&, D&, H& h, P&) { h.max_slew = 0.0; }), HasSubstr("max_slew"));
  EXPECT_THAT(error_of([](Scene&, D& d, H&, P&) { d.friction_sliding = 0.9; }), HasSubstr("friction_sliding"));
  EXPECT_THAT(error_of([](Scene&, D& d, H&, P&) { d.young = 1e4, d.poisson = 1.0; }), HasSubstr("poisson"));
  EXPECT_THAT(error_of([](Scene&, D& d, H&, P&) { d.shape = static_cast<Shape>(200); }), HasSubstr("shape"));
  EXPECT_THAT(error_of([](Scene&, D&, H&, P& p) { p.radius = -1.0; }), HasSubstr("radius"));
  EXPECT_THAT(error_of([](Scene& s, D&, H&, P&) { s.simulation().touch_rate = kNaN; }), HasSubstr("touch_rate"));
}

TEST(SessionEnd, YoungsModulusSetsTheStiffnessOfAPointAsInAFile) {
  Scene scene;
  scene.add_surface("tissue", sheet(), {.young = 2e4, .poisson = 0.45, .thickness = 0.02});
  scene.add_probe("finger");
  Session session = opened(scene);
  const double stiffness = *session.get("tissue", "stiffness");
  EXPECT_NE(stiffness, DeformableParameters{}.stiffness);
  press(session, 0.002);
  EXPECT_NEAR(session.reading("finger")->force.y, stiffness * 0.002, 1e-5);
  EXPECT_THAT(session.set("tissue", "stiffness", 900.0).error().message(), HasSubstr("young"));
}

// A closed box of 12 triangles is refined for touch; forces are reported on the eight given vertices.
TEST(SessionEnd, ForcesOfARefinedMeshAreOnTheVerticesThatWereGiven) {
  MeshData block = box(0.05f);
  for (vec3& p : block.position) p.y -= 0.05f;  // its top in y = 0
  Scene scene;
  scene.add_surface("block", block, {.stiffness = 300.0});
  scene.add_probe("finger");
  Session session = opened(scene);
  for (int i = 0; i <= 300; ++i) {
    ASSERT_TRUE(session.move("finger", {0.012, 0.001 - 1e-5 * i, 0.02}));
    ASSERT_TRUE(session.step());
  }
  const dvec3 felt = session.reading("finger")->force;
  ASSERT_GT(felt.y, 0.3);
  std::vector<vec3> force;
  ASSERT_TRUE(session.vertex_forces("block", force));
  ASSERT_EQ(force.size(), 8u);
  dvec3 sum(0), moment(0);
  for (std::size_t i = 0; i < 8; ++i) {
    sum += dvec3(force[i]);
    moment += cross(dvec3(block.position[i]), dvec3(force[i]));
  }
  EXPECT_NEAR(length(sum + felt), 0.0, 1e-5) << "action and reaction";
  const dvec3 lever = moment / -felt.y;  // of a force along y at (x, ., z): (-z, 0, x) per newton
  EXPECT_NEAR(lever.z, 0.012, 1e-3);
  EXPECT_NEAR(-lever.x, 0.02, 1e-3);
}

// A soft body's solver that is controlled while it runs.
enum class Does : int { kSolves, kHangs, kThrowsANumber, kThrows };
std::atomic<Does> does{Does::kSolves};
std::atomic<int> hanging{0};
class ControlledSolver final : public BlackBoxSolver {
 public:
  bool factorise(const BlockRows& matrix) override {
    diagonal_.assign(3 * matrix.size, 1.0);
    for (std::uint32_t row = 0; row < matrix.size; ++row)
      for (std::uint32_t k = matrix.first[row]; k < matrix.first[row + 1]; ++k)
        if (matrix.column[k] == row)
          for (int i = 0; i < 3; ++i) diagonal_[3 * row + i] = matrix.value[9 * k + 4 * i];
    return true;
  }
  void solve(std::span<const double> b, std::span<double> x) const override {
    while (does == Does::kHangs) {
      hanging = 1;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = b[i] / diagonal_[i];
  }

 private:
  std::vector<double> diagonal_;
};
Scene cube_scene() {
  static const auto kind = register_solver("session_end_controlled", []() -> std::unique_ptr<BlackBoxSolver> {
    if (does == Does::kThrowsANumber) throw 7;
    if (does == Does::kThrows) throw std::runtime_error("no licence");
    return std::make_unique<ControlledSolver>();
  });
  EXPECT_TRUE(kind);
  Scene scene = press_scene();
  scene.add_soft_body("cube", box(0.02f), {.cell = 0.02, .solver = *kind}, {.position = {0.2, 0.05, 0}});
  return scene;
}

TEST(SessionEnd, ASolverThatHangsKeepsNoDeviceDriven) {
  does = Does::kSolves;
  hanging = 0;
  Log log;
  Session session = opened(cube_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  ASSERT_TRUE(session.start());
  for (int i = 0; i < 400 && log.last < 0.1; ++i) {
    log.height = std::max(-0.003, 0.004 - 2e-5 * i);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  // A pressing hand trembles: an identical pose for long counts as a frozen sensor.
  int said = 0;
  const auto presses = [&] {
    log.height = -0.003 + (++said % 2 ? 1e-5 : 0.0);
    return log.last > 0.1;
  };
  EXPECT_TRUE(within_five_seconds(presses));
  does = Does::kHangs;
  EXPECT_TRUE(within_five_seconds([&] { return presses(), hanging == 1; }));
  EXPECT_TRUE(within_five_seconds(presses)) << "the touch clock goes on";
  std::atomic<bool> stopped{false};
  std::thread stopping([&] {
    EXPECT_TRUE(session.stop());
    stopped = true;
  });
  EXPECT_TRUE(within_five_seconds([&] { return log.last == 0.0; })) << "the solver still hangs";
  EXPECT_FALSE(stopped);
  does = Does::kSolves;
  stopping.join();
}

TEST(SessionEnd, WhateverASolverThrowsWhenItIsMadeIsASentence) {
  for (const Does what : {Does::kThrows, Does::kThrowsANumber}) {
    does = Does::kSolves;
    Log log;
    Session session = opened(cube_scene());
    ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
    ASSERT_TRUE(session.step(20));
    does = what;
    EXPECT_FALSE(Session::open(cube_scene()));
    const Status failed = session.restart();
    ASSERT_FALSE(failed);
    EXPECT_THAT(failed.error().message(), HasSubstr(what == Does::kThrows ? "no licence" : "no std::exception"));
    EXPECT_EQ(log.closed, 1) << "nobody writes to it any more";
    EXPECT_EQ(log.last, 0.0);
    EXPECT_EQ(session.figures().soft_steps, 0u) << "what is asked now has an answer";
    EXPECT_FALSE(session.step());
    EXPECT_FALSE(session.start());
    does = Does::kSolves;
    ASSERT_TRUE(session.restart());
    EXPECT_TRUE(session.step(3));
  }
}

// Such a stack exceeds the address space, so no thread can be created.
class NoThreads {
 public:
  NoThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t huge;
    pthread_attr_init(&huge);
    pthread_attr_setstacksize(&huge, std::size_t{1} << 47);
    EXPECT_EQ(pthread_setattr_default_np(&huge), 0);
    pthread_attr_destroy(&huge);
  }
  ~NoThreads() { pthread_setattr_default_np(&before_); }

 private:
  pthread_attr_t before_;
};

TEST(SessionEnd, WithoutAThreadStartIsASentenceAndNoForceIsLeft) {
  does = Does::kSolves;
  Log log;
  Session session = opened(cube_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  {
    const NoThreads none;
    const Status started = session.start();
    ASSERT_FALSE(started);
    EXPECT_THAT(started.error().message(), HasSubstr("thread"));
  }
  EXPECT_FALSE(session.running());
  EXPECT_EQ(log.last, 0.0);
  EXPECT_THAT(session.start().error().message(), HasSubstr("restart()"));
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.start());
  EXPECT_TRUE(session.stop());
}

TEST(SessionEnd, WhatIsReleasedStaysReleasedThroughARestart) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.orbit("finger"));
  ASSERT_TRUE(session.release("finger"));
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.step(2000));
  EXPECT_FALSE(session.reading("finger")->touching);
  EXPECT_TRUE(session.move("finger", {0, 0.01, 0}));
}

TEST(SessionEnd, ARigidToolHasAnOrbitToo) {
  Scene scene;
  scene.add_surface("tissue", sheet());
  scene.add_rigid_body("stylus", box(0.01f), {}, {.position = {0, 0.03, 0}});
  ASSERT_TRUE(scene.add_handle("stylus"));
  Session session = opened(scene);
  ASSERT_TRUE(session.orbit("stylus"));
  EXPECT_TRUE(session.step(100));
}

// Bodies that press a surface feel it with parameters that change, as probes do.
TEST(SessionEnd, AToolFeelsAStiffnessThatChanges) {
  const auto pressed = [](double stiffness) {
    Scene scene;
    scene.add_surface("tissue", sheet(), {.stiffness = 20.0});
    scene.add_rigid_body("stylus", box(0.01f), {}, {.position = {0, 0.02, 0}});
    EXPECT_TRUE(scene.add_handle("stylus", {.translation = {5000.0, 20.0}, .max_force = 50.0}, {.max_force = 50.0}));
    Session session = opened(scene);
    EXPECT_TRUE(session.set("tissue", "stiffness", stiffness));
    for (int i = 0; i < 1500; ++i) {
      EXPECT_TRUE(session.move("stylus", {0, std::max(0.003, 0.02 - 5e-5 * i), 0}));
      EXPECT_TRUE(session.step());
    }
    return session.reading("stylus")->force.y;
  };
  EXPECT_GT(pressed(80.0), 1.5 * pressed(20.0));
}

}  // namespace
}  // namespace pliant
