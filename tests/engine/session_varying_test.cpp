// A stiffness that rises in time, under a probe and under a rigid body: both clocks read it, in lockstep and in real
// time.
#include "content/level/level.h"
#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

constexpr double kSoft = 200.0, kStiff = 400.0, kDepth = 0.0015, kEdge = 0.005;  // [N/m] [m]
constexpr double kClose = 0.02;  // [1] of the depth, also where clocks are late

// Sinks by gravity into a sheet that is twice as stiff from 0.6 s on, far from where the finger presses.
Scene rising(bool rises) {
  Scene scene("tide");
  scene.simulation().soft_step = 0.005;
  DeformableParameters tissue;
  tissue.stiffness = kSoft;
  tissue.reach = 0.01;
  tissue.contact_damping_material = true;
  scene.add_surface("tissue", sheet(), tissue);
  scene.add_rigid_body("weight", box(static_cast<float>(kEdge)), {.mass = 0.02}, {.position = {-0.02, kEdge, 0}});
  scene.add_probe("finger", {}, {}, {.position = {0.02, 0.005, 0}});
  if (!rises) return scene;
  Level& level = scene.level();
  for (std::size_t n = 0; n < level.nodes.size(); ++n) {
    if (level.nodes[n].name != "tissue") continue;
    level.nodes[n].motion.emplace().repeat = false;
    LevelChannel channel{static_cast<std::int32_t>(n), NodeProperty::kKey, {}, "stiffness"};
    channel.track.times = {0.0, 0.2, 0.6};
    channel.track.length = 0.6;
    for (const double k : {kSoft, kSoft, kStiff}) channel.track.values.emplace_back(k, 0.0, 0.0, 0.0);
    level.animations.push_back({"tide", 0.6, {channel}, -1});
  }
  return scene;
}

double sunk(Session& session) {  // [m]
  std::vector<vec3> vertices;
  EXPECT_TRUE(session.vertices("weight", vertices));
  double sum = 0.0;
  for (const vec3& v : vertices) sum += static_cast<double>(v.y) / static_cast<double>(vertices.size());
  return kEdge - sum;
}

// Down to kDepth within 0.05 s.
dvec3 finger_at(double time) {
  return {0.02, 0.005 - (0.005 + kDepth) * std::min(1.0, time / 0.05), 0};
}

double sunk_at_rest(bool rises) {
  Session session = opened(rising(rises));
  for (int tick = 0; tick < 1500; ++tick) {
    EXPECT_TRUE(session.move("finger", finger_at(0.001 * tick)));
    EXPECT_TRUE(session.step());
  }
  EXPECT_NEAR(session.reading("finger")->force.y, (rises ? kStiff : kSoft) * kDepth, 1e-3);
  return sunk(session);
}

TEST(SessionVarying, ProbesAndBodiesFeelAStiffnessThatRises) {
  const double before = sunk_at_rest(false), after = sunk_at_rest(true);
  EXPECT_GT(before, 1e-5);
  EXPECT_NEAR(after, 0.5 * before, 0.01 * before) << "a linear law sinks as 1/k";
}

// The touch clock writes the surface's parameters, the soft clock its own copy of them.
TEST(SessionVarying, InRealTimeToo) {
  const double expected = 0.5 * sunk_at_rest(false);
  Session session = opened(rising(true));
  ASSERT_TRUE(session.move("finger", finger_at(0.0)));
  ASSERT_TRUE(session.start());
  double force = 0.0, deep = 0.0;
  for (int i = 0; i < 20000; ++i) {
    ASSERT_TRUE(session.move("finger", finger_at(session.time())));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    force = session.reading("finger")->force.y;
    deep = sunk(session);
    (void)session.get("tissue", "stiffness");
    if (session.time() > 0.8 && std::abs(force - kStiff * kDepth) < 1e-3 && std::abs(deep / expected - 1) < kClose)
      break;
  }
  EXPECT_NEAR(force, kStiff * kDepth, 1e-3);
  EXPECT_NEAR(deep, expected, kClose * expected);
  EXPECT_NEAR(session.get("tissue", "stiffness").value(), kStiff, 1e-9);
  ASSERT_TRUE(session.stop());
}

}  // namespace
}  // namespace pliant
