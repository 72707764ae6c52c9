// Saved and restored states, and objects that are removed and added between ticks.
#include <filesystem>

#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

Scene table() {
  Scene scene("table");
  scene.simulation().soft_step = 0.005;
  scene.add_rigid_body("floor", sheet(0.2, 8), {.fixed = true});
  scene.add_soft_body("liver", box(0.02f), {.young = 2e4, .rayleigh = {2.0, 0.002}, .cell = 0.02},
                      {.position = {0, 0.021, 0}});
  scene.add_rigid_body("box", box(0.02f), {}, {.position = {0.1, 0.021, 0}});
  scene.add_probe("finger", {.radius = 0.005}, {}, {.position = {0, 0.06, 0}});
  return scene;
}

struct StateFelt {
  std::vector<dvec3> force;
  std::vector<vec3> vertices;  // of all objects, in every tick
  bool operator==(const StateFelt&) const = default;
};

// From tick `first` on: into the tissue, along it and out, by steps that no other run of it repeats.
StateFelt play(Session& session, int first, int ticks, double height) {
  StateFelt out;
  std::vector<vec3> some;
  for (int i = first; i < first + ticks; ++i) {
    EXPECT_TRUE(session.move("finger", {1e-3 * std::sin(0.05 * i), height - 0.006 * std::sin(0.02 * i), 0}));
    if (i % 90 == 40 && session.objects().size() > 1) EXPECT_TRUE(session.push("box", {0, 1e-3, 1e-3}));
    if (i % 110 == 60) EXPECT_TRUE(session.set_hand_force("finger", {0.05 * (i % 3), 0, 0}));
    EXPECT_TRUE(session.step());
    out.force.push_back(session.reading("finger")->force);
    for (const std::string& object : session.objects()) {
      EXPECT_TRUE(session.vertices(object, some));
      out.vertices.insert(out.vertices.end(), some.begin(), some.end());
    }
  }
  return out;
}

TEST(SessionState, GoesOnWithTheSameBitsOnASurface) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.set("tissue", "stiffness", 250.0));
  play(session, 0, 170, 0.002);
  ASSERT_TRUE(session.set("tissue", "damping_ratio", 0.3));
  const auto state = session.save_state();
  ASSERT_TRUE(state) << state.error().message();
  const StateFelt once = play(session, 170, 200, 0.002);
  double most = 0.0;
  for (const dvec3& force : once.force) most = std::max(most, length(force));
  EXPECT_GT(most, 0.2) << "something is felt";
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(session.restore_state(*state));
    EXPECT_EQ(session.time(), 0.17);
    EXPECT_EQ(*session.get("tissue", "stiffness"), 250.0);
    EXPECT_TRUE(play(session, 170, 200, 0.002) == once);
  }
}

TEST(SessionState, GoesOnWithTheSameBitsAmongBodiesAndInAnotherSession) {
  Session session = opened(table());
  play(session, 0, 123, 0.046);
  const auto state = session.save_state();
  ASSERT_TRUE(state) << state.error().message();
  const StateFelt once = play(session, 123, 100, 0.046);
  ASSERT_TRUE(session.restore_state(*state));
  EXPECT_TRUE(play(session, 123, 100, 0.046) == once);
  Session other = opened(table());
  ASSERT_TRUE(other.restore_state(*state));
  EXPECT_TRUE(play(other, 123, 100, 0.046) == once);
  const auto later = other.save_state();
  ASSERT_TRUE(later);
  EXPECT_EQ(*later, *session.save_state()) << "the same state has the same bytes";
}

