// The figures that a run keeps of a tool and of soft steps: work, late ticks and steps, with their cure.
#include "player/record/keeper.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "components/soft_body.h"
#include "engine/run/soft_clock.h"
#include "player/run/tool_words.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

// A tool that its own device moves.
Entity tool_in(World& world) {
  const Entity tool = world.registry.create();
  world.registry.add<Name>(tool, {"hand"});
  world.registry.add<SoftBody>(tool, {});
  world.registry.add<Pose>(tool, {});
  world.registry.add<Handle6>(tool, {});
  world.registry.add(tool, HapticDevice{});
  return tool;
}

// Springs of 200 N/m and 0.5 N m/rad, loaded to 5 mm and 0.4 rad: the work is k x^2 / 2 of each.
TEST(Keeper, TheNetWorkOfAToolIsThatOfItsForceAndOfItsTorque) {
  World world;
  HapticDevice& device = world.registry.get<HapticDevice>(tool_in(world));
  ASSERT_TRUE(prepare_touch(world) && prepare_tools(world));
  Journal journal(world, 1.0);
  const fs::path csv = fs::temp_directory_path() / ("pliant-keeper-" + std::to_string(::getpid()));
  auto keeper = Keeper::create(world, journal.probes(), {"script"}, csv);
  ASSERT_TRUE(keeper);
  const dvec3 axis = normalize(dvec3(1, -2, 0.5));
  for (std::uint64_t i = 0; i <= 100; ++i) {
    const double x = 5e-5 * static_cast<double>(i), angle = 4e-3 * static_cast<double>(i);
    device.position = x * axis;
    device.rotation = rotation_of(angle * axis);
    device.force_sent = -200.0 * x * axis;
    device.torque_sent = -0.5 * angle * axis;
    journal.note(world, {i, 1e-3, 1e-3 * static_cast<double>(i)});
  }
  device.position = dvec3(std::numeric_limits<double>::quiet_NaN());  // lost: no work is known
  device.force_sent = device.torque_sent = dvec3(0);
  journal.note(world, {101, 1e-3, 0.101});
  keeper->keep(journal);
  ASSERT_EQ(keeper->summaries().size(), 1u);
  EXPECT_NEAR(keeper->summaries()[0].net_work, -0.5 * 200.0 * 5e-3 * 5e-3 - 0.5 * 0.5 * 0.4 * 0.4, 1e-12);
  fs::remove(csv);
}

TEST(SoftClock, ALateStepIsLongerUpToThreeStepsAndTheRestIsLost) {
  const double T = 0.02;
  struct Row {
    double late, length, lost;
  };
  for (const Row& row : {Row{0, T, 0}, Row{0.5 * T, 1.5 * T, 0}, Row{2 * T, 3 * T, 0}, Row{5 * T, 3 * T, 3 * T}}) {
    EXPECT_NEAR(SoftClock::late_step(row.late, T).length, row.length, 1e-15) << row.late;
    EXPECT_NEAR(SoftClock::late_step(row.late, T).lost, row.lost, 1e-15) << row.late;
  }
}

