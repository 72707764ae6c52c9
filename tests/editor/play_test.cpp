// Playing a level that is edited, without a window: the same bits as `pliant run`, edits that reach it, going back.
#include "editor/play/play.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "content/level_file.h"
#include "editor/play/law_curve.h"
#include "editor/play/live_edits.h"
#include "engine/run/sources.h"
#include "pliant/driver.h"
#include "scenes/scenes.h"
#include "systems/hash_state.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class PlayTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("pliant-play-" + std::to_string(::getpid()) + "-" +
                                          ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder / "levels");
    fs::create_directory_symlink(fs::path(PLIANT_SOURCE_DIR) / "content/environments", folder / "environments");
  }
  void TearDown() override { fs::remove_all(folder); }

  // A shipped level with its scripts, where it may be changed.
  fs::path bring(const std::string& name) const {
    for (const auto& each : fs::directory_iterator(fs::path(PLIANT_SOURCE_DIR) / "content/levels"))
      if (each.path().filename().string().starts_with(name.substr(0, name.find('.'))))
        fs::copy_file(each.path(), folder / "levels" / each.path().filename(), fs::copy_options::overwrite_existing);
    return folder / "levels" / name;
  }
  // The hash that `pliant run` prints for the level on disk.
  std::string hash_of_run(const fs::path& level, double seconds) const {
    const std::string line =
        "cd '" + folder.string() + "' && env -u DISPLAY -u WAYLAND_DISPLAY '" PLIANT_BINARY "' run '" + level.string() +
        "' --lockstep --headless --frames 0 --seconds " + std::to_string(seconds) + " --out out --force >said 2>&1";
    if (std::system(line.c_str()) != 0) {
      std::ifstream said(folder / "said");
      ADD_FAILURE() << std::string(std::istreambuf_iterator<char>(said), {});
      return {};
    }
    return nlohmann::json::parse(std::ifstream(folder / "out" / "report.json"))["hash"];
  }
  fs::path folder;
};

std::unique_ptr<PlayRun> run_of(const State& state, const fs::path& file, PlayOptions options = {}) {
  options.level = [state, file]() -> Result<Level> {
    Level level = level_of(state);
    level.path = file;
    return level;
  };
  options.paused = true;
  auto run = std::make_unique<PlayRun>(std::move(options));
  run->wait();
  EXPECT_EQ(run->status().error, "");
  return run;
}

PlayStatus after(PlayRun& run, std::uint64_t ticks) {
  run.step(ticks);
  run.wait();
  EXPECT_EQ(run.status().error, "");
  return run.status();
}

template <class Condition>
bool comes_true(Condition condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

// A sheet of 10 cm in y = 0 and a probe above its middle, which the script given presses in.
State pressed_sheet(const Deformable& law, double radius = 0.0) {
  Level level;
  level.meshes.push_back({"sheet", {scenes::sheet(24, 0.1)}});
  LevelNode sheet;
  sheet.name = "sheet";
  sheet.mesh = 0;
  sheet.deformable = law;
  LevelNode tip;
  tip.name = "tip";
  tip.local.translation = {0, 0.02f, 0};
  tip.probe.emplace();
  tip.probe->radius = radius;
  tip.device.emplace();
  tip.device->max_force = 10.0;
  tip.device->max_slew = 5000.0;
  tip.probe_device = "tip";
  level.nodes = {sheet, tip};
  NodeId next = 1;
  return state_of(std::move(level), next);
}

PlaySource script(const fs::path& folder, const std::string& rows) {
  const fs::path file = folder / "press.csv";
  std::ofstream(file) << "time_s,x,y,z\n" << rows;
  return {PlaySource::Kind::kScript, file.string()};
}

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
  Deformable law;
  law.reach = 0.02;
  PlayOptions options;
  options.repeats = true;
  options.sources = {{"tip", script(folder, "0,0,0.01,0\n0.5,0,-0.004,0\n")}};
  const auto run = run_of(pressed_sheet(law), folder / "level.glb", options);
  EXPECT_NEAR(after(*run, 500).effectors[0].reading.position.y, -0.004, 1e-4);
  // It does not end as it begins: it is followed back.
  EXPECT_NEAR(after(*run, 500).effectors[0].reading.position.y, 0.01, 1e-4);
  EXPECT_NEAR(after(*run, 500).effectors[0].reading.position.y, -0.004, 1e-4);
  EXPECT_TRUE(run->status().effectors[0].reading.touching);
}