// The level's own source has not begun: poses go on as if they had been given from time 0.
TEST(SessionState, HasTheGripsOfItsDevices) {
  Scene scene("jaw");
  scene.add_rigid_body("arm", box(0.02f), {.mass = 0.1}, {.position = {0.05, 0, 0}});
  scene.add_probe("finger", {}, {}, {.position = {0, 0.5, 0}});
  scene.add_joint(
      "hinge",
      {.kind = JointKind::kHinge, .a = "arm", .stiffness = 5.0, .damping = 0.05, .closed = 1.0, .grip = "finger"});
  Session session = opened(scene);
  Path path;
  path.rows = {{.time = 0.0, .position = {0, 0.5, 0}}, {.time = 0.3, .position = {0, 0.5, 0}, .grip = 1.0}};
  path.grips = true;
  ASSERT_TRUE(session.follow("finger", path));
  ASSERT_TRUE(session.step(200));
  const auto state = session.save_state();
  ASSERT_TRUE(state) << state.error().message();
  std::vector<vec3> once, again;
  ASSERT_TRUE(session.step(200));
  ASSERT_TRUE(session.vertices("arm", once));
  EXPECT_GT(std::abs(once[0].z + 0.02f), 0.01f) << "it has closed";
  ASSERT_TRUE(session.restore_state(*state));
  ASSERT_TRUE(session.step(200));
  ASSERT_TRUE(session.vertices("arm", again));
  EXPECT_EQ(once, again);
}

TEST(SessionState, GoesOnInASessionWhoseProbeStillHasTheLevelsSource) {
  Scene scene = press_scene();
  for (LevelNode& node : scene.level().nodes)
    if (node.device) node.device->driver = DriverKind::kOrbit;
  Session session = opened(scene), other = opened(scene);
  play(session, 0, 100, 0.002);
  const auto state = session.save_state();
  ASSERT_TRUE(state) << state.error().message();
  ASSERT_GT(length(session.reading("finger")->force), 0.2) << "it is restored in contact";
  const StateFelt once = play(session, 100, 100, 0.002);
  ASSERT_TRUE(other.restore_state(*state));
  EXPECT_EQ(*other.save_state(), *state);
  EXPECT_TRUE(play(other, 100, 100, 0.002) == once);
}

TEST(SessionState, WithoutAnotherPoseTheLastOneHoldsAndPathsGoOn) {
  for (const bool path : {false, true}) {
    Session session = opened(press_scene());
    if (path)
      ASSERT_TRUE(session.orbit("finger"));
    else
      press(session, 0.003);
    ASSERT_TRUE(session.step(200));
    const auto state = session.save_state();
    ASSERT_TRUE(session.step(150));
    const dvec3 force = session.reading("finger")->force, position = session.reading("finger")->position;
    ASSERT_TRUE(session.restore_state(*state));
    ASSERT_TRUE(session.step(150));
    EXPECT_EQ(session.reading("finger")->force, force) << path;
    EXPECT_EQ(session.reading("finger")->position, position) << path;
  }
}

TEST(SessionState, ADeviceComesBackThroughItsGate) {
  Log log;
  Session session = opened(press_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  ASSERT_TRUE(session.step(5));
  lower(session, log, -0.002);
  ASSERT_GT(log.last.load(), 0.1);
  const auto state = session.save_state();
  ASSERT_TRUE(state);
  const int writes = log.writes;
  ASSERT_TRUE(session.restore_state(*state));
  EXPECT_LE(log.writes, writes + 3) << "what is run again is not written";
  EXPECT_EQ(log.opened, 1);
  EXPECT_EQ(log.last.load(), 0.0);
  ASSERT_TRUE(session.step(300));
  EXPECT_EQ(log.last.load(), 0.0) << "it is still inside";
  log.height = 0.002;
  ASSERT_TRUE(session.step(20));
  lower(session, log, -0.001);
  EXPECT_GT(log.last.load(), 0.1);
}

TEST(SessionState, BytesThatAreNoStateAreRefusedAndChangeNothing) {
  Session session = opened(press_scene());
  play(session, 0, 60, 0.002);
  const auto state = session.save_state();
  ASSERT_TRUE(state);
  const dvec3 before = session.reading("finger")->force;
  for (std::size_t size = 0; size < state->size(); size += 7)
    EXPECT_FALSE(session.restore_state({state->begin(), state->begin() + static_cast<std::ptrdiff_t>(size)}));
  for (std::size_t i = 0; i < state->size(); i += 5) {
    auto damaged = *state;
    damaged[i] ^= 0x10;
    EXPECT_FALSE(session.restore_state(damaged)) << i;
  }
  Session other = opened(table());
  const auto refused = other.restore_state(*state);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("another scene"), std::string::npos);
  EXPECT_EQ(session.reading("finger")->force, before);
  ASSERT_TRUE(session.step());
}

