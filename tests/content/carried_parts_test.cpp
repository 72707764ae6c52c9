// Meshes that are only drawn and lie inside a deformable object.
#include "content/level/carried_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "content/author/organ.h"
#include "content/level_file.h"
#include "content/validate.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Primitive ball_of(float radius, vec3 centre = vec3(0), int finer = 2) {
  Primitive ball = test::icosphere(finer);
  for (vec3& p : ball.position) p = radius * p + centre;
  ball.normal.clear();
  return ball;
}

// A capsule of 50 mm, a lump inside, a vessel that reaches out by less than half, and a stone beside it.
Level organ() {
  Level level = test::level_of(ball_of(0.05f, vec3(0), 3));
  level.nodes[0].name = "capsule";
  level.nodes[0].deformable.reset();
  const auto add = [&](const char* name, const Primitive& p) {
    LevelNode node;
    node.name = name;
    node.mesh = static_cast<std::int32_t>(level.meshes.size());
    level.meshes.push_back({name, {p}});
    level.nodes.push_back(node);
  };
  add("lump", ball_of(0.01f, vec3(0.02f, 0, 0)));
  add("vessel", ball_of(0.02f, vec3(0, 0.04f, 0)));
  add("stone", ball_of(0.01f, vec3(0.2f, 0, 0)));
  return level;
}

TEST(CarriedParts, AnOrganIsTheOutermostMeshAndWhatLiesInside) {
  const Level level = organ();
  for (const std::int32_t any : {0, 1, 2}) {
    const Result<Organ> found = organ_of(level, any);
    ASSERT_TRUE(found.ok());
    EXPECT_EQ(found->body, 0) << any;
    EXPECT_THAT(found->parts, ElementsAre(1, 2));
  }
  EXPECT_TRUE(organ_of(level, 3)->parts.empty());
}

TEST(CarriedParts, OneClickTakesThemAllAlong) {
  Level level = organ();
  const Result<std::string> names = make_soft_organ(level, 1);
  ASSERT_TRUE(names.ok());
  EXPECT_EQ(*names, "`lump`, `vessel`");
  ASSERT_TRUE(level.nodes[0].soft_body);
  EXPECT_EQ(level.nodes[0].soft_body->carries, Carries::kInside);
  EXPECT_EQ(level.nodes[0].soft_body->under_gravity, UnderGravity::kModelled);
  Result<World> world = spawn(level);
  ASSERT_TRUE(world.ok()) << world.error().message();
  const TetMesh& tets = world->tet_meshes[world->registry.get<SoftBody>(find_by_name(*world, "capsule")).tets];
  ASSERT_EQ(tets.parts.size(), 2u);
  for (const CarriedPart& part : tets.parts) {  // at rest they are where they were drawn
    const Mesh& mesh = world->meshes[part.mesh];
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      dvec3 at = part.aside.empty() ? dvec3(0) : dvec3(part.aside[v]);
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        at += part.embedding[v].weight[k] * tets.nodes[tets.tets[part.embedding[v].tet][k]];
        sum += part.embedding[v].weight[k];
      }
      EXPECT_LT(length(at - dvec3(mesh.position(v))), 1e-6);
      EXPECT_NEAR(sum, 1.0, 1e-9);
    }
  }
}

TEST(CarriedParts, WhatIsLeftBehindIsNamed) {
  Level level = organ();
  ASSERT_TRUE(make_soft(level, 0).ok());
  std::vector<std::string> notes;
  ASSERT_TRUE(spawn(level, &notes).ok());
  EXPECT_THAT(notes, ::testing::Contains(
                         HasSubstr("leaves behind what lies inside of it and is only drawn (`lump`, `vessel`)")));
  bool warned = false;
  for (const Finding& finding : validate_level(level, {}))
    warned = warned ||
             (finding.severity == Severity::kWarning && finding.message().find("leaves behind") != std::string::npos);
  EXPECT_TRUE(warned);
}

TEST(CarriedParts, ADentTakesAlongWhatLiesRightBelowTheSurface) {
  Level level = organ();
  level.nodes[0].deformable = Deformable{};
  level.nodes[0].deformable->carries = Carries::kInside;
  level.nodes[0].deformable->reach = 0.02;
  Result<World> world = spawn(level);
  ASSERT_TRUE(world.ok()) << world.error().message();
  const Carried* lump = world->registry.find<Carried>(find_by_name(*world, "lump"));
  ASSERT_NE(lump, nullptr);
  // Its outer end lies 20 mm below the surface, its inner one 40 mm.
  float most = 0.0f, least = 1.0f;
  for (const float share : lump->share) most = std::max(most, share), least = std::min(least, share);
  EXPECT_GT(most, 0.1f);
  EXPECT_EQ(least, 0.0f);
  EXPECT_EQ(world->registry.find<Carried>(find_by_name(*world, "stone")), nullptr);
}

}  // namespace
}  // namespace pliant
