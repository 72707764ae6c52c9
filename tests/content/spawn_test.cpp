#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "content/level/script.h"
#include "content/level_file.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::icosphere;
using test::level_of;

LevelNode named(const std::string& name) {
  LevelNode node;
  node.name = name;
  return node;
}

World spawned_level(const Level& level) {
  Result<World> world = spawn(level);
  EXPECT_TRUE(world.ok()) << world.error().message();
  return std::move(*world);
}

TEST(Spawn, BakesScaleAndMirrorSoThatTouchNormalsPointOutwardAndTheWorldPositionIsExact) {
  for (const vec3& scale : {vec3(1), vec3(0.1f, 0.2f, 0.3f), vec3(-0.5f, 1, 1), vec3(1, -2, -1)}) {
    LocalTransform local;
    local.translation = {1, 2, 3};
    local.rotation = glm::angleAxis(0.7f, normalize(vec3(1, 2, -1)));
    local.scale = scale;
    const Primitive sphere = icosphere(5);  // fine enough not to be refined
    const World world = spawned_level(level_of(sphere, local));
    const Entity thing = find_by_name(world, "thing");
    const Deformable& deformable = world.registry.get<Deformable>(thing);
    const Pose& pose = world.registry.get<Pose>(thing);
    const Mesh& mesh = world.meshes[deformable.mesh];
    ASSERT_EQ(mesh.vertex_count, sphere.position.size());

    // After inverse scale and rotation, every touch vertex is a point of the unit sphere.
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      const dvec3 at_world = pose.to_world(dvec3(mesh.position(v)));
      const dvec3 rotated_back = glm::conjugate(dquat(local.rotation)) * (at_world - dvec3(local.translation));
      EXPECT_NEAR(length(rotated_back / dvec3(scale)), 1.0, 2e-5);
      EXPECT_GT(dot(mesh.normal(v), mesh.position(v)), 0.0f);
    }
    EXPECT_NEAR(deformable.reach, 0.08 * static_cast<double>(mesh.box.diagonal()), 1e-12);
    EXPECT_TRUE(deformable.field.valid());
  }
}

TEST(Spawn, ShearFromANonUniformParentIsBakedIntoTheMesh) {
  Level level = level_of(icosphere(2));
  level.nodes[0].deformable->reach = 100.0;  // so wide that the mesh is not refined
  LevelNode parent = named("parent");
  parent.local.scale = {1, 3, 1};
  parent.children = {1};
  level.nodes[0].parent = 0;
  level.nodes[0].local.rotation = glm::angleAxis(0.6f, vec3(0, 0, 1));
  level.nodes.insert(level.nodes.begin(), parent);
  const World world = spawned_level(level);
  const Entity thing = find_by_name(world, "thing");
  const Pose& pose = world.registry.get<Pose>(thing);
  const Mesh& mesh = world.meshes[world.registry.get<Deformable>(thing).mesh];
  EXPECT_NEAR(glm::length(pose.rotation), 1.0, 1e-12);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const dvec3 p = pose.to_world(dvec3(mesh.position(v)));
    EXPECT_NEAR(length(p / dvec3(1, 3, 1)), 1.0, 1e-5);  // a rotated unit sphere, stretched along world Y
  }
}

TEST(Spawn, NodesBecomeEntitiesInOrderUnderTheirParentsAndOnlyThoseOfTheScene) {
  Level level = level_of(icosphere(0));
  level.nodes.push_back(named("hidden"));
  level.nodes[1].in_scene = false;
  level.nodes.push_back(named("child"));
  level.nodes[2].parent = 0;
  level.nodes[2].local.translation = {0, 5, 0};
  level.nodes[0].local.translation = {1, 0, 0};
  const World world = spawned_level(level);
  const Entity thing = find_by_name(world, "thing"), child = find_by_name(world, "child");
  EXPECT_EQ(find_by_name(world, "hidden"), kNoEntity);
  const std::vector<Hierarchy::Link>& order = world.hierarchy.order();
  ASSERT_EQ(order.size(), 2u);
  EXPECT_EQ(order[0].entity, thing);
  EXPECT_EQ(order[1].entity, child);
  EXPECT_EQ(order[1].parent, 0);
  EXPECT_EQ(vec3(world.registry.get<WorldTransform>(child).matrix[3]), vec3(1, 5, 0));
}