TEST(SessionState, SaysWhereNoneCanBeSaved) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.move("finger", {0, 0.01, 0}));
  ASSERT_TRUE(session.start());
  EXPECT_FALSE(session.save_state());
  ASSERT_TRUE(session.stop());
  const auto state = session.save_state();
  ASSERT_FALSE(state);
  EXPECT_NE(state.error().message().find("real time"), std::string::npos) << state.error().message();
  ASSERT_TRUE(session.restart());
  EXPECT_TRUE(session.save_state());
}

TEST(SessionObjects, WhatIsTakenOutIsFeltNoMoreAndComesBack) {
  Session session = opened(press_scene());
  press(session, 0.003);
  EXPECT_GT(length(session.reading("finger")->force), 0.5);
  ASSERT_TRUE(session.take_out("tissue"));
  EXPECT_TRUE(*session.is_out("tissue"));
  ASSERT_TRUE(session.step(50));
  EXPECT_EQ(session.reading("finger")->force, dvec3(0));
  EXPECT_FALSE(session.reading("finger")->touching);
  EXPECT_FALSE(session.ray({0, 1, 0}, {0, -1, 0})->found());
  ASSERT_TRUE(session.move("finger", {0, 0.002, 0}));
  ASSERT_TRUE(session.put_back("tissue"));
  ASSERT_TRUE(session.step(300));
  press(session, 0.003);
  EXPECT_NEAR(length(session.reading("finger")->force), 0.9, 0.01);
  EXPECT_FALSE(session.take_out("nobody"));
}

TEST(SessionObjects, ABodyFallsThroughWhatIsTakenOut) {
  Session session = opened(table());
  ASSERT_TRUE(session.step(300));
  std::vector<vec3> vertices;
  ASSERT_TRUE(session.vertices("box", vertices));
  EXPECT_GT(vertices[0].y, -0.001f);
  ASSERT_TRUE(session.take_out("floor"));
  ASSERT_TRUE(session.step(200));
  ASSERT_TRUE(session.vertices("box", vertices));
  EXPECT_LT(vertices[0].y, -0.1f);
  ASSERT_TRUE(session.put_back("floor"));
  ASSERT_TRUE(session.place("box", {0.1, 0.05, 0}));
  ASSERT_TRUE(session.place("liver", {0, 0.05, 0}));
  ASSERT_TRUE(session.step(600));
  for (const char* name : {"box", "liver"}) {
    ASSERT_TRUE(session.vertices(name, vertices));
    for (const vec3& v : vertices) {
      EXPECT_GT(v.y, -0.002f) << name;
      EXPECT_LT(v.y, 0.06f) << name;
    }
  }
}

TEST(SessionObjects, ASurfaceIsFeltWhereItIsPlaced) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.move("finger", {0, 0.11, 0}));
  ASSERT_TRUE(session.step(10));
  ASSERT_TRUE(session.place("tissue", {0, 0.1, 0}));
  for (int i = 0; i <= 1200; ++i) {
    ASSERT_TRUE(session.move("finger", {0, 0.11 - 1e-5 * i, 0}));
    ASSERT_TRUE(session.step());
  }
  EXPECT_NEAR(session.reading("finger")->force.y, 0.6, 0.01);
  EXPECT_NEAR(session.ray({0.04, 1, 0}, {0, -1, 0})->position.y, 0.1, 1e-6);
  EXPECT_FALSE(session.place("tissue", {0, 0, 0}, {1, 1, 0, 0}));
}

