// The shipped levels with tools, from the command line: a force that is independent of the soft step, a tower that
// stands until it is pushed, an instrument with force feedback.
#include <algorithm>
#include <array>
#include <cmath>

#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class ToolLevel : public CommandTest {
 protected:
  Json run(const std::string& level, double seconds, const std::string& out, const std::string& soft_step) const {
    const fs::path file = fs::path(PLIANT_SOURCE_DIR) / "content" / "levels" / (level + ".glb");
    const Said said = pliant({"run", file.string(), "--frames", "0", "--seconds", std::to_string(seconds), "--out", out,
                              "--set", "*.simulation.soft_step=" + soft_step});
    EXPECT_EQ(said.status, 0) << said.err;
    return said.status == 0 ? report(out) : Json();
  }

  // [1] RMS difference of the forces on every probe and tool, over the RMS of `reference`.
  double difference(const std::string& out, const std::string& reference) const {
    const ForcesTable a = read_forces(folder / out / "forces.csv"), b = read_forces(folder / reference / "forces.csv");
    EXPECT_EQ(a.rows.size(), b.rows.size());
    double apart = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < std::min(a.rows.size(), b.rows.size()); ++i)
      for (const char* axis : {"fx", "fy", "fz"}) {
        apart += std::pow(a.number(i, axis) - b.number(i, axis), 2);
        whole += std::pow(b.number(i, axis), 2);
      }
    EXPECT_GT(whole, 0.0) << "nothing is felt";
    return std::sqrt(apart / whole);
  }

  // [m] Final position of a body, from bodies.csv.
  std::array<double, 3> last_place(const std::string& out, const std::string& body) const {
    const ForcesTable bodies = read_forces(folder / out / "bodies.csv");
    for (std::size_t i = bodies.rows.size(); i-- > 0;)
      if (bodies.rows[i].at("body") == body)
        return {bodies.number(i, "x"), bodies.number(i, "y"), bodies.number(i, "z")};
    ADD_FAILURE() << body << " is not in bodies.csv";
    return {};
  }
};

// A level and how long it is run.
struct Beginning {
  const char* level;
  double seconds;  // [s] from the start of the script
};

class ToolLevelForce : public ToolLevel, public ::testing::WithParamInterface<Beginning> {};

TEST_P(ToolLevelForce, IsThatOfAFinerSoftStepWithinFivePercent) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "minutes under a sanitizer";
#endif
  run(GetParam().level, GetParam().seconds, "coarse", "0.016666666666666666");
  run(GetParam().level, GetParam().seconds, "fine", "0.008");
  EXPECT_LT(difference("coarse", "fine"), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Levels, ToolLevelForce,
                         ::testing::Values(Beginning{"hand", 2.2}, Beginning{"hand_crowd", 2.6},
                                           Beginning{"hand_squeeze", 2.6}, Beginning{"instrument", 2.2},
                                           Beginning{"stack", 2.7}),
                         [](const auto& beginning) { return std::string(beginning.param.level); });

TEST_F(ToolLevel, TheTowerStandsUnderTheStylusAndLosesItsTopmostBoxAlone) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "minutes under a sanitizer";
#endif
  const Json pressed = run("stack", 2.7, "pressed", "0.016666666666666666");
  EXPECT_GT(pressed["probes"][0]["max_force_N"].get<double>(), 2.0);
  const auto top = last_place("pressed", "box_4");
  EXPECT_NEAR(top[0], -0.040, 0.001);
  EXPECT_NEAR(top[1], 0.115, 0.001);
  EXPECT_NEAR(top[2], 0.0, 0.001);

  run("stack", 9.0, "pushed", "0.016666666666666666");
  EXPECT_LT(last_place("pushed", "box_4")[1], 0.08) << "the topmost box has fallen";
  EXPECT_GT(last_place("pushed", "box_4")[0], 0.0);
  for (const char* box : {"box_1", "box_2", "box_3"}) {
    const auto before = last_place("pressed", box), after = last_place("pushed", box);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(after[axis], before[axis], 0.004) << box << ' ' << axis;
  }
}

TEST_F(ToolLevel, TheInstrumentAndTheProbeFeelTheOrgan) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "minutes under a sanitizer";
#endif
  const Json json = run("instrument", 3.0, "out", "0.016666666666666666");
  ASSERT_EQ(json["probes"].size(), 2u);
  for (const Json& probe : json["probes"]) {
    EXPECT_GT(probe["max_force_N"].get<double>(), 0.2) << probe;
    ASSERT_EQ(probe["touched"].size(), 1u) << probe;
    EXPECT_EQ(probe["touched"][0], "organ") << probe;
  }
}

}  // namespace
}  // namespace pliant::testing
