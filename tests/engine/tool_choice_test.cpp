// Choices of an error budget for a tool: how the touch clock computes its force, measured by a press of that tool.
#include <gtest/gtest.h>

#include "content/level_file.h"
#include "engine/choice/model_choice.h"
#include "engine/choice/tool_press.h"
#include "pliant/scene.h"
#include "scenes/scenes.h"

namespace pliant {
namespace {

MeshData slab(double size, double thickness) {
  const Primitive primitive = scenes::slab(6, size, thickness);
  MeshData mesh;
  mesh.position = primitive.position;
  mesh.index = primitive.index;
  return mesh;
}

// A pad of tissue under a rigid plate with a handle.
Level pad_level(double error) {
  Scene scene;
  SoftBodyParameters body;
  body.young = 2e4;
  body.poisson = 0.4;
  body.rayleigh = {0.0, 0.01};
  body.cell = 0.0125;
  body.error = error;
  scene.add_soft_body("pad", slab(0.05, 0.02), body);
  HandleParameters handle;
  handle.box.add(vec3(-1, -0.006f, -1));
  handle.box.add(vec3(1, 1, 1));
  handle.translation = {1000.0, 10.0};
  handle.max_force = 10.0;
  EXPECT_TRUE(scene.add_handle("pad", handle));
  return scene.level();
}

double difference(const std::vector<Vector6>& felt, const std::vector<Vector6>& truth) {
  double off = 0.0, size = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    off += (felt[i] - truth[i]).head<3>().squaredNorm();
    size += (truth[i] - truth[0]).head<3>().squaredNorm();
  }
  return std::sqrt(off / size);
}

const ModelChoice* tool_of(const std::vector<ModelChoice>& choices) {
  for (const ModelChoice& each : choices)
    if (each.kind == "tool") return &each;
  return nullptr;
}

TEST(ToolChoice, ThePressIsFeltAndContactsSolvedAgainComeToSoftStepsAtTheTouchRate) {
  Level level = pad_level(0.1);
  std::vector<Vector6> truth;
  std::vector<double> errors;
  for (const double step : {1.0 / 30, 1.0 / 100, 1.0 / 500}) {
    level.simulation.soft_step = step;
    ChoiceProgress progress;
    auto press = ToolPress::make(level, 0);
    ASSERT_TRUE(press) << press.error().message();
    if (truth.empty()) truth = press->truth(progress)->wrench;  // the same for every soft step
    const auto felt = press->touched(ToolForce::kContacts);
    ASSERT_TRUE(felt);
    EXPECT_GT(felt->contacts, 3);
    errors.push_back(difference(felt->wrench, truth));
  }
  EXPECT_GT(truth.back()[1] - truth.front()[1], 0.2) << "[N] up, from the plate below";
  EXPECT_LT(truth.back()[0], -0.02) << "[N] friction, against the way along the plate";
  // With any step, the difference of the handle's motion between a tick and a soft step of the same length remains.
  for (const double error : errors) EXPECT_LT(error, 0.015);
}

TEST(ToolChoice, ATightBudgetSolvesContactsAgainAndALooseOneHoldsTheForce) {
  Level level = pad_level(1e-3);
  level.simulation.soft_step = 1.0 / 50;  // stated: the body's choice keeps it
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices) << choices.error().message();
  for (const ModelCandidate& it : choices->front().tried) EXPECT_LT(it.error, 2.0) << it.label;
  const ModelChoice* tool = tool_of(*choices);
  ASSERT_TRUE(tool);
  ASSERT_EQ(tool->tried.size(), 3u);
  EXPECT_EQ(tool->within, tool->tried[tool->chosen].error <= 1e-3);
  EXPECT_EQ(level.nodes[0].handle->force, ToolForce::kContacts) << tool->sentence();
  EXPECT_EQ(cheapest_within(tool->tried, 10.0), 0u);
  EXPECT_EQ(tool->tried[0].label.find("force held"), 0u) << tool->tried[0].label;
  EXPECT_GT(tool->tried[2].cost, tool->tried[1].cost);
  EXPECT_LT(tool->tried[2].error, 0.5 * tool->tried[0].error) << "contacts solved again against a held force";
  // Equal to an independent press, bit for bit.
  ChoiceProgress progress;
  auto press = ToolPress::make(level, 0);
  ASSERT_TRUE(press);
  const auto held = press->touched(ToolForce::kHeld);
  const auto truth = press->truth(progress);
  ASSERT_TRUE(truth && held);
  EXPECT_NEAR(difference(held->wrench, truth->wrench), tool->tried[0].error, 1e-12);
}