TEST(Spawn, NodesThatBakeTheSameFrameShareOneMeshButNotTheirHeights) {
  Level level = level_of(icosphere(1));
  level.nodes.push_back(level.nodes[0]);
  level.nodes[1].name = "elsewhere";
  level.nodes[1].local.translation = {4, 0, 0};
  level.nodes.push_back(level.nodes[0]);
  level.nodes[2].name = "larger";
  level.nodes[2].local.scale = vec3(2);
  const World world = spawned_level(level);
  EXPECT_EQ(world.meshes.size(), 2u);
  EXPECT_EQ(world.draw_meshes.size(), 2u);
  EXPECT_EQ(world.fields.size(), 3u);
}

TEST(Spawn, WhatDoesNotGiveWayIsOnlyDrawn) {
  Level level = level_of(icosphere(1));
  level.nodes[0].deformable.reset();
  const World world = spawned_level(level);
  const Entity thing = find_by_name(world, "thing");
  EXPECT_FALSE(world.registry.has<Deformable>(thing));
  EXPECT_TRUE(world.registry.has<Pose>(thing));
  EXPECT_EQ(world.meshes.size(), 0u);
  const DrawMesh& draw = world.draw_meshes[world.registry.get<Drawable>(thing).mesh];
  for (std::uint32_t v = 0; v < draw.vertices.size(); ++v) EXPECT_EQ(draw.vertices[v].touch_vertex, v);
}

TEST(Spawn, AProbeFindsTheDeviceItNamesOrItsOwn) {
  Level level = level_of(icosphere(0));
  LevelNode tip = named("tip"), hand = named("hand"), other = named("other");
  tip.probe = Probe{};
  tip.probe_device = "hand";
  tip.local.translation = {0, 1, 0};
  hand.device = HapticDevice{};
  other.probe = Probe{};
  other.device = HapticDevice{};
  level.nodes.insert(level.nodes.end(), {tip, other, hand});
  const World world = spawned_level(level);
  EXPECT_EQ(world.registry.get<Probe>(find_by_name(world, "tip")).device, find_by_name(world, "hand"));
  EXPECT_EQ(world.registry.get<Probe>(find_by_name(world, "tip")).position, dvec3(0, 1, 0));
  EXPECT_EQ(world.registry.get<Probe>(find_by_name(world, "other")).device, find_by_name(world, "other"));

  level.nodes[1].probe_device = "nobody";
  Result<World> refused = spawn(level);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message(), testing::AllOf(testing::HasSubstr("`tip`"), testing::HasSubstr("`nobody`")));
}

TEST(Spawn, ADeviceThatTwoProbesOrToolsNameIsRefusedByAllThreeNames) {
  Level level = level_of(icosphere(0));
  LevelNode left = named("left"), right = named("right"), hand = named("hand");
  left.probe = right.probe = Probe{};
  left.probe_device = right.probe_device = "hand";
  hand.device = HapticDevice{};
  level.nodes.insert(level.nodes.end(), {left, hand, right});
  const auto all_three = [](const std::string& said, const char* second) {
    EXPECT_THAT(said, testing::AllOf(testing::HasSubstr("`hand`"), testing::HasSubstr("`left`"),
                                     testing::HasSubstr(second), testing::HasSubstr("of its own")));
  };
  Result<World> refused = spawn(level);
  ASSERT_FALSE(refused.ok());
  all_three(refused.error().message(), "`right`");

  level.nodes[3].probe_device.clear();  // moved by no device
  EXPECT_TRUE(spawn(level).ok());
  level.nodes[2].probe = Probe{};  // the device's own node is a probe
  refused = spawn(level);
  ASSERT_FALSE(refused.ok());
  all_three(refused.error().message(), "node `hand`");
  level.nodes[2].probe.reset();

  level.nodes[0].deformable.reset();
  level.nodes[0].soft_body = SoftBody{{.cell = 0.5}};
  level.nodes[0].handle = Handle6{{.box = Box{{-2, 0, -2}, {2, 2, 2}}}, "hand"};
  refused = spawn(level);
  ASSERT_FALSE(refused.ok());
  all_three(refused.error().message(), "`thing`");
  level.nodes[1].in_scene = false;  // a device outside the scene moves nothing
  refused = spawn(level);
  EXPECT_TRUE(refused.ok()) << refused.error().message();
}

