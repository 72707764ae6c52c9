// Playing a level that is edited, without a window: the same bits as `pliant run`, the authored law, going back.
#include <cmath>

#include "editor/play/law_curve.h"
#include "editor/play/live_edits.h"
#include "tests/editor/play_fixture.h"

namespace pliant::test {
namespace {

TEST_F(PlayTest, LockstepHasTheHashThatAHeadlessRunOfTheSavedLevelHas) {
  for (const char* name : {"minimal.gltf", "three_probes.glb", "stack.glb"}) {
    const fs::path file = bring(name);
    auto document = Document::open(file);
    ASSERT_TRUE(document) << document.error().message();
    Editor editor;
    editor.take(std::move(*document));
    for (const auto& node : editor.state().nodes)
      if (node->node.deformable && node->node.deformable->young == 0.0) {
        const NodeId id = node->id;
        ASSERT_TRUE(
            editor.apply("Stiffer", with_value(editor.state(), std::span(&id, 1), "deformable", "stiffness", 412)));
        break;
      }
    ASSERT_TRUE(editor.document.save());
    const auto run = run_of(editor.state(), file);
    EXPECT_EQ(after(*run, 700).hash, hash_of_run(file, 0.7)) << name;
    EXPECT_NE(after(*run, 1).hash, hash_of_run(file, 0.7)) << name << ": a tick makes no difference";
  }
}

TEST_F(PlayTest, ScriptsStartOverAsInTheWindowOfARun) {
  PlayOptions options;
  options.repeats = true;
  options.sources = {{"tip", script(folder, "0,0,0.01,0\n0.5,0,-0.004,0\n")}};
  const auto run = run_of(pressed_sheet(soft_law()), folder / "level.glb", options);
  EXPECT_NEAR(after(*run, 500).effectors[0].reading.position.y, -0.004, 1e-4);
  // It does not end as it begins: it is followed back.
  EXPECT_NEAR(after(*run, 500).effectors[0].reading.position.y, 0.01, 1e-4);
  EXPECT_NEAR(after(*run, 500).effectors[0].reading.position.y, -0.004, 1e-4);
  EXPECT_TRUE(run->status().effectors[0].reading.touching);
}

TEST_F(PlayTest, StiffnessThatIsTurnedWhileAProbePressesIsFollowedSmoothly) {
  Deformable law;
  law.stiffness = 300;
  law.reach = 0.02;
  PlayOptions options = pressing("0,0,0.01,0\n0.5,0,-0.004,0\n");
  const auto run = run_of(pressed_sheet(law), folder / "level.glb", options);
  std::vector<std::vector<PlaySample>> samples;
  const double before = after(*run, 800).effectors[0].reading.force.y;
  EXPECT_NEAR(before, 300 * 0.004, 0.01 * 1.2);
  run->take_samples(samples);
  std::vector<float> forces;
  const int kSteps = 30;
  for (int i = 1; i <= kSteps; ++i) {  // like a dragged slider: thirty values in half a second
    run->set("sheet", "stiffness", 300 + 10.0 * i);
    after(*run, 16);
    run->take_samples(samples);
    for (const PlaySample& sample : samples.at(0)) forces.push_back(sample.force);
  }
  const double most = 10 * 0.004 * 1.5;  // [N] one value of the slider, and half as much
  for (std::size_t i = 1; i < forces.size(); ++i) {
    EXPECT_LT(std::abs(forces[i] - forces[i - 1]), most) << i;
    EXPECT_GE(forces[i], forces[i - 1] - 1e-4f) << i;
  }
  EXPECT_NEAR(forces.back(), 600 * 0.004, 0.01 * 2.4);
}

TEST_F(PlayTest, GoingBackAndOnAgainHasTheSameBits) {
  const State state = pressed_sheet(soft_law());
  const fs::path file = folder / "level.glb";
  PlayOptions options = pressing("0,0,0.01,0\n0.3,0,-0.004,0\n0.9,0.01,-0.003,0.01\n1.4,0.01,0.01,0\n");
  const auto run = run_of(state, file, options);
  after(*run, 300);
  run->set("sheet", "stiffness", 500);
  const std::string at_400 = after(*run, 100).hash;
  run->set("sheet", "friction_static", 0.9);
  const std::string at_900 = after(*run, 500).hash;
  const std::string at_1500 = after(*run, 600).hash;

  PlayOptions again = options;
  again.past = run->past();
  ASSERT_EQ(again.past->ticks.size(), 1500u);
  again.until = 400;
  const auto back = run_of(state, file, again);
  EXPECT_EQ(back->status().tick, 400u);
  EXPECT_TRUE(back->status().again);
  EXPECT_EQ(back->status().hash, at_400);
  back->go_to(900);
  back->wait();
  EXPECT_EQ(back->status().hash, at_900);
  back->go_on();  // the script has the probe again
  back->pause(true);
  back->wait();
  const std::uint64_t gone = back->status().tick - 900;
  EXPECT_FALSE(back->status().again);
  EXPECT_EQ(after(*back, 600 - gone).hash, at_1500);
  EXPECT_EQ(back->past()->ticks.size(), 1500u);
}

// Which the recording of a replay keeps too: going back twice is going back once.
TEST_F(PlayTest, AProbeThatChangedItsSourceIsHadAgainEvenFromARepeatedPast) {
  const State state = pressed_sheet(soft_law());
  const fs::path file = folder / "level.glb";
  const PlaySource press = script(folder, "0,0,0.01,0\n0.3,0,-0.004,0\n0.9,0.01,-0.003,0.01\n");
  PlayOptions options;
  options.sources = {{"tip", press}};
  const auto run = run_of(state, file, options);
  after(*run, 400);
  run->set_source("tip", {PlaySource::Kind::kNone, {}});
  after(*run, 100);
  PlaySource later = press;
  later.from = 0.5;
  run->set_source("tip", later);
  run->set("sheet", "stiffness", 350);
  const PlayStatus pressed = after(*run, 500);
  EXPECT_TRUE(pressed.effectors[0].reading.touching);
  std::shared_ptr<const PlayPast> past = run->past();
  const std::size_t events = past->events.size();
  EXPECT_GE(events, 3u) << "two sources and a stiffness";
  for (int times = 0; times < 2; ++times) {
    PlayOptions again = options;
    again.past = past;
    again.until = 1000;
    const auto back = run_of(state, file, again);
    EXPECT_EQ(back->status().hash, pressed.hash) << times;
    past = back->past();
    EXPECT_EQ(past->events.size(), events) << times;
  }
}

TEST_F(PlayTest, ASlowPressLiesOnTheCurveOfTheAuthoredLaw) {
  for (const SpringLaw spring : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential}) {
    for (const double young : {0.0, 2e4}) {
      Deformable law;
      law.spring = spring;
      law.reach = 0.02;
      law.young = young;
      const double radius = young > 0 ? 0.005 : 0.0;
      PlayOptions options;
      options.sources = {{"tip", script(folder, "0,0,0.02,0\n0.5,0," + std::to_string(radius) + ",0\n3,0," +
                                                    std::to_string(radius - 0.005) + ",0\n")}};
      const auto run = run_of(pressed_sheet(law, radius), folder / "level.glb", options);
      const PlayStatus status = after(*run, 3000);
      std::vector<std::vector<PlaySample>> samples;
      run->take_samples(samples);
      const LawCurve curve = law_curve(status.surfaces.at("sheet"), radius, 1000, 0.005, 200);
      EXPECT_TRUE(curve.fast.empty());
      const double largest = curve.slow.back().y;
      int compared = 0;
      for (const PlaySample& sample : samples.at(0)) {
        if (!sample.touching || sample.depth <= 0) continue;
        const double at = static_cast<double>(sample.depth) / 0.005 * 200;
        const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), 199);
        const double share = at - static_cast<double>(i),
                     wanted = curve.slow[i].y * (1 - share) + curve.slow[i + 1].y * share;
        EXPECT_NEAR(sample.along, wanted, 0.02 * largest) << sample.depth;
        ++compared;
      }
      EXPECT_GT(compared, 1000);
    }
  }
}

