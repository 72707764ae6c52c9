// The key `expose`: what is wrong is one sentence, saving keeps it, and sliders follow names.
#include <gtest/gtest.h>

#include "content/author/edit_nodes.h"
#include "content/keys/extensions.h"
#include "content/keys/sliders.h"

namespace pliant::test {
namespace {

Level slider_level() {
  Level level;
  level.nodes.resize(3);
  level.nodes[0].name = "be.lly";
  level.nodes[0].deformable.emplace();
  level.nodes[1].name = "finger";
  level.nodes[1].probe.emplace();
  level.nodes[1].probe_device = "hand";
  level.nodes[2].name = "hand";
  level.nodes[2].device.emplace();
  return level;
}

Result<std::vector<Slider>> sliders(const std::string& items) {
  Level level = slider_level();
  const Json json{{"PLIANT_simulation", {{"expose", Json::parse(items)}}}};
  if (const Status read = parse_scene_extensions(json, "", level); !read) return read.error();
  return sliders_of(level);
}

TEST(Sliders, AreReadWithTheirBoundsAndWrittenAgain) {
  Level level = slider_level();
  const Json given = Json::parse(R"({"PLIANT_simulation": {"expose": [
      {"key": "be.lly.deformable.stiffness", "name": "Stiffness", "range": [100.0, 900.0], "step": 50.0},
      {"key": "hand.haptic_device.max_force"}]}})");
  ASSERT_TRUE(parse_scene_extensions(given, "", level).ok());
  const auto made = sliders_of(level);
  ASSERT_TRUE(made.ok()) << made.error().message();
  EXPECT_EQ((*made)[0].object + " " + (*made)[0].key + " " + (*made)[0].name, "be.lly stiffness Stiffness");
  EXPECT_EQ((*made)[0].unit, "N/m");
  EXPECT_EQ((*made)[0].low, 100.0);
  EXPECT_EQ((*made)[0].step, 50.0);
  EXPECT_EQ((*made)[1].object, "finger") << "a session names a device by what it moves";
  EXPECT_EQ((*made)[1].high, 50.0) << "the usual range";
  EXPECT_EQ(scene_extensions(level, Json()), given);
  ASSERT_TRUE(rename_node(level, 0, "skin").ok());
  EXPECT_EQ(level.simulation.expose[0].key, "skin.deformable.stiffness");
  forget_exposed(level.simulation, "skin", "deformable");
  EXPECT_EQ(level.simulation.expose.size(), 1u);
}

TEST(Sliders, WhatIsWrongIsOneSentence) {
  const auto expect = [](const std::string& items, const std::string& part) {
    const auto made = sliders(items);
    ASSERT_FALSE(made.ok()) << items;
    EXPECT_NE(made.error().message().find(part), std::string::npos) << items << '\n' << made.error().message();
  };
  expect(R"([{"key": "stiffness"}])", "item 1: names 'stiffness', which is not NODE.EXTENSION.KEY");
  expect(R"([{"key": "belly.deformable.stiffness"}])", "did you mean be.lly?");
  expect(R"([{"key": "be.lly.deformable.shape"}])", "is no single number");
  expect(R"([{"key": "be.lly.deformable.crease_angle"}])", "is read when the session opens");
  expect(R"([{"key": "be.lly.deformable.stiffness", "range": [9, 1]}])", "begins above its end");
  expect(R"([{"key": "be.lly.deformable.stiffness", "range": [-1, 1]}])", "narrow it");
  expect(R"([{"key": "be.lly.deformable.stiffness", "range": [1, 2], "step": 3}])", "wider than its range");
  expect(R"([{"key": "be.lly.deformable.stiffness", "colour": 1}])", "item 1 of expose");
}

}  // namespace
}  // namespace pliant::test
