// Effects by program: in space, on the probes that they name, and on a surface; changed between ticks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::HasSubstr;

// A magnet of 200 N/m, and two probes in it at the same place.
Scene two_hands(EffectParameters magnet) {
  Scene scene("room");
  scene.add_effect("magnet", magnet);
  scene.add_probe("left");
  scene.add_probe("right");
  return scene;
}

void rest(Session& session, dvec3 place, std::uint64_t ticks = 600) {
  for (const char* probe : {"left", "right"}) ASSERT_TRUE(session.move(probe, place));
  ASSERT_TRUE(session.step(ticks));
}

// k x (1 - q)^2, q = x^2 / R^2, of the well (docs/methods.md 1.13).
double pull(double k, double x, double range = 0.02) {
  const double q = x * x / (range * range);
  return k * x * (1 - q) * (1 - q);
}

TEST(SessionEffect, IsFeltByTheProbesThatItNamesAlone) {
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{}, std::vector<std::string>{"left"}, std::vector<std::string>{"right", "left"}}) {
    Session session = opened(two_hands({.stiffness = 200.0, .probes = names}));
    rest(session, {0.005, 0, 0});
    for (const char* probe : {"left", "right"}) {
      const bool felt = names.empty() || std::find(names.begin(), names.end(), probe) != names.end();
      EXPECT_NEAR(session.reading(probe)->force.x, felt ? -pull(200.0, 0.005) : 0.0, 1e-9) << probe;
    }
  }
}

TEST(SessionEffect, ANameThatIsNoProbeIsOneSentence) {
  const auto session = Session::open(two_hands({.probes = {"lefft"}}));
  ASSERT_FALSE(session);
  EXPECT_THAT(session.error().message(),
              HasSubstr("names 'lefft', which is no node with a PLIANT_probe; did you mean"));
}

TEST(SessionEffect, EventsThatATickHasNoRoomForCountAsLost) {
  Scene scene("comb");
  scene.add_effect("comb", {.kind = EffectKind::kDetents, .region = EffectRegion::kEverywhere});
  constexpr int kProbes = 70;
  const auto name = [](int i) { return "finger " + std::to_string(i); };
  for (int i = 0; i < kProbes; ++i) scene.add_probe(name(i));
  Session session = opened(scene);
  std::vector<FeltEvent> events;
  for (int round = 0; round < 2; ++round) {
    for (const double y : {0.0, EffectParameters().spacing}) {
      for (int i = 0; i < kProbes; ++i) ASSERT_TRUE(session.move(name(i), {0, y, 0}));
      ASSERT_TRUE(session.step());
    }
    EXPECT_EQ(session.take_events(events), 6u);
    EXPECT_EQ(events.size(), 64u);
    const Result<std::vector<Note>> findings = session.findings();
    ASSERT_TRUE(findings);
    EXPECT_TRUE(
        std::any_of(findings->begin(), findings->end(), [](const Note& n) { return n.code == "dropped.events"; }));
    ASSERT_TRUE(session.restart());
  }
}

TEST(SessionEffect, ChangesBetweenTicksAndStaysOverARestart) {
  Session session = opened(two_hands({.stiffness = 200.0}));
  rest(session, {0.005, 0, 0});
  ASSERT_TRUE(session.set("magnet", "stiffness", 300.0));
  ASSERT_TRUE(session.step(600));
  EXPECT_NEAR(session.reading("left")->force.x, -pull(300.0, 0.005), 1e-9);
  EXPECT_EQ(session.get("magnet", "stiffness").value(), 300.0);
  ASSERT_TRUE(session.restart());
  rest(session, {0.005, 0, 0});
  EXPECT_NEAR(session.reading("left")->force.x, -pull(300.0, 0.005), 1e-9);
  const auto refused = [&](const Status& status) { return status ? std::string() : status.error().message(); };
  EXPECT_THAT(refused(session.set("magnet", "kind", std::string("gravity"))), HasSubstr("when the session opens"));
  EXPECT_THAT(refused(session.set("magnet", "damping", 3.0)),
              HasSubstr("not read by an effect of the kind attraction"));
  EXPECT_THAT(refused(session.set("magnet", "stiffness", -3.0)), HasSubstr("must be in the range"));
  EXPECT_THAT(refused(session.set("magnt", "stiffness", 3.0)), HasSubstr("did you mean magnet?"));
}

TEST(SessionEffect, AVectorIsSetAndASavedStateRepeatsIt) {
  Session session = opened(two_hands({.kind = EffectKind::kGravity, .region = EffectRegion::kEverywhere}));
  rest(session, {0, 0, 0});
  ASSERT_TRUE(session.set("magnet", "force", std::vector<double>{0.5, 0.25, 0}));
  ASSERT_TRUE(session.step(600));
  EXPECT_LT(length(session.reading("left")->force - dvec3(0.5, 0.25, 0)), 1e-9);
  const auto state = session.save_state();
  ASSERT_TRUE(state) << state.error().message();
  Session other = opened(two_hands({.kind = EffectKind::kGravity, .region = EffectRegion::kEverywhere}));
  const Status restored = other.restore_state(*state);
  ASSERT_TRUE(restored) << restored.error().message();
  ASSERT_TRUE(session.step(10));
  ASSERT_TRUE(other.step(10));
  EXPECT_EQ(session.reading("left")->force, other.reading("left")->force);
}

TEST(SessionEffect, APathThatGuidesNeedsNoFile) {
  Path rail;
  for (const double x : {-0.1, 0.1}) rail.rows.push_back({0.0, {x, 0, 0}});
  Scene scene = two_hands({});
  scene.add_effect("rail", {.kind = EffectKind::kGuidance, .stiffness = 400.0}, {.position = {0, 0.125, 0}}, rail);
  Session session = opened(scene);
  rest(session, {0.05, 0.129, 0});
  EXPECT_LT(length(session.reading("left")->force - dvec3(0, -pull(400.0, 0.004), 0)), 1e-9);
  scene.add_effect("none", {.kind = EffectKind::kGuidance});
  EXPECT_FALSE(Session::open(scene));
}

// The surface's own effects, given by the program: a rough surface against a smooth one, live.
TEST(SessionEffect, ASurfaceGetsItsTextureWhileItIsStroked) {
  Scene scene("skin");
  scene.add_surface("skin", sheet(), {.stiffness = 300.0, .friction_static = 0.0, .friction_sliding = 0.0});
  scene.add_probe("finger");
  Session session = opened(scene);
  press(session, 0.002);
  const auto ripple = [&] {
    double low = 1e9, high = -1e9;
    for (int i = 0; i <= 200; ++i) {
      EXPECT_TRUE(session.move("finger", {1e-4 * i, -0.002, 0}));
      EXPECT_TRUE(session.step());
      low = std::min(low, session.reading("finger")->force.y);
      high = std::max(high, session.reading("finger")->force.y);
    }
    return high - low;
  };
  EXPECT_LT(ripple(), 1e-6);
  ASSERT_TRUE(session.set("skin", "texture.wavelength", 0.002));
  ASSERT_TRUE(session.set("skin", "texture.amplitude", 1e-4));
  EXPECT_GT(ripple(), 2 * 300.0 * 1e-4 * 0.5);
  const Status refused = session.set("skin", "texture.seed", 1.5);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("must be a whole number"));
}

}  // namespace
}  // namespace pliant