// A tool whose model stays at time 0 while ticks continue, and whose contacts twice took too long.
TEST(Keeper, TicksWithAnOldModelOrLateContactsAreCountedAndSaidWithTheirCure) {
  World world;
  (void)tool_in(world);
  ASSERT_TRUE(prepare_touch(world) && prepare_tools(world));
  ToolTouchState& state = *world.tools->tools[0];
  state.model.write().soft_step = 0.01;
  state.model.publish();
  state.model.acquire();
  Journal journal(world, 1.0);
  const fs::path csv = fs::temp_directory_path() / ("pliant-late-" + std::to_string(::getpid()));
  auto keeper = Keeper::create(world, journal.probes(), {"script"}, csv);
  ASSERT_TRUE(keeper);
  for (std::uint64_t i = 0; i < 50; ++i) {  // before the handle is placed there is no model to be stale
    state.state = i >= 10 ? HandleState::kFollows : HandleState::kNew;
    if (i == 20 || i == 21) ++state.ticks_late;
    journal.note(world, {i, 1e-3, 1e-3 * static_cast<double>(i)});
  }
  keeper->keep(journal);
  fs::remove(csv);
  const ProbeSummary& summary = keeper->summaries()[0];
  EXPECT_EQ(summary.late_ticks, 2u);
  EXPECT_EQ(summary.stale_ticks, 19u) << "ticks 31 to 49: older than 0.03 s";
  const std::vector<Note> said = explain_tool(world, summary);
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].message().find("`hand`: the contact solve exceeded its time budget in 2 ticks"), std::string::npos)
      << said[0].message();
  EXPECT_NE(said[0].message().find("--tool-force linear"), std::string::npos) << said[0].message();
  EXPECT_NE(said[1].message().find("in 19 ticks its model was older than 3 soft steps"), std::string::npos)
      << said[1].message();
  EXPECT_EQ(said[0].code, "tool.late");
  EXPECT_EQ(said[1].code, "tool.stale");
  EXPECT_EQ(said[1].of, "hand");
  EXPECT_TRUE(explain_tool(world, {}).empty());
}

// Mean age at 1 kHz and 1/60 s: a tick, half a step, and half the cross-fade.
TEST(Keeper, AHeldForceThatPushesTheHandOnIsSaidWithItsCure) {
  World world;
  const Entity tool = tool_in(world);
  ProbeSummary summary;
  summary.name = "hand";
  EXPECT_TRUE(explain_tool(world, summary).empty()) << "it is not held";
  Handle6& handle = world.registry.get<Handle6>(tool);
  handle.force = ToolForce::kHeld;
  handle.translation = {200.0, 2.0};
  const std::vector<Note> said = explain_tool(world, summary);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].code, "tool.held");
  EXPECT_NE(
      said[0].message().find("12.5 ms old on average, and pushes the hand on unless the hand damps more than 0.49"),
      std::string::npos)
      << said[0].message();
  handle.translation[1] = 2.5;
  EXPECT_TRUE(explain_tool(world, summary).empty());
  handle.translation[1] = 2.0;
  world.simulation.soft_step = 5e-3;
  EXPECT_TRUE(explain_tool(world, summary).empty());
}

TEST(SoftClock, WhatStepsLeaveImperfectIsSaidWithItsCure) {
  World world;
  world.soft = std::make_shared<SoftState>();
  EXPECT_TRUE(explain_soft_steps(world, {}).empty());
  world.soft->tally = {
      .contacts_cut = 7, .unconverged = 1, .residual = 0.25, .deepest = 0.001, .halted = 2, .halted_for = 0.02};
  SoftFigures figures;
  figures.steps = 20;
  figures.time_lost = 1.5;
  const std::vector<Note> said = explain_soft_steps(world, figures);
  ASSERT_EQ(said.size(), 4u);
  EXPECT_NE(said[0].message().find("7 contacts were dropped"), std::string::npos) << said[0].message();
  EXPECT_NE(said[1].message().find("stopped for 0.02 s"), std::string::npos) << said[1].message();
  EXPECT_NE(said[2].message().find("1 of 20 soft steps ended unconverged (residual at most 0.25 m/s)"),
            std::string::npos)
      << said[2].message();
  EXPECT_NE(said[3].message().find("1.50 s behind after 20 steps"), std::string::npos) << said[3].message();
  figures.time_lost = 0.005;  // of 0.33 s
  EXPECT_EQ(explain_soft_steps(world, figures).size(), 3u) << "the report has it, the console does not";
  for (const Note& note : said) EXPECT_NE(note.cure, "") << note.what;
  EXPECT_EQ(said[0].code, "soft.contacts_cut");
  EXPECT_EQ(said[1].code, "soft.halted");
  EXPECT_EQ(said[2].code, "soft.unconverged");
  EXPECT_EQ(said[3].code, "soft.time_lost");
}

}  // namespace
}  // namespace pliant