TEST(LiveEdits, SeparateWhatASessionTakesFromWhatWaits) {
  const State before = pressed_sheet({});
  const NodeId sheet = before.find("sheet")->id;
  const auto set = [&](const State& from, const std::string& key, const Json& value) {
    return *with_value(from, std::span(&sheet, 1), "deformable", key, value);
  };
  LiveEdits none = live_edits(before, before);
  EXPECT_TRUE(none.now.empty());
  EXPECT_FALSE(none.later);
  const LiveEdits friction = live_edits(before, set(before, "friction_static", 0.77));
  ASSERT_EQ(friction.now.size(), 1u);
  EXPECT_EQ(friction.now[0].object, "sheet");
  EXPECT_EQ(friction.now[0].key, "friction_static");
  EXPECT_EQ(friction.now[0].value, 0.77);
  EXPECT_FALSE(friction.later);
  const LiveEdits both = live_edits(before, set(set(before, "stiffness", 500), "spring", "cubic"));
  EXPECT_EQ(both.now.size(), 1u);
  EXPECT_TRUE(both.later);
  const LiveEdits gone = live_edits(before, *without(before, std::span(&sheet, 1)));
  EXPECT_TRUE(gone.now.empty());
  EXPECT_TRUE(gone.later);
}

}  // namespace
}  // namespace pliant::test
