// External forces on a hand and on bodies, and their recordings.
#include <filesystem>

#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

Scene floating() {
  Scene scene("floating");
  scene.simulation().gravity = dvec3(0);
  scene.simulation().soft_step = 0.005;
  scene.add_rigid_body("box", box(0.02f), {.mass = 0.5});
  scene.add_soft_body("liver", box(0.02f), {.young = 2e4, .cell = 0.02}, {.position = {0.2, 0, 0}});
  scene.add_rigid_body("wall", box(0.02f), {.fixed = true}, {.position = {0.4, 0, 0}});
  scene.add_probe("finger", {.radius = 0.004}, {}, {.position = {0, 0.3, 0}});
  return scene;
}

dvec3 middle(Session& session, const std::string& object) {
  std::vector<vec3> vertices;
  EXPECT_TRUE(session.vertices(object, vertices));
  dvec3 sum(0);
  for (const vec3& v : vertices) sum += dvec3(v);
  return sum / static_cast<double>(vertices.size());
}

TEST(SessionForces, AHandFeelsTheProgramsForceThroughTheSafetyLayer) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.move("finger", {0, 0.01, 0}));
  ASSERT_TRUE(session.set_hand_force("finger", {0.5, 0, 0}));
  ASSERT_TRUE(session.step());
  double last = length(session.reading("finger")->force);
  EXPECT_LT(last, 0.01) << "it comes in behind the gate";
  for (int i = 0; i < 700; ++i) {
    ASSERT_TRUE(session.step());
    const double now = length(session.reading("finger")->force);
    EXPECT_LT(now - last, 0.01);
    last = now;
  }
  EXPECT_LT(length(session.reading("finger")->force - dvec3(0.5, 0, 0)), 1e-12);
  ASSERT_TRUE(session.set_hand_force("finger", {0, 50, 0}));
  ASSERT_TRUE(session.step(200));
  EXPECT_NEAR(length(session.reading("finger")->force), *session.get("finger", "max_force"), 1e-9);
  ASSERT_TRUE(session.set_hand_force("finger", dvec3(0)));
  ASSERT_TRUE(session.step(200));
  EXPECT_EQ(session.reading("finger")->force, dvec3(0));
}

TEST(SessionForces, ComeInWhereTheLevelLimitsStiffnessAndAreAddedToWhatIsTouched) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.set("finger", "max_stiffness", 400.0));
  press(session, 0.002);
  const double pressed = session.reading("finger")->force.y;
  ASSERT_TRUE(session.set_hand_force("finger", {0.3, 0, 0}));
  ASSERT_TRUE(session.step(1000));
  const dvec3 force = session.reading("finger")->force;
  EXPECT_NEAR(force.x, 0.3, 1e-9);
  EXPECT_NEAR(force.y, pressed, 0.05 * pressed);
}

TEST(SessionForces, ABodyAcceleratesByNewtonAndTurnsByEuler) {
  Session session = opened(floating());
  ASSERT_TRUE(session.set_body_force("box", {0.5, 0, 0}));
  ASSERT_TRUE(session.step(200));
  const double t = 0.2;
  EXPECT_NEAR(middle(session, "box").x, 0.5 * 1.0 * t * t, 0.05 * 0.02);
  ASSERT_TRUE(session.set_body_force("box", dvec3(0), {0, 1e-4, 0}));
  ASSERT_TRUE(session.step(100));
  std::vector<vec3> vertices;
  ASSERT_TRUE(session.vertices("box", vertices));
  const double inertia = 0.5 * 2.0 * 0.04 * 0.04 / 12.0, angle = 0.5 * 1e-4 / inertia * 0.1 * 0.1;
  const dvec3 edge = dvec3(vertices[1]) - dvec3(vertices[0]);
  EXPECT_NEAR(std::atan2(-edge.z, edge.x), angle, 0.1 * angle);
}

TEST(SessionForces, ASoftBodyTakesForcePointForceAndPush) {
  Session session = opened(floating());
  ASSERT_TRUE(session.set_body_force("liver", {0, 0.064, 0}));  // its mass is 64 g
  ASSERT_TRUE(session.step(200));
  EXPECT_NEAR(middle(session, "liver").y, 0.5 * 0.2 * 0.2, 0.1 * 0.02);
  ASSERT_TRUE(session.set_body_force("liver", dvec3(0)));
  const double before = middle(session, "liver").x;
  ASSERT_TRUE(session.push("liver", {0.0064, 0, 0}));  // 0.1 m/s
  ASSERT_TRUE(session.step(200));
  EXPECT_NEAR(middle(session, "liver").x - before, 0.02, 0.002);
  ASSERT_TRUE(session.set_point_force("liver", 7, {0.2, 0, 0}));
  std::vector<vec3> vertices;
  ASSERT_TRUE(session.vertices("liver", vertices));
  const double wide = double(vertices[7].x - vertices[6].x);
  ASSERT_TRUE(session.step(40));
  ASSERT_TRUE(session.vertices("liver", vertices));
  EXPECT_GT(double(vertices[7].x - vertices[6].x), wide + 1e-4) << "it is drawn out there";
}

