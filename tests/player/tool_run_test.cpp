// pliant run on a level with a tool: a soft block with a rigid back, over a ground and next to a P1 plate.
#include <cmath>

#include "content/level_file.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

constexpr double kHeight = 0.04;  // [m] of the block

// A box about the origin, n x n squares per face: tissue has contacts at the vertices of its collision mesh.
Primitive box(vec3 size, int n) {
  Primitive p;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      vec3 out(0), u(0), v(0);
      out[axis] = side;
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1;
      const auto first = static_cast<std::uint32_t>(p.position.size());
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
          p.position.push_back(0.5f * size *
                               (out + (2.0f * float(i) / float(n) - 1) * u + (2.0f * float(j) / float(n) - 1) * v));
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const std::uint32_t a = first + static_cast<std::uint32_t>(i * (n + 1) + j),
                              right = a + static_cast<std::uint32_t>(n) + 1;
          for (const std::uint32_t corner : {a, right, right + 1, a, right + 1, a + 1}) p.index.push_back(corner);
        }
    }
  return p;
}

class ToolRun : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    Level level;
    level.meshes = {{"block", {box(vec3(0.03f, float(kHeight), 0.03f), 4)}},
                    {"ground", {box(vec3(0.3f, 0.02f, 0.3f), 1)}}};
    LevelNode tool;
    tool.name = "hand";
    tool.mesh = 0;
    tool.local.translation = vec3(0, 0.05f, 0);
    tool.soft_body.emplace();
    tool.soft_body->young = 2e4;
    tool.soft_body->poisson = 0.3;
    tool.soft_body->density = 200;
    tool.soft_body->rayleigh = {1.0, 0.01};
    tool.soft_body->cell = 0.01;
    tool.handle.emplace();
    tool.handle->box = Box{vec3(-1, 0.01f, -1), vec3(1)};
    tool.handle->device = "arm";
    LevelNode arm;
    arm.name = "arm";
    arm.local.translation = tool.local.translation;
    arm.device.emplace();
    LevelNode ground;
    ground.name = "ground";
    ground.mesh = 1;
    ground.local.translation = vec3(0, -0.01f, 0);
    ground.rigid_body.emplace();
    ground.rigid_body->fixed = true;
    level.nodes = {tool, arm, ground};
    ASSERT_TRUE(save_level(level, folder / "block.glb").ok());
    // Down by 3 mm into the ground with a small rotation, a rest, and up again.
    write_text(folder / "press.csv",
               "time_s,x,y,z,qw,qx,qy,qz\n0,0,0.05,0,1,0,0,0\n0.4,0,0.017,0,1,0,0,0\n"
               "0.5,0,0.017,0,0.9999,0,0.0141,0\n0.8,0,0.017,0,0.9999,0,0.0141,0\n1.0,0,0.05,0,1,0,0,0\n");
  }
  Said press(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"run",   "block.glb", "--probe",  "hand=script:press.csv",
                                       "--out", out,         "--frames", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return pliant(arguments);
  }
};

