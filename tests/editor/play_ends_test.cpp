// A run of the editor and its other threads: pictures, devices, edits while it plays, its end.
#include <atomic>

#include "pliant/driver.h"
#include "systems/hash_state.h"
#include "tests/editor/play_fixture.h"

namespace pliant::test {
namespace {

// The part of the stage, without a GPU: it prepares a picture while the run stands still, then reads snapshots. Under a
// thread sanitizer this is the seam of the three threads.
TEST_F(PlayTest, APictureIsMadeAndReadWhileTheRunGoesOn) {
  for (const bool waits : {true, false}) {
    PlayOptions options;
    options.sources = {{"tip", script(folder, "0,0,0.01,0\n0.1,0,-0.004,0\n0.4,0.01,-0.003,0.01\n")}};
    options.repeats = true;
    options.shown = waits;
    options.speed = 4.0;
    options.level = [state = pressed_sheet(soft_law())]() -> Result<Level> { return level_of(state); };
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

}  // namespace
}  // namespace pliant::test
