// Recordings of `pliant run` and their replays; runs in real time and their end.
#include "tests/player/plate_run.h"

namespace pliant::testing {
namespace {

TEST_F(Run, AReplayHasTheSettingsAndTheUnitOfItsRecording) {
  const Said recorded =
      pliant({"run", "plate.obj", "--probe", "p=orbit", "--unit", "0.5", "--set", "*.deformable.stiffness=777",
              "--record", "p.rec", "--seconds", "1.5", "--frames", "0", "--out", "first"});
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  EXPECT_GT(report("first")["probes"][0]["contact_ticks"], 0);
  const Said replayed = pliant({"run", "plate.obj", "--replay", "p.rec", "--frames", "0", "--out", "again"});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_EQ(report("again")["hash"], report("first")["hash"]);
  EXPECT_NE(replayed.err.find("--unit 0.5"), std::string::npos) << replayed.err;
  EXPECT_EQ(replayed.err.find("forces will differ"), std::string::npos) << replayed.err;
  const Said other = pliant({"run", "plate.obj", "--replay", "p.rec", "--set", "*.deformable.stiffness=300", "--frames",
                             "0", "--out", "other"});
  EXPECT_NE(other.err.find("forces will differ"), std::string::npos) << other.err;
  const Said longer =
      pliant({"run", "plate.obj", "--replay", "p.rec", "--seconds", "9", "--frames", "0", "--out", "longer"});
  EXPECT_NE(longer.err.find("ends after 1500 ticks"), std::string::npos) << longer.err;
}

TEST_F(Run, AReplayHasTheErrorBudgetOfItsRecording) {
  // At its default a budget would choose another shape and reach.
  const std::vector<std::string> run{"run",   "plate.obj", "--probe", "p=orbit",  "--error", "0.9",   "--record",
                                     "p.rec", "--seconds", "1.5",     "--frames", "0",       "--out", "first"};
  const Said recorded = pliant(run);
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  EXPECT_GT(report("first")["probes"][0]["contact_ticks"], 0);
  const Said replayed = pliant({"run", "plate.obj", "--replay", "p.rec", "--frames", "0", "--out", "again"});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_EQ(report("again")["hash"], report("first")["hash"]);
  EXPECT_NE(replayed.err.find("the recording's error budget holds: --error=0.9"), std::string::npos) << replayed.err;
  EXPECT_EQ(replayed.err.find("forces will differ"), std::string::npos) << replayed.err;
  // The replay's own value overrides it, and a recording of the replay stores that value.
  const Said other = pliant({"run", "plate.obj", "--replay", "p.rec", "--error", "1e-6", "--record", "q.rec",
                             "--frames", "0", "--out", "other"});
  ASSERT_EQ(other.status, 0) << other.err;
  EXPECT_NE(other.err.find("forces will differ"), std::string::npos) << other.err;
  EXPECT_NE(report("other")["hash"], report("first")["hash"]);
  const Said third = pliant({"run", "plate.obj", "--replay", "q.rec", "--frames", "0", "--out", "third"});
  ASSERT_EQ(third.status, 0) << third.err;
  EXPECT_EQ(report("third")["hash"], report("other")["hash"]);
}

// Mesh, hierarchy and animations are part of a recording's scene hash, as keys are.
TEST_F(Run, AReplayOnALevelThatIsNotAsItWasSaysSo) {
  for (const char* name : {"minimal.gltf", "minimal.bin", "minimal.csv"})
    fs::copy(fs::path(PLIANT_SOURCE_DIR) / "content" / "levels" / name, folder / name);
  ASSERT_EQ(pliant({"run", "minimal.gltf", "--record", "p.rec", "--seconds", "0.2", "--frames", "0"}).status, 0);
  const auto said = [&] {
    const Said replayed = pliant({"run", "minimal.gltf", "--replay", "p.rec", "--frames", "0", "--force"});
    EXPECT_EQ(replayed.status, 0) << replayed.err;
    return replayed.err.find("the level is not as it was") != std::string::npos;
  };
  EXPECT_FALSE(said());
  write_text(folder / "minimal.csv", "time_s,x,y,z\n0,0,0.02,0\n");
  EXPECT_FALSE(said()) << "the probe's script, whose poses were recorded";
  std::string other = read_text(folder / "minimal.gltf");
  other.replace(other.find("\"nodes\": [0, 1]"), 15, "\"nodes\": [0, 1, 2]");
  const std::size_t end = other.find("  ],\n  \"meshes\"");
  ASSERT_NE(end, std::string::npos);
  other.insert(end, ",{\"name\": \"second\", \"mesh\": 0}\n");
  write_text(folder / "minimal.gltf", other);
  EXPECT_TRUE(said());
}

TEST_F(Run, AReplayRepeatsTheRecordingToTheBit) {
  ASSERT_EQ(press("first", {"--record", "press.rec"}).status, 0);
  const Said again = pliant({"run", "plate.obj", "--replay", "press.rec", "--out", "again", "--frames", "0"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(report("again")["hash"], report("first")["hash"]);
  EXPECT_EQ(report("again")["ticks"], report("first")["ticks"]);
  EXPECT_EQ(read_text(folder / "again" / "forces.csv"), read_text(folder / "first" / "forces.csv"));
  EXPECT_EQ(report("again")["probes"][0]["source"], "replay:press.rec");
}

// The error comes before the run, not after it.
TEST_F(Run, ARecordingThatCannotBeWrittenIsRefusedBeforeAnythingRuns) {
  fs::create_directory(folder / "taken");
  for (const char* file : {"taken", "nowhere/press.rec"})
    expect_refused({"run", "plate.obj", "--probe", "p=orbit", "--seconds", "80000", "--frames", "0", "--record", file},
                   1, file);
}

TEST_F(Run, ARecordingOfAnotherLevelOrADamagedOneIsRefused) {
  ASSERT_EQ(press("first", {"--record", "press.rec"}).status, 0);
  fs::copy_file(folder / "plate.obj", folder / "other.obj");
  expect_refused({"run", "other.obj", "--replay", "press.rec"}, 1, "plate");
  expect_refused({"run", "plate.obj", "--replay", "missing.rec"}, 1, "missing.rec");
  std::string bytes = read_text(folder / "press.rec");
  bytes[bytes.size() / 2] ^= 1;
  write_text(folder / "damaged.rec", bytes);
  expect_refused({"run", "plate.obj", "--replay", "damaged.rec"}, 1, "damaged.rec");
  write_text(folder / "short.rec", bytes.substr(0, 100));
  expect_refused({"run", "plate.obj", "--replay", "short.rec"}, 1, "short.rec");
}

TEST_F(Run, RealTimeAccountsForEveryTickAndItsRecordingReplaysToTheSameHash) {
  const Said said = press("live", {"--realtime", "--seconds", "0.5", "--record", "live.rec"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = report("live");
  EXPECT_EQ(json["mode"], "realtime");
  const std::uint64_t ticks = json["ticks"], overruns = json["overruns"];
  EXPECT_LE(ticks, 501u) << "the last one has every device lost";
  EXPECT_GE(ticks + overruns, 500u) << "a tick was neither run nor counted as an overrun";
  ASSERT_EQ(pliant({"run", "plate.obj", "--replay", "live.rec", "--out", "again", "--frames", "0"}).status, 0);
  EXPECT_EQ(report("again")["hash"], json["hash"]);
}

TEST_F(Run, CtrlCEndsARealTimeRunCleanlyWithAReport) {
  const Said said = pliant(
      {"run", "plate.obj", "--probe", "p=orbit", "--realtime", "--seconds", "600", "--out", "out", "--frames", "0"},
      // in the foreground: otherwise the signal arrives twice, and the second one kills
      "timeout --foreground --preserve-status -s INT 3");
  EXPECT_EQ(said.status, 0) << said.err;
  const Json json = report("out");
  EXPECT_GT(json["ticks"], 0);
  EXPECT_LT(json["ticks"], 600000);
}

// Stopped as soon as its folder exists: while graphics are prepared, long before the first tick.
TEST_F(Run, ASignalBeforeTheFirstTickLeavesNothingHalfWrittenBehind) {
  const std::string line =
      "cd " + quoted(folder.string()) + " && { env -u DISPLAY -u WAYLAND_DISPLAY " + quoted(PLIANT_BINARY) +
      " run plate.obj --probe p=orbit --seconds 600 --out out --record out.rec >.said 2>&1 & } && pid=$! && "
      "while kill -0 $pid && [ ! -e out.rec.partial-$pid-0 ]; do :; done && kill -TERM $pid && wait $pid";
  EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 0) << read_text(folder / ".said");
  EXPECT_LT(report("out")["ticks"], 600000);
  EXPECT_EQ(fs::exists(folder / "out.rec"), report("out")["ticks"] > 0) << "a recording without a tick is none";
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
}

}  // namespace
}  // namespace pliant::testing