TEST(SessionObjects, AProbeFeelsTheSameBitsWhileOthersComeAndGo) {
  const auto scene = [] {
    Scene made = press_scene();
    made.add_surface("other", sheet(0.05, 20), {.stiffness = 500.0}, {.position = {0.3, 0, 0}});
    return made;
  };
  Session one = opened(scene()), two = opened(scene());
  press(one, 0.003);
  press(two, 0.003);
  Scene more("more");
  more.add_surface("third", sheet(0.03, 10), {.stiffness = 100.0}, {.position = {-0.3, 0, 0}});
  for (int i = 0; i < 400; ++i) {
    if (i == 50) ASSERT_TRUE(two.take_out("other"));
    if (i == 150) ASSERT_TRUE(two.put_back("other"));
    if (i == 200) {
      const auto added = two.add(more);
      ASSERT_TRUE(added) << added.error().message();
      EXPECT_EQ(two.objects().size(), 3u);
      EXPECT_FALSE(*two.is_out("third"));
    }
    for (Session* session : {&one, &two}) {
      ASSERT_TRUE(session->move("finger", {0, -0.003 - 1e-6 * i, 0}));
      ASSERT_TRUE(session->step());
    }
    ASSERT_EQ(two.reading("finger")->force, one.reading("finger")->force) << i;
  }
  const auto hit = two.ray({-0.3, 1, 0}, {0, -1, 0});
  ASSERT_TRUE(hit && hit->found());
  EXPECT_EQ(two.objects()[hit->object], "third");
}

TEST(SessionObjects, WhatCannotBeAddedIsSaidAndChangesNothing) {
  Session session = opened(press_scene());
  press(session, 0.002);
  const dvec3 force = session.reading("finger")->force;
  Scene same = press_scene(), empty("empty"), taken("taken");
  taken.add_surface("tissue", sheet(0.03, 10));
  EXPECT_FALSE(session.add(same));
  EXPECT_FALSE(session.add(empty));
  EXPECT_FALSE(session.add(taken));
  ASSERT_TRUE(session.step());
  EXPECT_NEAR(length(session.reading("finger")->force - force), 0.0, 1e-3);
}

TEST(SessionObjects, ARecordingHoldsWhatCameAndWent) {
  const auto file = std::filesystem::path(testing::TempDir()) / "pliant_objects.rec";
  std::filesystem::remove(file);
  const auto act = [](Session& session, bool acts) {
    std::vector<vec3> seen, some;
    for (int i = 0; i < 250; ++i) {
      if (acts) {
        EXPECT_TRUE(session.move("finger", {0, 0.06 - 1e-4 * i, 0}));
        if (i == 60) EXPECT_TRUE(session.take_out("floor"));
        if (i == 90) EXPECT_TRUE(session.put_back("floor"));
        if (i == 130) EXPECT_TRUE(session.place("box", {0.1, 0.04, 0}));
      }
      EXPECT_TRUE(session.step());
      EXPECT_TRUE(session.vertices("box", some));
      seen.insert(seen.end(), some.begin(), some.end());
    }
    return seen;
  };
  std::vector<vec3> seen;
  {
    Session session = opened(table());
    ASSERT_TRUE(session.record(file));
    seen = act(session, true);
    ASSERT_TRUE(session.end_recording());
  }
  Session session = opened(table());
  ASSERT_TRUE(session.replay(file));
  EXPECT_TRUE(act(session, false) == seen);
  std::filesystem::remove(file);
}

TEST(SessionObjects, ComeAndGoInRealTimeWhileAProbePresses) {
  Scene scene = press_scene();
  scene.add_surface("other", sheet(0.05, 20), {}, {.position = {0.3, 0, 0}});
  Session session = opened(scene);
  ASSERT_TRUE(session.keep_readings(8192));
  ASSERT_TRUE(session.move("finger", {0, 0.002, 0}));
  ASSERT_TRUE(session.start());
  EXPECT_FALSE(session.add(press_scene()));
  double height = 0.002;
  ASSERT_TRUE(within_five_seconds([&] {
    height = std::max(-0.002, height - 2e-5);
    (void)session.move("finger", {0, height, 0});
    return session.reading("finger")->force.y > 0.55;
  }));
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(i % 2 ? session.put_back("other") : session.take_out("other"));
    ASSERT_TRUE(session.move("finger", {0, -0.002, 0}));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_GT(session.reading("finger")->force.y, 0.55);
  ASSERT_TRUE(session.take_out("tissue"));
  EXPECT_TRUE(within_five_seconds([&] {
    (void)session.move("finger", {0, -0.002, 0});
    return session.reading("finger")->force == dvec3(0);
  }));
  ASSERT_TRUE(session.stop());
}

}  // namespace
}  // namespace pliant
