// Error budgets (engine/choice): the chosen model is within its budget by an independent measurement; a tighter budget
// never chooses a cheaper one; stated keys are kept.
#include "engine/choice/model_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "content/keys/extension_table.h"
#include "content/level_file.h"
#include "pliant/session.h"
#include "scenes/scenes.h"

namespace pliant {
namespace {

MeshData data_of(const Primitive& primitive) {
  MeshData mesh;
  mesh.position = primitive.position;
  mesh.index = primitive.index;
  return mesh;
}

constexpr double kReach = 0.03;  // [m]

Level sheet_level(double error) {
  Scene scene;
  DeformableParameters d;
  d.reach = kReach;
  d.error = error;
  scene.add_surface("sheet", data_of(scenes::sheet(40, 0.16)), d);
  return scene.level();
}

// In a separate session and with its own probe: the surface against the half-space, with the chosen keys.
double error_in_a_session(const Level& level) {
  Scene scene(level);
  scene.level().nodes[0].deformable->error = 0.0;
  scene.add_probe("tip", {}, {}, {.position = dvec3(0.001, 0.01, 0.001)});
  auto session = Session::open(scene);
  EXPECT_TRUE(session);
  const double depth = 0.002, inner = 0.2 * kReach;
  const dvec3 foot(0.0015, 0.0, 0.0025);
  EXPECT_TRUE(session->move("tip", foot + dvec3(0, 0.002, 0)));
  EXPECT_TRUE(session->step());
  EXPECT_TRUE(session->move("tip", foot - dvec3(0, depth, 0)));
  EXPECT_TRUE(session->step());
  std::vector<vec3> at;
  EXPECT_TRUE(session->vertices("sheet", at));
  double off = 0.0, size = 0.0;
  for (const vec3 p : at) {
    const double r = std::hypot(p.x - foot.x, p.z - foot.z);
    if (r > kReach) continue;
    const double truth = r <= inner ? 1.0 : 2 / M_PI * std::asin(inner / r);
    off += (-p.y / depth - truth) * (-p.y / depth - truth);
    size += truth * truth;
  }
  return std::sqrt(off / size);
}

TEST(ModelChoice, AChosenSurfaceIsWithinItsBudgetInASessionOfItsOwn) {
  Shape last = Shape::kHertz;
  int shapes = 0;
  for (const double budget : {0.5, 0.3}) {
    Level level = sheet_level(budget);
    const auto choices = choose_models(level);
    ASSERT_TRUE(choices) << choices.error().message();
    ASSERT_EQ(choices->size(), 1u);
    const ModelChoice& choice = choices->front();
    EXPECT_TRUE(choice.within) << choice.sentence();
    // Places on a coarse mesh differ a little.
    EXPECT_LT(error_in_a_session(level), budget + 0.03) << choice.sentence();
    EXPECT_NEAR(error_in_a_session(level), choice.tried[choice.chosen].error, 0.06) << choice.sentence();
    shapes += level.nodes[0].deformable->shape != last;
    last = level.nodes[0].deformable->shape;
  }
  EXPECT_EQ(shapes, 2) << "a tighter budget takes another shape";
}

TEST(ModelChoice, ATighterBudgetNeverChoosesACheaperModel) {
  double before = 0.0;
  for (const double budget : {0.9, 0.5, 0.4, 0.3, 0.2, 0.05}) {
    Level level = sheet_level(budget);
    const auto choices = choose_models(level);
    ASSERT_TRUE(choices);
    const ModelChoice& choice = choices->front();
    EXPECT_GE(choice.tried[choice.chosen].cost, before) << budget;
    before = choice.tried[choice.chosen].cost;
    for (std::size_t i = 0; i < choice.chosen; ++i)
      EXPECT_TRUE(choice.tried[i].error > budget || !choice.within) << choice.tried[i].label;
    if (!choice.within) EXPECT_NE(choice.sentence().find("comes nearest"), std::string::npos);
  }
}

TEST(ModelChoice, TheSameLevelChoosesTheSameBitsEveryTime) {
  Level a = sheet_level(0.4), b = sheet_level(0.4);
  const auto first = choose_models(a), second = choose_models(b);
  ASSERT_TRUE(first && second);
  ASSERT_EQ(first->front().tried.size(), second->front().tried.size());
  for (std::size_t i = 0; i < first->front().tried.size(); ++i) {
    EXPECT_EQ(first->front().tried[i].label, second->front().tried[i].label);
    EXPECT_EQ(first->front().tried[i].error, second->front().tried[i].error);
    EXPECT_EQ(first->front().tried[i].cost, second->front().tried[i].cost);
  }
}

TEST(ModelChoice, WhatALevelSaysByAKeyStaysAtItsDefaultToo) {
  Level level = sheet_level(0.3);
  ASSERT_TRUE(set_key(level, "sheet.deformable.shape=volume"));
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices);
  EXPECT_EQ(level.nodes[0].deformable->shape, Shape::kVolume);
  EXPECT_NE(choices->front().sentence().find("the level itself says shape"), std::string::npos)
      << choices->front().sentence();
  EXPECT_FALSE(choices->front().within) << "a rim is no half-space";
}

TEST(ModelChoice, ALevelWithoutABudgetIsLeftAlone) {
  Level level = sheet_level(0.0);
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices);
  EXPECT_TRUE(choices->empty());
  EXPECT_EQ(level.nodes[0].deformable->shape, Shape::kVolume);
  Level empty;
  EXPECT_FALSE(set_error_budget(empty, 0.1));
}