TEST_F(ToolRun, AToolIsReportedLikeAProbeAndTheSoftClockBesideIt) {
  const Said said = press("out");
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = report("out");
  EXPECT_EQ(json["ticks"], 1000) << "as long as the script";
  ASSERT_EQ(json["probes"].size(), 1u);
  EXPECT_EQ(json["probes"][0]["name"], "hand");
  EXPECT_EQ(json["probes"][0]["source"], "script:press.csv");
  EXPECT_GT(json["probes"][0]["contact_ticks"].get<int>(), 300);
  EXPECT_GT(json["probes"][0]["max_force_N"].get<double>(), 0.2);
  EXPECT_LE(json["probes"][0]["net_work_J"].get<double>(), 0.0);
  const Json& soft = json["soft"];
  EXPECT_EQ(soft["steps"], 60) << "one every 1/60 s";
  EXPECT_EQ(soft["overruns"], 0);
  EXPECT_GT(soft["tetrahedra"].get<int>(), 20);
  EXPECT_GT(soft["contacts"]["max"].get<int>(), 3);
  EXPECT_GT(soft["contacts"]["max"].get<double>(), soft["contacts"]["mean"].get<double>());
  for (const char* key : {"p50", "p99", "max"}) EXPECT_GT(soft["step_ms"][key].get<double>(), 0.0) << key;
  for (const char* key : {"sweeps", "residual"}) EXPECT_GE(soft[key].get<double>(), 0.0) << key;
  EXPECT_TRUE(json["notes"].empty()) << json["notes"];

  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  ASSERT_EQ(forces.rows.size(), 1000u);
  for (std::size_t i = 0; i < forces.rows.size(); ++i) {
    EXPECT_EQ(forces.rows[i].at("probe"), "hand");
    const double time = forces.number(i, "time_s");
    if (time > 0.7 && time < 0.8) {
      EXPECT_GT(forces.number(i, "fy"), 0.2) << "the ground pushes up";
      EXPECT_EQ(forces.rows[i].at("in_contact"), "1") << time;
    }
    if (time > 0.1 && time < 0.3) EXPECT_EQ(forces.rows[i].at("in_contact"), "0") << time;
    if (time > 0.9) EXPECT_LT(std::abs(forces.number(i, "fy")), 0.02) << "a carried tool weighs nothing in the hand";
  }
}

TEST_F(ToolRun, WhatTheRowsSayOfTorqueAndTouchIsWhatTheReportSays) {
  ASSERT_EQ(press("out").status, 0);
  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  EXPECT_EQ(std::vector<std::string>(forces.columns.end() - 4, forces.columns.end()),
            (std::vector<std::string>{"slewed", "tx", "ty", "tz"}));
  double largest = 0.0;
  for (std::size_t i = 0; i < forces.rows.size(); ++i) {
    largest = std::max(largest, std::hypot(forces.number(i, "tx"), forces.number(i, "ty"), forces.number(i, "tz")));
    const double time = forces.number(i, "time_s");
    if (time > 0.1 && time < 0.3) EXPECT_EQ(forces.rows[i].at("objects"), "0") << time;
    if (time > 0.7 && time < 0.8) EXPECT_EQ(forces.rows[i].at("objects"), "1") << time;
  }
  EXPECT_GT(largest, 1e-4) << "it is turned while it presses";
  const Json tool = report("out")["probes"][0];
  EXPECT_NEAR(tool["max_torque_Nm"].get<double>(), largest, 1e-8 * largest);
  EXPECT_EQ(tool["touched"], Json::array({"ground"}));
  EXPECT_EQ(tool["late_ticks"], 0) << "lockstep has no time to be late in";
  EXPECT_EQ(tool["stale_ticks"], 0);
  const Json soft = report("out")["soft"];
  for (const char* key : {"unconverged", "contacts_cut", "time_lost_s"}) EXPECT_EQ(soft[key], 0) << key;
  EXPECT_GE(soft["deepest_m"].get<double>(), 0.0);
}