TEST_F(PlayTest, OfTwoProbesOfTheMouseItMovesTheFirstAndTheOtherIsSaid) {
  State state = pressed_sheet({});
  Level level = level_of(state);
  level.nodes[1].device->driver = DriverKind::kMouse;
  LevelNode second = level.nodes[1];
  second.name = second.probe_device = "second";
  second.local.translation = {0.03f, 0.04f, 0};
  level.nodes.push_back(second);
  NodeId next = 1;
  const auto run = run_of(state_of(std::move(level), next), folder / "level.glb");
  const PlayStatus status = after(*run, 200);
  EXPECT_THAT(status.notes, ::testing::Contains(::testing::HasSubstr("the mouse moves `tip`; nothing moves `second`")));
  ASSERT_EQ(status.effectors.size(), 2u);
  EXPECT_TRUE(status.effectors[0].reading.ready);
  EXPECT_FALSE(status.effectors[1].reading.ready);
  EXPECT_GT(length(status.effectors[0].reading.position - status.effectors[1].reading.position), 1e-3);
}

TEST_F(PlayTest, StiffnessThatIsTurnedWhileAProbePressesIsFollowedSmoothly) {
  Deformable law;
  law.stiffness = 300;
  law.reach = 0.02;
  PlayOptions options;
  options.sources = {{"tip", script(folder, "0,0,0.01,0\n0.5,0,-0.004,0\n")}};
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
  Deformable law;
  law.reach = 0.02;
  const State state = pressed_sheet(law);
  const fs::path file = folder / "level.glb";
  PlayOptions options;
  options.sources = {{"tip", script(folder, "0,0,0.01,0\n0.3,0,-0.004,0\n0.9,0.01,-0.003,0.01\n1.4,0.01,0.01,0\n")}};
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
  Deformable law;
  law.reach = 0.02;
  const State state = pressed_sheet(law);
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

// The part of the stage, without a GPU: it prepares a picture while the run stands still, then reads snapshots. Under a
// thread sanitizer this is the seam of the three threads.
TEST_F(PlayTest, APictureIsMadeAndReadWhileTheRunGoesOn) {
  for (const bool waits : {true, false}) {
    Deformable law;
    law.reach = 0.02;
    PlayOptions options;
    options.sources = {{"tip", script(folder, "0,0,0.01,0\n0.1,0,-0.004,0\n0.4,0.01,-0.003,0.01\n")}};
    options.repeats = true;
    options.shown = waits;
    options.speed = 4.0;
    options.level = [state = pressed_sheet(law)]() -> Result<Level> { return level_of(state); };
    auto run = std::make_shared<PlayRun>(std::move(options));
    std::atomic<std::uint64_t> seen{0}, made{0};
    std::thread stage([run, &seen, &made] {
      while (!run->opened()) std::this_thread::yield();
      World* world = nullptr;
      // A whole world, as the renderer reads it.
      ASSERT_TRUE(run->make_picture([&](World& of) {
        world = &of;
        Hash hash;
        hash_state(of, hash);
        made = hash.value();
      }));
      std::uint64_t last = 0;
      while (run->opened()) {
        if (!world->snapshots->acquire()) continue;
        EXPECT_GE(world->snapshots->read().tick, last) << "pictures do not go back";
        last = world->snapshots->read().tick;
        ++seen;
      }
      // The run has ended, and its world is still there for the picture.
      EXPECT_EQ(world->snapshots->read().probes.size(), 1u);
    });
    ASSERT_TRUE(comes_true([&] { return run->status().tick > 800 && seen > 20; })) << run->status().tick;
    EXPECT_NE(made, 0u);
    run->set("sheet", "stiffness", 400);
    run->pause(true);
    run->wait();
    EXPECT_EQ(run->status().phase, PlayPhase::kPaused);
    const std::uint64_t stood = run->status().tick;
    EXPECT_EQ(after(*run, 40).tick, stood + 40);
    EXPECT_EQ(run->past()->ticks.size(), stood + 40);
    run->end();
    stage.join();
    run.reset();
  }
}

TEST_F(PlayTest, TheMouseGetsAProbeOfItsOwnWhereNothingElseIsMovedByIt) {
  for (const bool level_has_one : {false, true}) {
    State state = pressed_sheet({});
    if (level_has_one) {
      DocumentNode tip = *state.find("tip");
      tip.node.device->driver = DriverKind::kMouse;
      state.nodes.back() = std::make_shared<const DocumentNode>(tip);
    }
    PlayOptions options;
    options.mouse_probe = true;
    const PlayStatus status = run_of(state, folder / "level.glb", options)->status();
    ASSERT_EQ(status.effectors.size(), level_has_one ? 1u : 2u);
    EXPECT_EQ(status.effectors.back().source, "mouse");
  }
}

TEST_F(PlayTest, WhatTheMouseDidIsHadAgainToo) {
  Deformable law;
  law.reach = 0.02;
  const State state = pressed_sheet(law);
  PlayOptions options;
  options.sources = {{"tip", {PlaySource::Kind::kMouse, {}}}};
  const auto run = run_of(state, folder / "level.glb", options);
  EXPECT_EQ(run->status().effectors[0].source, "mouse");
  after(*run, 50);
  Picked seen;
  seen.object = Entity();
  seen.rest = seen.point = {0.01, 0, 0.01};
  const ViewRay down{{0.01, 1, 0.01}, {0, -1, 0}};
  // The sheet is the first deformable object: its entity is what picking would return.
  const auto spawned = spawn(level_of(state));
  ASSERT_TRUE(spawned);
  seen.object = find_by_name(*spawned, "sheet");
  run->hand.see(seen, down);
  EXPECT_EQ(run->hand.over(), PlayHand::Over::kTouchable);
  after(*run, 400);
  EXPECT_FALSE(run->status().effectors[0].reading.touching) << "it hovers until it is pressed";
  Picked far = seen;  // a late picture: the mouse is 8 cm away meanwhile
  far.rest = far.point = {-0.045, 0, -0.045};
  run->hand.see(far, {{-0.045, 1, -0.045}, {0, -1, 0}});
  after(*run, 300);
  run->hand.see(seen, down);
  const PlayStatus back = after(*run, 300);
  EXPECT_THAT(back.findings, ::testing::IsEmpty()) << back.findings.front();
  EXPECT_NEAR(back.effectors[0].reading.position.x, 0.01, 1e-4);
  run->hand.hold(true);
  const PlayStatus pressed = after(*run, 1500);
  EXPECT_NEAR(pressed.effectors[0].reading.depth, run->hand.depth_goal(), 0.02 * run->hand.depth_goal());
  EXPECT_GT(pressed.effectors[0].reading.force.y, 0.1);
  run->hand.wheel(3, {});
  const PlayStatus deeper = after(*run, 1500);
  EXPECT_GT(deeper.effectors[0].reading.depth, 1.5 * pressed.effectors[0].reading.depth);
  run->hand.hold(false);
  EXPECT_FALSE(after(*run, 500).effectors[0].reading.touching);

  PlayOptions again = options;
  again.past = run->past();
  again.until = deeper.tick;
  EXPECT_EQ(run_of(state, folder / "level.glb", again)->status().hash, deeper.hash);
}

TEST_F(PlayTest, AToolIsLedByItsScriptUntilTheMouseTakesHoldOfIt) {
  const fs::path file = bring("instrument.glb");
  auto document = Document::open(file);
  ASSERT_TRUE(document) << document.error().message();
  PlayOptions options;
  options.mouse_probe = true;
  const auto run = run_of(document->state(), file, options);
  const PlayStatus led = after(*run, 20);
  std::size_t tool = 0;
  while (tool < led.effectors.size() && !led.effectors[tool].tool) ++tool;
  ASSERT_LT(tool, led.effectors.size());
  for (const PlayEffector& each : led.effectors) EXPECT_NE(each.source, "mouse") << each.name;
  const auto spawned = spawn(level_of(document->state()));
  ASSERT_TRUE(spawned);
  Picked seen;
  seen.object = find_by_name(*spawned, led.effectors[tool].name);
  seen.point = seen.rest = led.effectors[tool].reading.position;
  const Viewpoint view{seen.point + dvec3(0, 0, 1), seen.point};
  run->hand.see(seen, {view.eye, {0, 0, -1}});
  ASSERT_EQ(run->hand.over(), PlayHand::Over::kTool);
  run->hand.hold(true);
  EXPECT_EQ(after(*run, 5).effectors[tool].source, "mouse");
  run->hand.follow({view.eye, normalize(dvec3(0.01, 0, -1))}, view);
  EXPECT_NEAR(after(*run, 100).effectors[tool].reading.position.x, seen.point.x + 0.01, 1e-3);
}

// A device that records the forces written to it.
struct Log {
  std::atomic<int> writes{0}, closed{0};
  std::atomic<double> last{-1.0}, largest{0.0};
  std::atomic<bool> throws{false};
};
class LoggedDevice final : public Driver {
 public:
  explicit LoggedDevice(Log& log) : log_(log) {}
  Status open(const std::string&) override { return Done{}; }
  bool read(DeviceSample& sample) override {
    if (log_.throws) throw std::runtime_error("the cable is out");
    at_ = std::max(-0.004, at_ - 2e-5);
    sample.position = {0, at_, 0};
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    ++log_.writes;
    log_.last = glm::length(wrench.force);
    log_.largest = std::max(log_.largest.load(), log_.last.load());
  }
  void close() override { ++log_.closed; }

 private:
  Log& log_;
  double at_ = 0.01;  // [m]
};
Log& device_log() {
  static Log log;
  static const Status registered =
      register_driver("logged of the editor", [] { return std::make_unique<LoggedDevice>(log); });
  EXPECT_TRUE(registered);
  log.writes = log.closed = 0;
  log.last = -1.0;
  log.largest = 0.0;
  log.throws = false;
  return log;
}

TEST_F(PlayTest, HoweverPlayingEndsADeviceIsWrittenZeroLastAndClosed) {
  for (const bool throws : {false, true}) {
    Log& log = device_log();
    PlayOptions options;
    options.sources = {{"tip", {PlaySource::Kind::kDriver, "logged of the editor"}}};
    options.realtime = true;
    options.level = [state = pressed_sheet({})]() -> Result<Level> { return level_of(state); };
    auto run = std::make_unique<PlayRun>(std::move(options));
    ASSERT_TRUE(comes_true([&] { return log.last > 0.5; })) << "the device never felt anything";
    if (throws) {
      log.throws = true;
      ASSERT_TRUE(comes_true([&] { return run->status().phase == PlayPhase::kEnded; }));
      EXPECT_NE(run->status().error.find("cable"), std::string::npos) << run->status().error;
    }
    run.reset();
    EXPECT_EQ(log.last, 0.0);
    EXPECT_EQ(log.closed, 1);
  }
}

TEST_F(PlayTest, ALevelThatCannotBePlayedSaysWhyOnceAndPlayingIsOver) {
  Editor editor;
  Deformable law;
  law.damping_ratio = 0.0;
  law.settling_time = -1.0;
  ASSERT_TRUE(editor.apply("New", pressed_sheet(law)));
  Play play(editor);
  play.start();
  EXPECT_TRUE(play.on());
  EXPECT_TRUE(editor.playing);
  ASSERT_TRUE(comes_true([&] {
    play.update();
    return !play.on();
  }));
  EXPECT_FALSE(editor.playing);
  ASSERT_FALSE(editor.said.empty());
  EXPECT_EQ(editor.said.back().severity, Severity::kError);
  EXPECT_NE(editor.said.back().text.find("settling_time"), std::string::npos) << editor.said.back().text;
}

TEST_F(PlayTest, EditsReachTheRunAndSurviveItsEndAndTheRestIsSaidOnce) {
  Editor editor;
  ASSERT_TRUE(editor.apply("New", pressed_sheet({})));
  Play play(editor);
  editor.on_change.push_back([&](const State& before, const State& now) { play.changed(before, now); });
  play.mouse_probe = false;
  play.start();
  ASSERT_TRUE(comes_true([&] {
    play.update();
    return play.ready();
  }));
  play.pause(true);
  const NodeId sheet = editor.state().find("sheet")->id, tip = editor.state().find("tip")->id;
  EXPECT_TRUE(
      editor.apply("Stiffer", with_value(editor.state(), std::span(&sheet, 1), "deformable", "stiffness", 777.0)));
  EXPECT_TRUE(
      editor.apply("Weaker", with_value(editor.state(), std::span(&tip, 1), "haptic_device", "max_force", 2.0)));
  ASSERT_TRUE(comes_true([&] {
    play.update();
    return play.status().surfaces.contains("sheet") && play.status().surfaces.at("sheet").stiffness == 777.0;
  }));
  const auto said = [&] {
    return std::count_if(editor.said.begin(), editor.said.end(), [](const Said& each) {
      return each.text.find("at the next Play") != std::string::npos && each.times == 1;
    });
  };
  EXPECT_EQ(said(), 0);
  for (const double budget : {0.011, 0.012, 0.013})
    EXPECT_TRUE(
        editor.apply("Budget", with_value(editor.state(), std::span(&sheet, 1), "deformable", "error", budget)));
  EXPECT_EQ(said(), 1);
  play.stop();
  EXPECT_FALSE(editor.playing);
  EXPECT_EQ(editor.state().find("sheet")->node.deformable->stiffness, 777.0);
  EXPECT_EQ(editor.state().find("sheet")->node.deformable->error, 0.013);
  editor.undo();
  EXPECT_EQ(editor.state().find("sheet")->node.deformable->error, 0.012);
}

TEST_F(PlayTest, ThePlayersPartGoesBackAndOnFromThere) {
  Editor editor;
  ASSERT_TRUE(editor.apply("New", pressed_sheet({})));
  Play play(editor);
  play.mouse_probe = false;
  play.sources["tip"] = script(folder, "0,0,0.01,0\n0.3,0,-0.004,0\n0.9,0.01,-0.003,0.01\n");
  play.start();
  const auto until = [&](auto condition) {
    return comes_true([&] {
      play.update();
      return condition();
    });
  };
  ASSERT_TRUE(until([&] { return play.status().time > 0.6; }));
  play.go_to(0.25);
  ASSERT_TRUE(until([&] { return play.ready() && play.status().again && play.status().tick == 250; }));
  EXPECT_GE(play.latest(), 0.6) << "what comes after is still there to be gone forward to";
  const double latest = play.latest();
  play.go_to(0.5);
  ASSERT_TRUE(until([&] { return play.ready() && play.status().tick == 500; }));
  EXPECT_EQ(play.latest(), latest);
  play.step(10);
  ASSERT_TRUE(until([&] { return play.status().tick == 510 && !play.status().again; }));
  EXPECT_NEAR(play.latest(), 0.509, 2e-3);
  const auto& samples = play.traces().at(0).samples;
  for (std::size_t i = 1; i < samples.size(); ++i) ASSERT_EQ(samples[i].tick, samples[i - 1].tick + 1) << i;
  play.restart();
  ASSERT_TRUE(until([&] { return play.ready(); }));
  EXPECT_FALSE(play.before().empty()) << "the run before is kept to compare with";
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

TEST(LiveEdits, TellWhatASessionTakesFromWhatWaits) {
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
}  // namespace pliant
