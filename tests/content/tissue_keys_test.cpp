// `prony`, `cavities`, `rigid` and `fibres` of PLIANT_soft_body: what is wrong is one sentence, saving keeps every key,
// and a hollow is found in tetrahedra.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "content/keys/extension_table.h"
#include "content/level/tissue_cavities.h"
#include "tests/content/mesh_shapes.h"

namespace pliant::test {
namespace {

Result<LevelNode> soft_node(const std::string& keys) {
  LevelNode node;
  const Json json{{"PLIANT_soft_body", Json::parse(keys)}};
  if (const Status status = parse_node_extensions(json, "file", {}, node); !status) return status.error();
  return node;
}

TEST(TissueKeys, WhatIsWrongIsOneSentence) {
  const auto expect = [](const std::string& keys, const std::string& part) {
    const Result<LevelNode> node = soft_node(keys);
    ASSERT_FALSE(node.ok()) << keys;
    const std::string message = node.error().message();
    EXPECT_NE(message.find(part), std::string::npos) << keys << '\n' << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  expect(R"({"prony": [{"share": 1.2}]})", "item 1: `share` must be in the range [0, 1]; got 1.2");
  expect(R"({"prony": [{"share": 0.2, "time": 0}]})", "item 1: `time` must be in the range");
  expect(R"({"prony": [{"share": 0.5}, {"share": 0.5}]})", "its shares are 1 together");
  expect(R"({"prony": [{"share": 0.6}], "materials": [{"name": "a", "relaxation": 2}]})", "a part has 2 times these");
  expect(R"({"prony": [{}, {}, {}, {}]})", "must be a list of at most 3 objects");
  expect(R"({"fibres": {"young": 1000, "direction": [0, 0, 0]}})", "has no direction");
  expect(R"({"fibres": {"young": 1000, "contraction": 0.95}})", "must be in the range [0, 0.9]");
  expect(R"({"cavities": [{"bulk": -1}]})", "item 1: `bulk` must be in the range");
}

TEST(TissueKeys, WhatExcludesEachOtherIsAFault) {
  const auto fault = [](const std::string& keys) {
    Result<LevelNode> node = soft_node(keys);
    EXPECT_TRUE(node.ok()) << keys;
    node->mesh = 0;
    const std::optional<Note> found = soft_fault(*node);
    return found ? found->code : std::string();
  };
  EXPECT_EQ(fault(R"({"prony": [{"share": 0.3}]})"), "");
  EXPECT_EQ(fault(R"({"prony": [{"share": 0.3}], "elements": "hexahedra"})"), "");
  EXPECT_EQ(fault(R"({"prony": [{"share": 0.3}], "contact": "split"})"), "level.not_with_split");
  EXPECT_EQ(fault(R"({"fibres": {"young": 1000}, "contact": "split"})"), "level.not_with_split");
  EXPECT_EQ(fault(R"({"prony": [{"share": 0.3}], "integrator": "second_order"})"), "level.not_with_integrator");
  EXPECT_EQ(fault(R"({"cavities": [{"name": "", "pressure": 100}], "integrator": "quasi_static"})"),
            "level.not_with_integrator");
  EXPECT_EQ(fault(R"({"fibres": {"young": 1000}, "elements": "hexahedra"})"), "level.not_of_hexahedra");
  EXPECT_EQ(fault(R"({"cavities": [{"pressure": 1000}], "elements": "hexahedra"})"), "level.not_of_hexahedra");
  const auto of_bone = [&](const std::string& name, const std::string& rest) {
    return fault(R"({"rigid": [{"name": ")" + name + R"(", "box": {"min": [0, 0, 0], "max": [1, 1, 1]}}])" + rest +
                 "}");
  };
  EXPECT_EQ(of_bone("tip", ""), "");
  EXPECT_EQ(of_bone("handle", ""), "level.rigid_name");
  EXPECT_EQ(of_bone("tip\"}, {\"name\": \"tip", ""), "level.rigid_box");
  for (const char* other : {R"("law": "neo_hookean")", R"("integrator": "second_order")", R"("contact": "split")",
                            R"("cavities": [{"pressure": 1000}])"})
    EXPECT_EQ(of_bone("tip", std::string(", ") + other), "level.not_with_rigid") << other;
}

TEST(TissueKeys, SavingKeepsEveryKey) {
  const Json given = Json::parse(R"({"PLIANT_soft_body": {
      "prony": [{"share": 0.25, "time": 0.125}, {"share": 0.5, "time": 2.0}],
      "cavities": [{"pressure": 1500.0, "bulk": 1e9}, {"name": "gall", "pressure": 0.0, "bulk": 1e6}],
      "rigid": [{"name": "tip", "box": {"min": [0.0, 0.125, 0.0], "max": [1.0, 1.0, 2.0]}}, {"name": "bare"}],
      "fibres": {"young": 3e4, "direction": [0.0, 1.0, 0.0], "only_tension": true, "contraction": 0.125, "period": 0.5}}})");
  LevelNode node;
  ASSERT_TRUE(parse_node_extensions(given, "", {}, node).ok());
  EXPECT_EQ(node.soft_body->prony.count, 2u);
  EXPECT_EQ(node.soft_body->prony.arms[1].time, 2.0);
  EXPECT_EQ(node.soft_body->cavities[1].name, "gall");
  EXPECT_EQ(node.soft_body->fibres.direction.y, 1.0);
  const Json saved = node_extensions(node, {});
  LevelNode again;
  ASSERT_TRUE(parse_node_extensions(saved, "", {}, again).ok()) << saved.dump();
  EXPECT_TRUE(again.soft_body->prony == node.soft_body->prony);
  EXPECT_TRUE(again.soft_body->cavities == node.soft_body->cavities);
  EXPECT_EQ(node.soft_body->rigid[0].box.min.y, 0.125);
  EXPECT_TRUE(again.soft_body->rigid == node.soft_body->rigid);
  EXPECT_TRUE(again.soft_body->fibres == node.soft_body->fibres);
}

// A ball of radius 1 with a hollow of radius 0.6, and a mesh around that.
struct HollowBall {
  HollowBall() {
    level.nodes.resize(2), level.meshes.resize(2);
    Primitive outer = icosphere(3), inner = icosphere(3), around = icosphere(2);
    for (vec3& p : inner.position) p *= 0.6f;
    for (vec3& p : around.position) p *= 0.8f;
    for (std::size_t i = 0; i + 2 < inner.index.size(); i += 3) std::swap(inner.index[i + 1], inner.index[i + 2]);
    inner.normal.clear(), outer.normal.clear();
    level.meshes[0].primitives = {outer, inner};
    level.meshes[1].primitives = {around};
    SoftBody& body = level.nodes[0].soft_body.emplace();
    body.cell = 0.2, body.fill = Fill::kWall;
    level.nodes[0].name = "bladder", level.nodes[1].name = "gall";
    level.nodes[0].mesh = 0, level.nodes[1].mesh = 1;
    level.nodes[0].in_scene = level.nodes[1].in_scene = true;
    Result<SoftParts> made = make_soft_parts(level.nodes[0], &level.meshes[0], mat4(1), {});
    EXPECT_TRUE(made.ok()) << (made ? "" : made.error().message());
    parts = std::move(*made);
  }
  Status set() {
    parts.tets.cavities.clear();
    return set_cavities(level, level.nodes[0], dmat4(1), {dmat4(1), dmat4(1)}, parts);
  }
  Level level;
  SoftParts parts;
};

TEST(TissueKeys, AHollowIsFoundWithItsVolume) {
  HollowBall its;
  for (const char* name : {"", "gall"}) {
    its.level.nodes[0].soft_body->cavities = {{.name = name, .pressure = 100.0, .bulk = 1e6}};
    const Status set = its.set();
    ASSERT_TRUE(set.ok()) << set.error().message();
    ASSERT_EQ(its.parts.tets.cavities.size(), 1u);
    double six = 0.0;
    const std::vector<dvec3>& x = its.parts.tets.nodes;
    for (const uvec3 t : its.parts.tets.cavities[0].wall) six += dot(x[t.x], cross(x[t.y], x[t.z]));
    const double want = 4.0 / 3.0 * std::numbers::pi * 0.216;
    EXPECT_NEAR(six / 6, want, 0.05 * want);
    EXPECT_EQ(its.parts.tets.cavities[0].pressure, 100.0);
  }
  its.level.nodes[0].soft_body->cavities = {{.name = "nowhere"}};
  EXPECT_NE(its.set().error().message().find("names `nowhere`, which is no node"), std::string::npos);
  its.level.nodes[0].soft_body->cavities = {{.name = "gall"}, {}};
  EXPECT_NE(its.set().error().message().find("no hollow remains"), std::string::npos);
  its.level.meshes[0].primitives.pop_back();
  its.parts = *make_soft_parts(its.level.nodes[0], &its.level.meshes[0], mat4(1), {});
  EXPECT_NE(its.set().error().message().find("no closed hollow"), std::string::npos);
}

}  // namespace
}  // namespace pliant::test