TEST(SessionForces, APointForceOffCentreTurnsARigidBody) {
  Session session = opened(floating());
  ASSERT_TRUE(session.set_point_force("box", 7, {0, 0, -0.1}));
  ASSERT_TRUE(session.step(100));
  std::vector<vec3> vertices;
  ASSERT_TRUE(session.vertices("box", vertices));
  EXPECT_GT(std::abs(vertices[1].z - vertices[0].z), 1e-4f);
  EXPECT_LT(middle(session, "box").z, 0.0);
}

TEST(SessionForces, AreRefusedInASentenceWhereNothingCanTakeThem) {
  Session session = opened(floating());
  EXPECT_FALSE(session.set_body_force("wall", {1, 0, 0}));
  EXPECT_FALSE(session.set_body_force("nobody", {1, 0, 0}));
  EXPECT_FALSE(session.set_body_force("box", {std::nan(""), 0, 0}));
  EXPECT_FALSE(session.set_point_force("box", 8, {1, 0, 0}));
  EXPECT_FALSE(session.set_hand_force("thumb", {1, 0, 0}));
  EXPECT_FALSE(session.set_hand_force("finger", dvec3(0), {0, 1, 0}));
  Session surface = opened(press_scene());
  EXPECT_FALSE(surface.set_body_force("tissue", {1, 0, 0}));
}

TEST(SessionForces, StayBeyondARestart) {
  Session session = opened(floating());
  ASSERT_TRUE(session.set_body_force("box", {0.5, 0, 0}));
  ASSERT_TRUE(session.step(100));
  const dvec3 there = middle(session, "box");
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.step(100));
  EXPECT_EQ(middle(session, "box"), there);
}

struct Trace {
  std::vector<dvec3> force, box, liver;
};

// A run that sets, pushes and lets go in its middle.
Trace play(Session& session, bool act) {
  Trace out;
  for (int i = 0; i < 300; ++i) {
    if (act) {
      EXPECT_TRUE(session.move("finger", {0, 0.06 - 1.5e-4 * i, 0}));
      if (i == 20) EXPECT_TRUE(session.set_hand_force("finger", {0.1, 0, 0.2}));
      if (i == 41) EXPECT_TRUE(session.set_body_force("box", {0, 0.03, 0}, {0, 1e-5, 0}));
      if (i == 77) EXPECT_TRUE(session.push("liver", {0, 1e-3, 0}));
      if (i == 120) EXPECT_TRUE(session.set_point_force("liver", 3, {0.05, 0, 0}));
      if (i == 150) EXPECT_TRUE(session.set("finger", "max_force", 0.15));
      if (i == 181) EXPECT_TRUE(session.push_at("box", 2, {0, 0, 1e-3}));
    }
    EXPECT_TRUE(session.step());
    out.force.push_back(session.reading("finger")->force);
    out.box.push_back(middle(session, "box"));
    out.liver.push_back(middle(session, "liver"));
  }
  return out;
}

TEST(SessionForces, AReplayHasTheSameBits) {
  const auto file = std::filesystem::path(testing::TempDir()) / "pliant_forces.rec";
  std::filesystem::remove(file);
  Trace played;
  {
    Session session = opened(floating());
    ASSERT_TRUE(session.record(file));
    played = play(session, true);
    ASSERT_TRUE(session.end_recording());
  }
  Session session = opened(floating());
  const std::vector<std::string> notes = session.notes();
  ASSERT_TRUE(session.replay(file));
  const Trace again = play(session, false);
  EXPECT_EQ(again.force, played.force);
  EXPECT_EQ(again.box, played.box);
  EXPECT_EQ(again.liver, played.liver);
  EXPECT_EQ(session.notes(), notes);
  std::filesystem::remove(file);
}

TEST(SessionForces, InRealTimeArriveAndAreRecorded) {
  const auto file = std::filesystem::path(testing::TempDir()) / "pliant_forces_real.rec";
  std::filesystem::remove(file);
  double felt = 0.0;  // N, the most: a machine too busy to send the hand's place in time takes its force away
  {
    Session session = opened(floating());
    ASSERT_TRUE(session.move("finger", {0, 0.3, 0}));
    ASSERT_TRUE(session.record(file));
    ASSERT_TRUE(session.start());
    ASSERT_TRUE(session.set_hand_force("finger", {0, 0.4, 0}));
    ASSERT_TRUE(session.set_body_force("box", {0.5, 0, 0}));
    EXPECT_TRUE(within_five_seconds([&] {
      (void)session.move("finger", {0, 0.3, 0});
      felt = std::max(felt, session.reading("finger")->force.y);
      return felt > 0.01 && middle(session, "box").x > 0.01;
    })) << felt;
    ASSERT_TRUE(session.stop());
    ASSERT_TRUE(session.end_recording());
  }
  Session session = opened(floating());
  ASSERT_TRUE(session.replay(file));
  double most = 0.0;
  while (session.step()) most = std::max(most, session.reading("finger")->force.y);
  EXPECT_GE(most, felt);
  EXPECT_LE(most, 0.4);
  EXPECT_GT(middle(session, "box").x, 0.005);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace pliant