TEST(Spawn, MissingScriptAndPanoramaAreErrorsThatNameTheFile) {
  Level level = level_of(icosphere(0));
  level.nodes[0].device = HapticDevice{};
  level.nodes[0].device->driver = DriverKind::kScript;
  level.nodes[0].device->file = "no_such_script.csv";
  EXPECT_THAT(spawn(level).error().message(), testing::HasSubstr("no_such_script.csv"));
  level.nodes[0].device.reset();
  level.environment = LevelEnvironment{"no_such_sky.exr", 1.0, 0.0};
  EXPECT_THAT(spawn(level).error().message(), testing::HasSubstr("no_such_sky.exr"));
}

TEST(Script, ReadsPositionsAndPosesWithCommentsAndEitherLineEnd) {
  const Result<Path> positions = parse_script("# sweep\r\ntime_s,x,y,z\r\n0,1,2,3\r\n\r\n0.5, -1e-3 ,0,0\r\n", "s.csv");
  ASSERT_TRUE(positions.ok());
  ASSERT_EQ(positions->rows.size(), 2u);
  EXPECT_EQ(positions->rows[1].time, 0.5);
  EXPECT_EQ(positions->rows[1].position, dvec3(-1e-3, 0, 0));
  EXPECT_FALSE(positions->repeats);
  // As written by a spreadsheet, and by hand.
  for (const char* text :
       {"\xEF\xBB\xBFtime_s,x,y,z\r\n0,1,2,3\r\n0.5,-0.001,0,0\r\n", "time_s, x, y, z\n0, 1, 2, 3\n0.5, -0.001, 0, 0\n",
        "\xEF\xBB\xBF# sweep\r\n time_s ,\tx , y, z \r\n 0 ,\t1, 2 , 3 \r\n0.5,-1e-3,0,0"}) {
    const Result<Path> same = parse_script(text, "s.csv");
    ASSERT_TRUE(same.ok()) << text << same.error().message();
    ASSERT_EQ(same->rows.size(), 2u) << text;
    EXPECT_EQ(same->rows[0].position, dvec3(1, 2, 3)) << text;
    EXPECT_EQ(same->rows[1].time, 0.5) << text;
    EXPECT_EQ(same->rows[1].position, dvec3(-1e-3, 0, 0)) << text;
  }
  EXPECT_TRUE(parse_script("time_s, x, y, z, qw, qx, qy, qz\n0, 0, 0, 0, 1, 0, 0, 0", "s.csv")->turns);
  const Result<Path> poses = parse_script("time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,0,0,2,0", "s.csv");
  ASSERT_TRUE(poses.ok());
  EXPECT_EQ(poses->rows[0].rotation, dquat(0, 0, 1, 0));
}

TEST(Script, RefusesWhatIsNotAScriptAndNamesTheLine) {
  const std::pair<const char*, const char*> bad[] = {
      {"", "s.csv: "},
      {"time_s,x,y,z\n", "s.csv: "},
      {"t,x,y,z\n0,0,0,0\n", "s.csv:1: "},
      {"time_s,x,y,z\n0,0,0\n", "s.csv:2: "},
      {"time_s,x,y,z\n0,0,0,0,0\n", "s.csv:2: "},
      {"time_s,x,y,z\n0,0,0,zero\n", "s.csv:2: "},
      {"time_s,x,y,z\n0,0,0,1 2\n", "s.csv:2: "},
      {"time_s,x,y,z\n0,0,nan,0\n", "s.csv:2: "},
      {"time_s,x,y,z\n0,0,inf,0\n", "s.csv:2: "},
      {"time_s,x,y,z\n0,0,1e999,0\n", "s.csv:2: "},
      {"time_s,x,y,z\n1,0,0,0\n1,0,0,0\n", "s.csv:3: "},
      {"time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,0,0,0,0\n", "s.csv:2: "},
  };
  for (const auto& [text, where] : bad) {
    const Result<Path> path = parse_script(text, "s.csv");
    ASSERT_FALSE(path.ok()) << text;
    EXPECT_THAT(path.error().message(), testing::StartsWith(where)) << text;
    EXPECT_NE(path.error().cure, "") << text;
  }
}

TEST(Script, AFolderOrAMissingFileIsAnErrorNotAnEmptyPath) {
  EXPECT_FALSE(load_script(std::filesystem::temp_directory_path()).ok());
  EXPECT_FALSE(load_script("no/such/script.csv").ok());
}

}  // namespace
}  // namespace pliant