TEST(ModelChoice, OneThatIsSlowerThanRealTimeSaysSo) {
  ModelChoice choice{"liver", "soft body", 0.1, {{"cell 4 mm", 0.05, 1200.0}}, 0, true, {}, {}, {}};
  EXPECT_NE(choice.sentence().find("that is slower than real time"), std::string::npos) << choice.sentence();
  choice.tried[0].cost = 1000.0;
  EXPECT_EQ(choice.sentence().find("slower"), std::string::npos) << choice.sentence();
  choice.tried[0].cost = 1200.0;
  choice.within = false;
  EXPECT_NE(choice.sentence().find("that is slower than real time; for less"), std::string::npos) << choice.sentence();
}

TEST(ModelChoice, WhereNoneIsWithinTheCheapestOfTheNearestIsTaken) {
  const std::vector<ModelCandidate> tried{{"a", 0.4, 5.0}, {"b", 0.2509, 8.0}, {"c", 0.2507, 296.0}, {"d", 0.3, 300.0}};
  EXPECT_EQ(cheapest_within(tried, 0.2), 1u) << "a hundredth nearer is not worth 288 us";
  EXPECT_EQ(cheapest_within(tried, 0.2508), 2u);
  EXPECT_EQ(cheapest_within(tried, 0.5), 0u);
}

// A surface and a body in one level: each alone has the candidates that both have together.
Level both_level() {
  Scene scene;
  DeformableParameters d;
  d.reach = kReach;
  d.error = 0.4;
  scene.add_surface("sheet", data_of(scenes::sheet(40, 0.16)), d);
  SoftBodyParameters body;
  body.young = 1e4;
  body.rayleigh = {0.0, 0.01};
  body.error = 0.8;
  scene.add_soft_body("slab", data_of(scenes::slab(6, 0.1, 0.05)), body);
  return scene.level();
}