TEST_F(ToolRun, TheForceIsMadeAsTheKeySaysUnlessTheOptionSaysOtherwise) {
  const auto hash = [&](const std::string& out) { return report(out)["hash"].get<std::string>(); };
  const auto used = [&](const std::string& out) { return report(out)["probes"][0]["tool_force"].get<std::string>(); };
  ASSERT_EQ(press("usual").status, 0);
  EXPECT_EQ(used("usual"), "contacts");
  for (const std::string force : {"held", "linear", "contacts"}) {
    ASSERT_EQ(press(force, {"--tool-force", force}).status, 0);
    EXPECT_EQ(used(force), force);
    ASSERT_EQ(press("key-" + force, {"--set", "hand.handle.force=" + force}).status, 0);
    EXPECT_EQ(hash("key-" + force), hash(force)) << "the key and the option mean the same";
  }
  EXPECT_EQ(hash("usual"), hash("contacts"));
  EXPECT_NE(hash("held"), hash("linear"));
  EXPECT_NE(hash("linear"), hash("contacts"));
  ASSERT_EQ(press("both", {"--set", "hand.handle.force=held", "--tool-force", "linear"}).status, 0);
  EXPECT_EQ(hash("both"), hash("linear")) << "the option stands above the key";

  // A constant force differs from one that is solved again, also on the hand.
  const ForcesTable held = read_forces(folder / "held" / "forces.csv"),
                    solved = read_forces(folder / "contacts" / "forces.csv");
  double apart = 0.0;
  for (std::size_t i = 0; i < held.rows.size(); ++i)
    apart = std::max(apart, std::abs(held.number(i, "fy") - solved.number(i, "fy")));
  EXPECT_GT(apart, 1e-3);
}

TEST_F(ToolRun, AWayToMakeTheForceThatThereIsNotIsRefused) {
  expect_refused({"run", "block.glb", "--tool-force", "magic"}, 2,
                 "must be one of held, linear, contacts; got 'magic'");
  expect_refused({"run", "block.glb", "--set", "hand.handle.force=magic"}, 2,
                 "must be one of held, linear, contacts; got 'magic'");
  write_text(folder / "plate.obj", plate_obj());
  expect_refused({"run", "plate.obj", "--tool-force", "linear"}, 2, "--tool-force");
}

TEST_F(ToolRun, TissueThatLocksIsSaidByValidateInspectAndOnceByRun) {
  const std::string sentence = "has a Poisson's ratio of 0.49: from 0.47 on its ";
  Result<Level> level = load_level(folder / "block.glb");
  ASSERT_TRUE(level.ok());
  for (LevelNode& node : level->nodes)
    if (node.soft_body) node.soft_body->poisson = 0.49;
  ASSERT_TRUE(save_level(*level, folder / "locks.glb").ok());
  const Said validated = pliant({"validate", "locks.glb"});
  EXPECT_EQ(validated.status, 0) << "it can be simulated";
  EXPECT_NE(validated.out.find(": warning: " + sentence), std::string::npos) << validated.out;
  EXPECT_NE(pliant({"inspect", "locks.glb"}).out.find(sentence), std::string::npos);
  const Said said = pliant({"run", "locks.glb", "--seconds", "0.02", "--out", "out", "--frames", "0"});
  ASSERT_EQ(said.status, 0) << said.err;
  const std::size_t first = said.err.find("`hand` " + sentence);
  EXPECT_NE(first, std::string::npos) << said.err;
  EXPECT_EQ(said.err.find(sentence, first + 10), std::string::npos) << "once";
  EXPECT_NE(report("out")["notes"].dump().find(sentence), std::string::npos);
  for (const char* verb : {"validate", "inspect"})
    EXPECT_EQ(pliant({verb, "block.glb"}).out.find("Poisson"), std::string::npos) << verb;
}

TEST_F(ToolRun, InspectSaysHowEachToolsForceIsMade) {
  const Json json = Json::parse(pliant({"inspect", "block.glb", "--json"}).out);
  ASSERT_EQ(json["tools"].size(), 1u);
  EXPECT_EQ(json["tools"][0], (Json{{"name", "hand"}, {"device", "arm"}, {"force", "contacts"}}));
  EXPECT_NE(pliant({"inspect", "block.glb"}).out.find("tool hand: device arm, force contacts"), std::string::npos);
}

