// Every tick's readings, as a host takes them.
#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

TEST(SessionReadings, EveryTickOfALockstepRunIsThereOnceAndInOrder) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.keep_readings(64));
  std::vector<Reading> some;
  std::uint64_t next = 0;
  for (double y = 0.0005; y > -0.003; y -= 1e-5) {
    ASSERT_TRUE(session.move("finger", {0, y, 0}));
    ASSERT_TRUE(session.step(7));
    const auto lost = session.take_readings("finger", some);
    ASSERT_TRUE(lost) << lost.error().message();
    EXPECT_EQ(*lost, 0u);
    ASSERT_EQ(some.size(), 7u);
    for (const Reading& reading : some) EXPECT_EQ(reading.tick, next++);
    EXPECT_EQ(some.back().force, session.reading("finger")->force);
  }
  EXPECT_TRUE(some.back().touching);
  EXPECT_NE(some.back().contact[0].triangle, ContactSide::kNone);
}

TEST(SessionReadings, WhatFindsNoRoomIsCounted) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.keep_readings(64));
  ASSERT_TRUE(session.step(100));
  std::vector<Reading> some;
  EXPECT_EQ(*session.take_readings("finger", some), 36u);
  EXPECT_EQ(some.size(), 64u);
  ASSERT_TRUE(session.step(10));
  EXPECT_EQ(*session.take_readings("finger", some), 0u);
  ASSERT_EQ(some.size(), 10u);
  EXPECT_EQ(some.front().tick, 100u);
}

TEST(SessionReadings, AreRefusedInASentence) {
  Session session = opened(press_scene());
  std::vector<Reading> some;
  EXPECT_FALSE(session.take_readings("finger", some));
  EXPECT_FALSE(session.keep_readings(std::size_t{1} << 50));
  ASSERT_TRUE(session.keep_readings(8));
  EXPECT_FALSE(session.take_readings("thumb", some));
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.step(3));
  EXPECT_EQ(*session.take_readings("finger", some), 0u);
  EXPECT_EQ(some.size(), 3u) << "they are kept beyond a restart";
  ASSERT_TRUE(session.keep_readings(0));
  EXPECT_FALSE(session.take_readings("finger", some));
}

TEST(SessionReadings, RealTimeShowsAllTicksToAHostThatLooksTwentyTimesASecond) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.keep_readings(4096));
  ASSERT_TRUE(session.move("finger", {0, 0.01, 0}));
  ASSERT_TRUE(session.start());
  EXPECT_FALSE(session.keep_readings(1)) << "not while the clocks run";
  std::vector<Reading> all, some;
  std::uint64_t lost = 0;
  ASSERT_TRUE(within_five_seconds([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    lost += *session.take_readings("finger", some);
    all.insert(all.end(), some.begin(), some.end());
    return all.size() > 300;
  }));
  ASSERT_TRUE(session.stop());
  lost += *session.take_readings("finger", some);
  all.insert(all.end(), some.begin(), some.end());
  EXPECT_EQ(lost, 0u);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_GT(all[i].tick, all[i - 1].tick);
  if (session.figures().overruns == 0) EXPECT_EQ(all.size(), all.back().tick + 1);
  EXPECT_EQ(all.back().force, dvec3(0)) << "the last force is zero";
}

Scene layered_scene() {
  Scene scene("layered");
  DeformableParameters d{.stiffness = 100.0};
  d.layers = {{.name = "skin", .thickness = 0.01, .stiffness = 400.0, .force = 1.0, .remains = 0.1, .grip = 5.0}};
  scene.add_surface("tissue", sheet(), d);
  scene.add_probe("finger");
  return scene;
}

TEST(SessionEvents, ALayerThatBreaksIsTakenOnce) {
  Session session = opened(layered_scene());
  std::vector<FeltEvent> events;
  press(session, 0.004);
  EXPECT_EQ(session.take_events(events), 0u);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, FeltKind::kBroke);
  EXPECT_EQ(events[0].probe, "finger");
  EXPECT_EQ(events[0].object, "tissue");
  EXPECT_EQ(events[0].layer, "skin");
  EXPECT_NEAR(events[0].value, 1.0, 0.005);
  EXPECT_NEAR(events[0].time, 0.3, 0.002);  // 2.5 mm under 0.5 mm, 10 um a tick
  EXPECT_EQ(events[0].sentence(), "finger broke layer skin of tissue at 0.300 s, 1.00 N");
  EXPECT_EQ(session.take_events(events), 0u);
  EXPECT_TRUE(events.empty());
  ASSERT_TRUE(session.restart());
  press(session, 0.004);
  session.take_events(events);
  EXPECT_EQ(events.size(), 1u) << "it is whole again";
}

// With holes, and dents that stay.
TEST(SessionEvents, ASavedStateComesBackWithItsDamageToTheBit) {
  for (const bool yields : {false, true}) {
    Scene scene = layered_scene();
    if (yields) {
      scene = Scene("plastic");
      scene.add_surface("tissue", sheet(), {.stiffness = 400.0, .yield_force = 0.8, .yield_hardening = 50.0});
      scene.add_probe("finger");
    }
    Session session = opened(scene);
    press(session, 0.004);
    const auto state = session.save_state();
    ASSERT_TRUE(state) << state.error().message();
    const auto go_on = [](Session& it) {
      std::vector<dvec3> forces;
      for (double y = -0.004; y < 0.001; y += 2e-5) {
        EXPECT_TRUE(it.move("finger", {0, y, 0}));
        EXPECT_TRUE(it.step());
        forces.push_back(it.reading("finger")->force);
      }
      for (double y = 0.001; y > -0.006; y -= 2e-5) {
        EXPECT_TRUE(it.move("finger", {0, y, 0}));
        EXPECT_TRUE(it.step());
        forces.push_back(it.reading("finger")->force);
      }
      return forces;
    };
    const std::vector<dvec3> first = go_on(session);
    std::vector<FeltEvent> events;
    session.take_events(events);
    Session other = opened(scene);
    ASSERT_TRUE(other.restore_state(*state));
    other.take_events(events);
    EXPECT_TRUE(events.empty()) << "what is run again is no event";
    EXPECT_EQ(go_on(other), first);
    std::vector<vec3> a, b;
    ASSERT_TRUE(session.vertices("tissue", a));
    ASSERT_TRUE(other.vertices("tissue", b));
    EXPECT_EQ(a, b);
  }
}

}  // namespace
}  // namespace pliant