TEST(ModelChoice, OneObjectAloneHasTheCandidatesThatAllTogetherHave) {
  Level all = both_level();
  const auto choices = choose_models(all);
  ASSERT_TRUE(choices) << choices.error().message();
  ASSERT_EQ(choices->size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) {
    Level level = both_level();
    const auto one = choose_model(level, n);
    ASSERT_TRUE(one) << one.error().message();
    const ModelChoice& other = (*choices)[n];
    ASSERT_EQ(one->size(), 1u);
    const ModelChoice& its = one->front();
    EXPECT_EQ(its.sentence(), other.sentence());
    ASSERT_EQ(its.tried.size(), other.tried.size());
    for (std::size_t i = 0; i < its.tried.size(); ++i) {
      EXPECT_EQ(its.tried[i].label, other.tried[i].label);
      EXPECT_EQ(its.tried[i].error, other.tried[i].error);
      EXPECT_EQ(its.tried[i].cost, other.tried[i].cost);
    }
    EXPECT_EQ(node_extensions(level.nodes[n], Json()), node_extensions(all.nodes[n], Json()));
    EXPECT_EQ(node_extensions(level.nodes[1 - n], Json()), node_extensions(both_level().nodes[1 - n], Json()))
        << "the other object is left alone";
    if (n == 1) EXPECT_EQ(level.simulation.soft_step, all.simulation.soft_step);
  }
}

TEST(ModelChoice, EveryKeyThatIsChosenIsNamedAsChoosableAndOneThatIsSaidIsNot) {
  for (const std::size_t n : {0u, 1u}) {
    Level level = both_level();
    const Json object = node_extensions(level.nodes[n], Json()), scene = scene_extensions(level, Json());
    std::vector<ChoosableKey> keys = choosable_keys(level, n);
    ASSERT_EQ(keys.size(), n == 0 ? 4u : 3u);
    for (const ChoosableKey& key : keys) EXPECT_EQ(key.said, key.key == "reach") << key.key;
    const auto choices = choose_model(level, n);
    ASSERT_TRUE(choices);
    EXPECT_GE(choices->front().keys.size(), 2u);
    for (const ChoosableKey& chosen : choices->front().keys)
      EXPECT_TRUE(std::any_of(keys.begin(), keys.end(), [&](const ChoosableKey& key) {
        return !key.said && key.extension == chosen.extension && key.key == chosen.key;
      })) << chosen.key;
    // Without them, everything is as it was.
    Level back = level;
    for (const ChoosableKey& key : keys) {
      const Extension& extension = *find_extension(key.extension);
      Level was = both_level();
      void* const owner = extension.on_scene ? static_cast<void*>(&back) : &back.nodes[n];
      const void* const before = extension.on_scene ? static_cast<const void*>(&was) : &was.nodes[n];
      const Key& it = *find_key(extension, key.key);
      it.set(owner, it.get(before));
    }
    EXPECT_EQ(node_extensions(back.nodes[n], Json()), object);
    EXPECT_EQ(scene_extensions(back, Json()), scene);
  }
  Level level = both_level();
  ASSERT_TRUE(set_keys(level, {"sheet.deformable.distance=chord", "*.simulation.soft_step=0.005"}));
  EXPECT_FALSE(choosable_keys(level, 0)[0].said);
  EXPECT_TRUE(choosable_keys(level, 0)[1].said) << "said at its default";
  EXPECT_TRUE(choosable_keys(level, 1)[2].said) << "soft_step";
  ASSERT_TRUE(set_key(level, "sheet.deformable.volume=0.5"));
  EXPECT_EQ(choosable_keys(level, 0).size(), 3u) << "`volume` stands for a shape";
}

TEST(ModelChoice, AWatchGetsTheProgressAndMayEndIt) {
  for (const std::size_t n : {0u, 1u}) {
    Level level = both_level();
    int calls = 0;
    const auto stopped = choose_model(level, n, [&](const std::string& doing) {
      EXPECT_NE(doing.find(level.nodes[n].name), std::string::npos);
      return ++calls < 3;
    });
    EXPECT_EQ(calls, 3);
    ASSERT_FALSE(stopped);
    EXPECT_NE(stopped.error().message().find("was not measured to the end"), std::string::npos);
    EXPECT_EQ(node_extensions(level.nodes[n], Json()), node_extensions(both_level().nodes[n], Json()));
  }
  Level level = sheet_level(0.0);
  const auto none = choose_model(level, 0);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message().find("has no error budget"), std::string::npos);
}

}  // namespace
}  // namespace pliant