// Semi-implicit Euler's free fall: x_k = x_0 + g T^2 (k + 1) (k + 2) / 2. After a time t it differs from g t^2 / 2 by g
// t T / 2.
class FallingRun : public CommandTest {
 protected:
  static constexpr double kStep = 1.0 / 60.0, kGravity = 9.81, kTop = 2.0;
  // [m] of the height after step k
  static double height(double k) { return kTop - 0.5 * kGravity * kStep * kStep * (k + 1) * (k + 2); }
  void SetUp() override {
    CommandTest::SetUp();
    Level level;
    level.meshes = {{"box", {box(vec3(0.02f, 0.03f, 0.04f), 2)}}};
    LevelNode crate;
    crate.name = "a \"crate\", falling";
    crate.mesh = 0;
    crate.local.translation = vec3(0.5f, float(kTop), 0);
    crate.local.rotation = turned_;
    crate.rigid_body.emplace();
    crate.rigid_body->density = 500;
    LevelNode jelly = crate;
    jelly.name = "jelly";
    jelly.local.translation.x = -0.5f;
    jelly.rigid_body.reset();
    jelly.soft_body.emplace();
    jelly.soft_body->young = 2e4;
    jelly.soft_body->poisson = 0.3;
    jelly.soft_body->cell = 0.01;
    level.nodes = {crate, jelly};
    ASSERT_TRUE(save_level(level, folder / "fall.glb").ok());
  }
  const quat turned_{std::cos(0.3f), 0, 0, std::sin(0.3f)};
};

