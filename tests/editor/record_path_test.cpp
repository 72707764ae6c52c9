// A probe's motion in a run becomes the script of its device: accurate, few keys, saved, undone.
#include "editor/play/record_path.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "content/level/script.h"
#include "tests/editor/small_level.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using testing::id_of;
using testing::OwnFolder;

constexpr double kRate = 1000.0, kRest = 0.5, kMoves = 3.0;  // [Hz], [s] before and after, [s] between

// A press that slides and trembles, over a sheet in y = 0.
dvec3 hand(double time) {
  const double t = std::clamp(time - kRest, 0.0, kMoves), s = t / kMoves;
  return {0.03 + 0.04 * s * s * (3 - 2 * s), 0.02 - 0.024 * std::sin(3.14159265358979 * s),
          0.05 + 0.002 * std::sin(9 * s) * s * (1 - s)};
}

PlayPast hand_past() {
  PlayPast past;
  for (std::uint64_t t = 0; t < static_cast<std::uint64_t>((2 * kRest + kMoves) * kRate); ++t) {
    past.ticks.push_back(t);
    past.poses.push_back({dvec3(9), {1, 0, 0, 0}, true});  // another probe's
    past.poses.push_back({hand(static_cast<double>(t) / kRate), {1, 0, 0, 0}, true});
  }
  return past;
}

TEST(RecordPath, KeysAreFewAndNoFartherFromTheRunThanTheyAreSaidToBe) {
  const PlayPast past = hand_past();
  std::size_t before = 1000000;
  for (const double tolerance : {5e-5, 2e-4, 1e-3}) {
    const auto path = path_of_past(past, 1, 2, kRate, tolerance);
    ASSERT_TRUE(path.ok()) << path.error().message();
    EXPECT_LT(path->keys.keys.size(), 60u);
    EXPECT_LE(path->keys.keys.size(), before) << "a coarser curve has no more keys";
    before = path->keys.keys.size();
    EXPECT_LE(path->error, tolerance + 1e-6);
    double worst = 0;
    for (double t = path->begin; t < path->begin + path->keys.keys.back().time; t += 1e-3)
      worst = std::max(worst, length(position_at(path->keys, t - path->begin) - hand(t)));
    EXPECT_LE(worst, path->error + 1e-5) << "what is said is what is true";
    EXPECT_EQ(path->keys.keys.front().time, 0.0);
    EXPECT_NEAR(path->begin, kRest, 0.3) << "the rest before it sets out is left out";
    EXPECT_NEAR(path->keys.keys.back().time, kMoves, 0.5);
  }
  EXPECT_GT(path_of_past(past, 1, 2, kRate, 5e-5)->keys.keys.size(), before);
}

TEST(RecordPath, AJumpFromOneTickToTheNextIsKept) {
  PlayPast past;
  for (std::uint64_t t = 0; t < 1000; ++t) {
    past.ticks.push_back(t);
    const double y = t < 300 ? 0.02 : t < 303 ? 0.05 : 0.01 - 1e-5 * static_cast<double>(t - 303);
    past.poses.push_back({{0, y, 0}, {1, 0, 0, 0}, true});
  }
  const auto path = path_of_past(past, 0, 1, kRate, 1e-4);
  ASSERT_TRUE(path.ok());
  EXPECT_LE(path->error, 2e-4);
  EXPECT_LT(path->keys.keys.size(), 12u);
}

TEST(RecordPath, AProbeThatDidNotMoveHasNoPath) {
  EXPECT_FALSE(path_of_past(hand_past(), 0, 2, kRate, 2e-4).ok());
  EXPECT_FALSE(path_of_past({}, 0, 1, kRate, 2e-4).ok());
}

TEST(RecordPath, KeysHaveTheirHeightOverTheSurfaceAndStayWhereTheyAre) {
  const auto surface = PaintSurface::make({"sheet", {testing::quad_sheet(20)}}, dmat3(1));
  ASSERT_TRUE(surface.ok());
  const PathSurface ground{std::make_shared<const PaintSurface>(*surface), dvec3(0, 0.001, 0)};
  const PlayPast past = hand_past();
  const auto free = path_of_past(past, 1, 2, kRate, 2e-4), over = path_of_past(past, 1, 2, kRate, 2e-4, {ground});
  ASSERT_TRUE(free.ok() && over.ok());
  ASSERT_EQ(free->keys.keys.size(), over->keys.keys.size());
  double deepest = 0;
  for (std::size_t i = 0; i < over->keys.keys.size(); ++i) {
    const PathKey& key = over->keys.keys[i];
    EXPECT_LT(length(key.position() - free->keys.keys[i].position()), 1e-12);
    EXPECT_NEAR(key.height, key.position().y - 0.001, 1e-8);
    EXPECT_NEAR(key.normal.y, 1.0, 1e-6) << "outward, below the surface, too";
    deepest = std::min(deepest, key.height);
  }
  EXPECT_LT(deepest, -0.004);
}