TEST(ToolChoice, AtHighRatesTheTruthHasTheStepsOfALowerRate) {
  Level level = pad_level(0.1);
  level.simulation.soft_step = 1.0 / 50;
  std::vector<std::vector<Vector6>> truths;
  for (const double rate : {2000.0, 8000.0}) {  // 500 steps of 0.5 ms each
    level.simulation.touch_rate = rate;
    ChoiceProgress progress;
    auto press = ToolPress::make(level, 0);
    ASSERT_TRUE(press) << press.error().message();
    EXPECT_EQ(press->unmeasured(), "");
    const std::size_t every = press->truth_ticks();
    EXPECT_EQ(every, rate == 2000.0 ? 1u : 4u);
    const auto truth = press->truth(progress);
    ASSERT_TRUE(truth);
    EXPECT_EQ(truth->wrench.size(), 500u);
    const auto felt = press->touched(ToolForce::kContacts);
    ASSERT_TRUE(felt);
    EXPECT_EQ(felt->wrench.size(), every * 500u);
    std::vector<Vector6> looked;
    for (std::size_t i = 0; i < felt->wrench.size(); i += every) looked.push_back(felt->wrench[i]);
    const double error = difference(looked, truth->wrench);
    EXPECT_LT(error, 0.02) << rate;  // 0.008 at 1 kHz
    truths.push_back(truth->wrench);
  }
  EXPECT_LT(difference(truths[1], truths[0]), 1e-6);
}

TEST(ToolChoice, WhatWouldTakeTooLongIsLeftAndSaid) {
  for (const auto& [rate, step, words] :
       {std::tuple(1000.0, 0.0005, "shorter than a tick"), {100000.0, 0.0008, "cannot be measured in a minute"}}) {
    Level level = pad_level(0.5);
    level.simulation.touch_rate = rate;
    level.simulation.soft_step = step;
    const auto choices = choose_models(level);
    ASSERT_TRUE(choices) << choices.error().message();
    EXPECT_FALSE(tool_of(*choices));
    EXPECT_NE(choices->front().sentence().find(words), std::string::npos) << choices->front().sentence();
  }
}

TEST(ToolChoice, AStatedForceStaysAndARigidToolTakesTheLeastBudgetOfTheLevel) {
  Scene scene;
  DeformableParameters d;
  d.reach = 0.03;
  d.error = 0.7;
  const Primitive sheet = scenes::sheet(20, 0.16);
  MeshData mesh;
  mesh.position = sheet.position;
  mesh.index = sheet.index;
  scene.add_surface("sheet", mesh, d, {.position = dvec3(0, -0.2, 0)});
  scene.add_rigid_body("block", slab(0.04, 0.02));
  ASSERT_TRUE(scene.add_handle("block"));
  Level level = scene.level();
  ASSERT_TRUE(set_key(level, "block.handle.force=linear"));
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices) << choices.error().message();
  const ModelChoice* tool = tool_of(*choices);
  ASSERT_TRUE(tool);
  EXPECT_EQ(tool->budget, 0.7);
  ASSERT_EQ(tool->tried.size(), 1u);
  EXPECT_EQ(level.nodes[1].handle->force, ToolForce::kLinear);
  EXPECT_NE(tool->sentence().find("the level itself says force"), std::string::npos) << tool->sentence();
}

}  // namespace
}  // namespace pliant