TEST_F(FallingRun, BodiesAreWrittenWhereTheyFallTo) {
  const Said said = pliant({"run", "fall.glb", "--seconds", "0.3", "--out", "out", "--frames", "0"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.out.find("bodies.csv"), std::string::npos);
  const ForcesTable bodies = read_forces(folder / "out" / "bodies.csv");
  EXPECT_EQ(bodies.columns,
            (std::vector<std::string>{"step", "time_s", "body", "x", "y", "z", "qw", "qx", "qy", "qz"}));
  ASSERT_EQ(bodies.rows.size(), 2u * 18u) << "each body in each step that begins before 0.3 s";
  std::size_t crates = 0;
  for (std::size_t i = 0; i < bodies.rows.size(); ++i) {
    const double step = bodies.number(i, "step"), time = bodies.number(i, "time_s"), y = bodies.number(i, "y");
    const bool crate = bodies.rows[i].at("body") != "jelly";
    crates += crate;
    EXPECT_EQ(step, static_cast<double>(i / 2));
    EXPECT_NEAR(time, step * kStep, 1e-8);
    EXPECT_NEAR(bodies.number(i, "x"), crate ? 0.5 : -0.5, 1e-6);
    EXPECT_NEAR(y, height(step), 1e-6) << "as the integrator has it";
    const double since = time + kStep;  // the row is at the step's end
    EXPECT_LE(std::abs(y - (kTop - 0.5 * kGravity * since * since)), 0.5 * kGravity * since * kStep + 1e-6);
    EXPECT_NEAR(bodies.number(i, "z"), 0.0, 1e-6);
    EXPECT_NEAR(bodies.number(i, "qw"), std::cos(0.3), 1e-6);
    EXPECT_NEAR(bodies.number(i, "qz"), std::sin(0.3), 1e-6);
    EXPECT_NEAR(bodies.number(i, "qx"), 0.0, 1e-6);
  }
  EXPECT_EQ(crates, 18u);
  EXPECT_NE(read_text(folder / "out" / "bodies.csv").find("\"a \"\"crate\"\", falling\""), std::string::npos);
}

TEST_F(FallingRun, WhatNoBodyMovesInHasNoBodiesFileNotEvenAnOldOne) {
  ASSERT_EQ(pliant({"run", "fall.glb", "--seconds", "0.05", "--out", "out", "--frames", "0"}).status, 0);
  ASSERT_TRUE(fs::exists(folder / "out" / "bodies.csv"));
  write_text(folder / "plate.obj", plate_obj());
  const Said said = pliant({"run", "plate.obj", "--seconds", "0.05", "--out", "out", "--frames", "0", "--force"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_FALSE(fs::exists(folder / "out" / "bodies.csv")) << "it would be of another run";
  EXPECT_EQ(said.out.find("bodies.csv"), std::string::npos);
}

// More soft steps than touch ticks: none is lost.
TEST_F(FallingRun, StepsBetweenTicksAreAllWritten) {
  ASSERT_EQ(pliant({"run", "fall.glb", "--seconds", "0.3", "--rate", "10", "--set", "*.simulation.soft_step=0.001",
                    "--out", "out", "--frames", "0"})
                .status,
            0);
  EXPECT_EQ(read_forces(folder / "out" / "bodies.csv").rows.size(), 2u * 201u) << "ticks at 0, 0.1 and 0.2 s";
}

TEST_F(ToolRun, LockstepGivesTheSameBitsAndAReplayTheSameAgain) {
  ASSERT_EQ(press("first", {"--record", "hand.rec"}).status, 0);
  ASSERT_EQ(press("second").status, 0);
  EXPECT_EQ(report("first")["hash"], report("second")["hash"]);
  const Said again = pliant({"run", "block.glb", "--replay", "hand.rec", "--out", "third", "--frames", "0"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(report("first")["hash"], report("third")["hash"]);
  ASSERT_EQ(press("softer", {"--set", "hand.soft_body.young=15000"}).status, 0);
  EXPECT_NE(report("first")["hash"], report("softer")["hash"]) << "the hash knows the tissue";
}

// The reference of a tool is the soft step at the touch rate: another rate has another error.
TEST_F(ToolRun, ABudgetIsMeasuredAtTheRateOfTheRun) {
  const auto note_of = [&](const std::vector<std::string>& more, const std::string& out) {
    std::vector<std::string> words{"--error", "0.5", "--seconds", "0.01"};
    words.insert(words.end(), more.begin(), more.end());
    const Said said = press(out, words);
    EXPECT_EQ(said.status, 0) << said.err;
    const std::size_t at = said.err.find("pliant: note: `hand`: force");
    return said.err.substr(std::min(at, said.err.size()), said.err.find('\n', at) - at);
  };
  const std::string usual = note_of({}, "a"), option = note_of({"--rate", "400"}, "b"),
                    level = note_of({"--set", "*.simulation.touch_rate=400"}, "c");
  EXPECT_NE(usual, "");
  EXPECT_NE(usual, option);
  EXPECT_EQ(option, level);
  // Likewise for a replay, at its recording's rate.
  ASSERT_EQ(press("d", {"--error", "0.5", "--rate", "400", "--seconds", "0.1", "--record", "p.rec"}).status, 0);
  const Said replayed = pliant({"run", "block.glb", "--replay", "p.rec", "--frames", "0", "--out", "e"});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_NE(replayed.err.find(option), std::string::npos) << replayed.err;
  EXPECT_EQ(report("d")["hash"], report("e")["hash"]);
  EXPECT_EQ(replayed.err.find("not as it was"), std::string::npos) << replayed.err;
}

TEST_F(ToolRun, AToolWithoutADeviceThatMovesIsHeldWhereItStands) {
  const Said said = pliant({"run", "block.glb", "--seconds", "0.3", "--out", "still", "--frames", "0"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(report("still")["probes"][0]["source"], "null");
  EXPECT_EQ(report("still")["probes"][0]["contact_ticks"], 0);
}

TEST_F(ToolRun, TheLimitsOfForceAndTorqueAreInTheReport) {
  ASSERT_EQ(press("free").status, 0);
  const Said said = press("out", {"--set", "arm.haptic_device.max_force=0.2"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(report("free")["probes"][0]["clipped"]["ticks"], 0);
  EXPECT_TRUE(report("free")["probes"][0]["torque"].contains("withheld"));
  EXPECT_GT(report("out")["probes"][0]["clipped"]["ticks"], 50);
  EXPECT_NE(said.err.find("tool `hand`: the force was clipped at max_force 0.2 N in "), std::string::npos) << said.err;
}

TEST_F(ToolRun, AnOrbitTakesTheToolDownToTheGround) {
  const Said said =
      pliant({"run", "block.glb", "--probe", "hand=orbit", "--seconds", "2", "--out", "orbit", "--frames", "0"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(report("orbit")["probes"][0]["source"], "orbit");
  EXPECT_GT(report("orbit")["probes"][0]["contact_ticks"].get<int>(), 200);
}

TEST_F(ToolRun, AnOrbitWithoutASurfaceHoldsItsProbeAndSaysSo) {
  const Said said = press("out", {"--probe", "finger=orbit", "--seconds", "0.1"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("`finger` found no deformable surface"), std::string::npos) << said.err;
  const Json json = report("out");
  EXPECT_NE(json["notes"].dump().find("finger"), std::string::npos);
  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  for (std::size_t i = 0; i < forces.rows.size(); ++i)
    if (forces.rows[i].at("probe") == "finger")
      for (const char* axis : {"x", "y", "z"}) EXPECT_EQ(forces.number(i, axis), 0.0) << axis;
}

TEST_F(ToolRun, AProbePressesARigidBodyOrPassesItAsItIsSet) {
  write_text(folder / "down.csv", "time_s,x,y,z\n0,0.1,0.02,0\n0.3,0.1,0.02,0\n0.6,0.1,-0.002,0\n1.2,0.1,-0.002,0\n");
  const Said felt = press("felt", {"--probe", "finger=script:down.csv", "--seconds", "1.2"});
  ASSERT_EQ(felt.status, 0) << felt.err;
  const auto finger = [](const Json& json) {
    for (const Json& probe : json["probes"])
      if (probe["name"] == "finger") return probe;
    return Json();
  };
  const Json pressed = finger(report("felt"));
  EXPECT_GT(pressed["contact_ticks"].get<int>(), 300);
  EXPECT_GT(pressed["max_force_N"].get<double>(), 1.0);
  EXPECT_EQ(pressed["touched"], Json::array({"ground"}));

  const Said passed = press(
      "passed", {"--probe", "finger=script:down.csv", "--seconds", "1.2", "--set", "finger.probe.meets=surfaces"});
  ASSERT_EQ(passed.status, 0) << passed.err;
  EXPECT_EQ(finger(report("passed"))["contact_ticks"], 0);
  EXPECT_EQ(finger(report("passed"))["max_force_N"], 0.0);
  const std::string said =
      "the probe `finger` passes through soft and rigid bodies (here `ground`), because its PLIANT_probe/meets is "
      "`surfaces`";
  const std::size_t first = passed.err.find(said);
  EXPECT_NE(first, std::string::npos) << passed.err;
  EXPECT_EQ(passed.err.find(said, first + 1), std::string::npos) << "once";
}

TEST_F(ToolRun, RealTimeRunsBothClocksAndStopsThemTogether) {
  const Said said = press("live", {"--realtime", "--seconds", "0.5"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = report("live");
  EXPECT_EQ(json["mode"], "realtime");
  EXPECT_GT(json["soft"]["steps"].get<int>(), 0);
  EXPECT_LE(json["soft"]["steps"].get<int>(), 40) << "no faster than one every 1/60 s";
}

TEST_F(ToolRun, ALevelWithoutTissueHasNoSoftClock) {
  write_text(folder / "plate.obj", plate_obj());
  ASSERT_EQ(pliant({"run", "plate.obj", "--seconds", "0.05", "--out", "plate", "--frames", "0"}).status, 0);
  EXPECT_FALSE(report("plate").contains("soft"));
}

TEST_F(ToolRun, ASourceForNobodyIsRefused) {
  expect_refused({"run", "block.glb", "--probe", "ground=orbit"}, 2, "ground");
}

}  // namespace
}  // namespace pliant::testing
