// --probe NAME=hand: the real command, and the demo levels in a simulated hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/run/simulated_hands.h"
#include "lab/study/hand/study_hand.h"
#include "lab/study/walls/study_walls.h"
#include "tests/player/command.h"

namespace pliant {
namespace {

class HandRunTest : public testing::CommandTest {};

TEST(Hand, WordsAreTakenApart) {
  const HandWords all = hand_words("press.csv,falcon,delay=5ms,hand=firm|drop=10%|gain=2");
  EXPECT_EQ(all.file, "press.csv");
  EXPECT_EQ(all.device, "falcon,delay=5ms,hand=firm");
  EXPECT_EQ(all.wrappers, "drop=10%|gain=2");
  EXPECT_EQ(hand_words("").device, "touch");
  EXPECT_EQ(hand_words("omni").file, "");
}

// Quick subset of `pliant study hand`.
TEST(Hand, DemoOrganIsStableInEveryShippedDevice) {
  for (const DeviceProfile& profile : device_profiles()) {
    const auto run = run_hand("three_probes", profile.name, 0.0, true, 2.5);
    ASSERT_TRUE(run) << run.error().message();
    EXPECT_TRUE(run->stable()) << profile.name << ": " << run->buzz << " m";
    EXPECT_GT(run->force, 0.2) << profile.name << " touches";
  }
}

TEST(Hand, StiffOrganAtTenMillisecondsShakesAnUnguardedHandAndNotAGuardedOne) {
  const auto bare = run_hand("three_probes", "inverse3,hand=finger", 10e-3, false, 3.0, 1500.0);
  const auto guarded = run_hand("three_probes", "inverse3,hand=finger", 10e-3, true, 3.0, 1500.0);
  ASSERT_TRUE(bare && guarded);
  EXPECT_LT(guarded->limit, guarded->stiffest) << "the organ is softened";
  EXPECT_TRUE(guarded->stable()) << guarded->buzz;
  EXPECT_FALSE(bare->stable()) << bare->buzz;
}

TEST(Hand, ARunOfTheStudyIsTheSameBitsEveryTime) {
  const auto forces = [] {
    const auto run = run_hand("three_probes", "omni,hand=finger", 1e-3, true, 2.0);
    std::vector<double> all;
    if (run)
      for (const HandSample& sample : run->samples) all.insert(all.end(), {sample.time, sample.depth, sample.force});
    return all;
  };
  const std::vector<double> first = forces();
  ASSERT_FALSE(first.empty());
  EXPECT_GT(*std::max_element(first.begin(), first.end()), 0.0);
  EXPECT_EQ(first, forces());
}

TEST(Walls, VerdictsAreTheSameBitsEveryTime) {
  const Interrupt interrupt;
  const auto measured = [&] {
    const auto figures = measure_walls(4, 3, 0.2, interrupt);
    std::vector<double> all;
    if (figures)
      for (const WallCell& cell : figures->cells)
        all.insert(all.end(), {double(cell.result.verdict), cell.result.amplitude, cell.result.work});
    return all;
  };
  const std::vector<double> first = measured();
  ASSERT_FALSE(first.empty());
  EXPECT_EQ(first, measured());
}

TEST_F(HandRunTest, MovesAProbeInLockstepWithTheSameHashEveryTimeAndReplaysIt) {
  std::string hash;
  for (int i = 0; i < 2; ++i) {
    const auto said =
        pliant({"run", "three_probes", "--lockstep", "--frames", "0", "--seconds", "3", "--probe",
                "probe_a=hand:falcon,delay=2ms|quantise=0.05mm", "--record", "hand.rec", "--force", "--out", "out"});
    ASSERT_EQ(said.status, 0) << said.err;
    const auto report = testing::Json::parse(testing::read_text(folder / "out" / "report.json"));
    const std::string now = report.at("hash");
    EXPECT_TRUE(hash.empty() || hash == now);
    hash = now;
    EXPECT_EQ(report.at("probes").at(0).at("source"), "hand:falcon,delay=2ms|quantise=0.05mm");
    EXPECT_GT(report.at("probes").at(0).at("contact_ticks").get<int>(), 300);
  }
  const auto replayed = pliant({"run", "three_probes", "--replay", "hand.rec", "--frames", "0", "--out", "again"});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_EQ(testing::Json::parse(testing::read_text(folder / "again" / "report.json")).at("hash"), hash);
}

TEST_F(HandRunTest, MovesAProbeInRealTime) {
  const auto said = pliant({"run", "three_probes", "--headless", "--realtime", "--frames", "0", "--seconds", "2.5",
                            "--probe", "probe_a=hand:omni", "--out", "out"});
  ASSERT_EQ(said.status, 0) << said.err;
  const auto report = testing::Json::parse(testing::read_text(folder / "out" / "report.json"));
  EXPECT_GT(report.at("probes").at(0).at("contact_ticks").get<int>(), 0);
}

TEST_F(HandRunTest, SaysTheLimitWhereALevelIsStifferThanTheDeviceRenders) {
  const auto said = pliant({"run", "three_probes", "--lockstep", "--frames", "0", "--seconds", "0.1", "--probe",
                            "probe_a=hand:omni,delay=10ms", "--out", "out"});
  EXPECT_EQ(said.status, 0);
  EXPECT_THAT(said.err, ::testing::HasSubstr("renders at most"));
}

TEST_F(HandRunTest, BadWordsGetOneSentence) {
  for (const auto& [words, part] : {std::pair("hand:nothere.csv", "nothere.csv"),
                                    {"hand:touch,weight=3", "unknown key 'weight'"},
                                    {"hand:touch|slow=3", "wrappers are"},
                                    {"hand:a.csv,b.csv", "unknown profile 'b.csv'"}}) {
    const auto said =
        pliant({"run", "three_probes", "--lockstep", "--frames", "0", "--probe", std::string("probe_a=") + words});
    EXPECT_NE(said.status, 0) << words;
    EXPECT_THAT(said.err, ::testing::HasSubstr(part)) << words;
  }
}

}  // namespace
}  // namespace pliant