class RecordPathOfRun : public ::testing::Test {
 protected:
  void open(const Level& level) {
    ASSERT_TRUE(save_level(level, file).ok());
    Result<Document> document = Document::open(file);
    ASSERT_TRUE(document.ok()) << document.error().message();
    editor.take(*std::move(document));
    editor.on_change.push_back([this](const State& before, const State& now) { play.changed(before, now); });
    play.mouse_probe = false;
  }
  template <class Condition>
  bool until(Condition condition) {
    for (int i = 0; i < 20000; ++i) {
      play.update();
      editor.jobs.deliver(editor);
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  PlaySource script() const {
    const fs::path at = folder.path / "given.csv";
    std::ofstream(at)
        << "time_s,x,y,z\n0,0.05,0.02,0.05\n0.2,0.05,-0.003,0.05\n0.5,0.06,-0.002,0.05\n0.6,0.06,0.02,0.05\n";
    return {PlaySource::Kind::kScript, at.string()};
  }
  void play_it() {
    play.sources["finger"] = script();
    play.start();
    ASSERT_TRUE(until([&] { return play.ready() && play.status().time > 0.7; }));
  }
  bool recorded() {
    const std::uint64_t before = editor.document.revision();
    return until([&] { return editor.document.revision() != before; });
  }
  OwnFolder folder{"record_path"};
  const fs::path file = folder.path / "small.glb";
  Editor editor;
  Play play{editor};
};

TEST_F(RecordPathOfRun, IsTheScriptOfItsDeviceAfterStopSavedWithTheLevelAndUndone) {
  open(testing::sheet_and_finger());
  record_path(editor, play, "finger", 2e-4);
  EXPECT_NE(editor.said.back().text.find("press Play"), std::string::npos) << editor.said.back().text;
  // An unrelated file with the name that the script would get.
  std::ofstream(folder.path / "small_finger.csv") << "not mine";
  play_it();
  play.stop();
  ASSERT_TRUE(until([&] { return play.past() != nullptr; })) << "what was done is there when the run has ended";
  record_path(editor, play, "finger", 2e-4);
  ASSERT_TRUE(recorded());
  EXPECT_NE(editor.said.back().text.find("mm from the run"), std::string::npos) << editor.said.back().text;
  const HapticDevice& device = *editor.state().find("finger")->node.device;
  EXPECT_EQ(device.driver, DriverKind::kScript);
  EXPECT_EQ(device.file, "small_finger_2.csv");
  const ScriptKeys keys = *editor.state().scripts.at(device.file);
  EXPECT_GE(keys.keys.size(), 4u);
  EXPECT_FALSE(play.sources.contains("finger")) << "the next Play follows the path";
  ASSERT_TRUE(editor.document.save().ok());
  const Result<Document> again = Document::open(file);
  ASSERT_TRUE(again.ok());
  ASSERT_TRUE(again->state().scripts.contains("small_finger_2.csv"));
  EXPECT_EQ(*again->state().scripts.at("small_finger_2.csv"), keys);
  const Result<Path> rows = load_script(folder.path / "small_finger_2.csv"), given = load_script(script().what);
  ASSERT_TRUE(rows.ok() && given.ok());
  double deepest = 1;
  for (const PathRow& row : rows->rows) deepest = std::min(deepest, row.position.y);
  EXPECT_NEAR(deepest, -0.003, 2e-4);
  std::ifstream other(folder.path / "small_finger.csv");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(other), {}), "not mine");
  editor.undo();
  EXPECT_EQ(editor.state().find("finger")->node.device->driver, DriverKind::kMouse);
  EXPECT_TRUE(editor.state().scripts.empty());
}

TEST_F(RecordPathOfRun, OfAProbeThatTheLevelDoesNotHaveMakesOneOfTheSameSize) {
  Level level = testing::sheet_and_finger();
  level.nodes.pop_back();
  open(level);
  play.mouse_probe = true;
  play.start();
  ASSERT_TRUE(until([&] { return play.ready() && !play.status().effectors.empty(); }));
  play.set_source("mouse", script());  // emulates a hand
  const double from = play.status().time;
  ASSERT_TRUE(until([&] { return play.status().time > from + 0.7; }));
  const double radius = play.status().effectors.at(0).radius;
  play.pause(true);
  record_path(editor, play, "mouse", 2e-4);
  ASSERT_TRUE(recorded());
  const DocumentNode* const probe = editor.state().find("probe");
  ASSERT_TRUE(probe && probe->node.probe && probe->node.device);
  EXPECT_EQ(probe->node.probe->radius, radius);
  EXPECT_EQ(probe->node.probe_device, "probe");
  EXPECT_EQ(editor.active(), probe->id);
  EXPECT_EQ(editor.state().scripts.count(probe->node.device->file), 1u);
  play.stop();
  editor.undo();
  EXPECT_FALSE(editor.state().find("probe"));
}

TEST_F(RecordPathOfRun, OfAnotherDocumentIsForgotten) {
  open(testing::sheet_and_finger());
  play_it();
  play.stop();
  ASSERT_TRUE(play.has_past());
  Result<Document> other = Document::open(file);
  ASSERT_TRUE(other.ok());
  editor.take(*std::move(other));
  EXPECT_FALSE(play.has_past());
}

}  // namespace
}  // namespace pliant
