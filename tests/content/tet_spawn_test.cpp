// From a level to tissue: spawning PLIANT_soft_body, PLIANT_handle and PLIANT_rigid_body, and their errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "components/mass_properties.h"
#include "content/gltf/write/gltf_save.h"
#include "content/level_file.h"
#include "content/tets/tet_quality.h"
#include "content/validate.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::icosphere;
using test::level_of;
using test::sheet;
using testing::HasSubstr;

// A ball of tissue of radius 0.05 m.
Level ball(const LocalTransform& local = {}) {
  Primitive sphere = icosphere(3);
  for (vec3& p : sphere.position) p *= 0.05f;
  Level level = level_of(sphere, local);
  level.nodes[0].deformable.reset();
  level.nodes[0].soft_body = SoftBody{};
  level.nodes[0].soft_body->cell = 0.02;
  return level;
}

// Vertices that lie on faces of elements, where rounding puts them in none and at no distance from any.
TEST(TetSpawn, ACornerOnTheLatticeIsEmbedded) {
  for (const float edge : {0.05f, 0.1f, 0.2f}) {
    Primitive corner;
    corner.position = {{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}, {0, 0, edge}};
    corner.index = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    Level level = level_of(corner);
    level.nodes[0].deformable.reset();
    level.nodes[0].soft_body = SoftBody{};
    const Result<World> world = spawn(level);
    EXPECT_TRUE(world.ok()) << world.error().message();
  }
}

World spawned_tets(const Level& level) {
  Result<World> world = spawn(level);
  EXPECT_TRUE(world.ok()) << world.error().message();
  return world ? std::move(*world) : World{};
}
std::string refusal(const Level& level) {
  const Result<World> world = spawn(level);
  return world ? "" : world.error().message();
}

// A file that is removed with the test.
struct Temporary {
  explicit Temporary(const std::string& name, const std::string& text)
      : path(std::filesystem::temp_directory_path() / (std::to_string(::getpid()) + name)) {
    std::ofstream(path) << text;
  }
  ~Temporary() { std::filesystem::remove(path); }
  std::filesystem::path path;
};

const char* const kBlock =
    "# vtk DataFile Version 3.0\ncube of one metre, five tetrahedra\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "POINTS 8 double\n0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1\n"
    "CELLS 5 25\n4 0 1 2 4\n4 3 2 1 7\n4 5 4 7 1\n4 6 7 4 2\n4 1 2 4 7\nCELL_TYPES 5\n10 10 10 10 10\n";

TEST(SpawnSoft, TissueHasTetrahedraASurfaceADrawableAndAPose) {
  LocalTransform local;
  local.translation = {1, 2, 3};
  local.rotation = glm::angleAxis(0.7f, normalize(vec3(1, 2, -1)));
  local.scale = {2, 1, 1};
  const World world = spawned_tets(ball(local));
  const Entity thing = find_by_name(world, "thing");
  const SoftBody& body = world.registry.get<SoftBody>(thing);
  const TetMesh& tets = world.tet_meshes[body.tets];
  const Mesh& collision_mesh = world.meshes[body.collision_mesh];
  EXPECT_EQ(world.registry.get<Pose>(thing).position, dvec3(1, 2, 3));
  EXPECT_FALSE(world.registry.has<Deformable>(thing));
  ASSERT_EQ(tets.embedding.size(), collision_mesh.vertex_count);
  EXPECT_EQ(tets.free_count, tets.node_count());
  // The scale is baked in: an ellipsoid of half axes 0.1, 0.05, 0.05 m.
  EXPECT_NEAR(collision_mesh.box.size().x, 0.2f, 1e-6f);
  EXPECT_NEAR(total_volume(tets), mass_properties(collision_mesh).volume, 0.05 * total_volume(tets));
  for (const DrawVertex& v : world.draw_meshes[world.registry.get<Drawable>(thing).mesh].vertices)
    EXPECT_EQ(collision_mesh.position(v.touch_vertex), v.position);
}

TEST(SpawnSoft, NodesStandInTheOrderFreeHandlePinnedByTheirBoxes) {
  Level level = ball();
  level.nodes[0].soft_body->pinned = {{-1, -1, -1}, {1, -0.023f, 1}};
  level.nodes[0].handle = Handle6{};
  level.nodes[0].handle->box = {{-1, 0.023f, -1}, {1, 1, 1}};
  const World world = spawned_tets(level);
  const TetMesh& tets = world.tet_meshes[world.registry.get<SoftBody>(find_by_name(world, "thing")).tets];
  EXPECT_GT(tets.free_count, 0u);
  EXPECT_GT(tets.handle_count, 0u);
  EXPECT_LT(tets.pinned_begin(), tets.node_count());
  for (std::uint32_t n = 0; n < tets.node_count(); ++n) {
    const double y = tets.nodes[n].y;
    EXPECT_EQ(n < tets.free_count, std::abs(y) < 0.023) << y;
    EXPECT_EQ(n >= tets.pinned_begin(), y < -0.023) << y;
  }
  EXPECT_TRUE(world.registry.has<Handle6>(find_by_name(world, "thing")));
}

TEST(SpawnSoft, RigidPartsHaveTheNodesOfTheirBoxesAndMayNotOverlap) {
  Level level = ball();
  SoftBody& body = *level.nodes[0].soft_body;
  body.pinned = {{-1, -1, -1}, {1, 1, 1}};  // they win over pins
  body.rigid = {{"left", {{-1, -1, -1}, {-0.015, 1, 1}}}, {"right", {{0.015, -1, -1}, {1, 0, 1}}}};
  body.pinned.max.y = -0.03f;
  level.nodes[0].handle = Handle6{};
  level.nodes[0].handle->box = {{-0.01f, 0.0f, -1}, {0.01f, 1, 1}};
  const World world = spawned_tets(level);
  const TetMesh& tets = world.tet_meshes[world.registry.get<SoftBody>(find_by_name(world, "thing")).tets];
  ASSERT_EQ(tets.rigid_counts.size(), 2u);
  const std::uint32_t right = tets.rigid_begin() + tets.rigid_counts[0];
  for (std::uint32_t n = 0; n < tets.node_count(); ++n) {
    EXPECT_EQ(n >= tets.rigid_begin() && n < right, tets.nodes[n].x < -0.015);
    const bool of_right = n >= right && n < tets.pinned_begin();
    EXPECT_EQ(of_right, tets.nodes[n].x > 0.015 && tets.nodes[n].y < 1e-6);  // a box holds the nodes on its faces
  }
  const auto refused = [&](DBox box) {
    body.rigid[1].box = box;
    return refusal(level);
  };
  EXPECT_NE(refused({{-1, -1, -1}, {0, 1, 1}}).find("`right`: overlaps `left`"), std::string::npos);
  EXPECT_NE(refused({{-0.01, 0, -1}, {0.01, 1, 1}}).find("`right`: overlaps the handle"), std::string::npos);
  EXPECT_NE(refused({{2, 2, 2}, {3, 3, 3}}).find("`right`: holds no node"), std::string::npos);
}

TEST(SpawnSoft, PaintHoldsTheNodesBeneathIt) {
  Level level = ball();
  Primitive& collision_mesh = level.meshes[0].primitives[0];
  for (const vec3& p : collision_mesh.position) {
    collision_mesh.pinned.push_back(p.y < -0.02f ? 1.0f : 0.0f);
    collision_mesh.handle.push_back(p.y > 0.02f ? 0.7f : 0.3f);
  }
  level.nodes[0].handle = Handle6{};
  const World world = spawned_tets(level);
  const TetMesh& tets = world.tet_meshes[world.registry.get<SoftBody>(find_by_name(world, "thing")).tets];
  EXPECT_GT(tets.handle_count, 0u);
  for (std::uint32_t n = 0; n < tets.node_count(); ++n) {
    if (length(tets.nodes[n]) < 0.04) continue;  // deep inside, the nearest vertex is arbitrary
    const double y = tets.nodes[n].y * 0.05 / length(tets.nodes[n]);
    if (std::abs(std::abs(y) - 0.02) < 0.006) continue;  // within an edge of the paint's border
    EXPECT_EQ(n < tets.free_count, std::abs(y) < 0.02) << y;
    EXPECT_EQ(n >= tets.pinned_begin(), y < -0.02) << y;
  }
}

TEST(SpawnSoft, PaintIsReadFromAndWrittenToFiles) {
  Level level = ball();
  Primitive& collision_mesh = level.meshes[0].primitives[0];
  collision_mesh.pinned.assign(collision_mesh.position.size(), 0.25f);
  collision_mesh.handle.assign(collision_mesh.position.size(), 0.75f);
  const Result<Bytes> glb = level_as_glb(level);
  ASSERT_TRUE(glb.ok());
  const Result<Level> back = load_gltf(*glb, true, {});
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back->meshes[0].primitives[0].pinned, collision_mesh.pinned);
  EXPECT_EQ(back->meshes[0].primitives[0].handle, collision_mesh.handle);
}

TEST(SpawnSoft, AFileOfTetrahedraStandsInTheNodesFrameWithItsBoundaryOrTheNodesMeshAsSurface) {
  const Temporary file("block.vtk", kBlock);
  Level level = ball();
  level.path = file.path.parent_path() / "level.gltf";
  level.nodes[0].soft_body->mesh = file.path.filename().string();
  level.nodes[0].local.scale = vec3(-0.1f, 0.1f, 0.1f);  // mirrored: elements are reversed
  level.nodes[0].mesh = -1;
  const World world = spawned_tets(level);
  const SoftBody& body = world.registry.get<SoftBody>(find_by_name(world, "thing"));
  const TetMesh& tets = world.tet_meshes[body.tets];
  EXPECT_EQ(tets.node_count(), 8u);
  EXPECT_EQ(tets.tets.size(), 5u);
  for (const Tet& t : tets.tets) EXPECT_GT(tet_volume(tets.nodes, t), 0.0);
  EXPECT_NEAR(total_volume(tets), 1e-3, 1e-10);
  const Mesh& collision_mesh = world.meshes[body.collision_mesh];
  EXPECT_TRUE(collision_mesh.closed);
  EXPECT_EQ(collision_mesh.triangles.size(), 12u);
  EXPECT_NEAR(mass_properties(collision_mesh).volume, 1e-3, 1e-9);
  for (std::uint32_t v = 0; v < collision_mesh.vertex_count; ++v)
    EXPECT_GT(dot(collision_mesh.normal(v), collision_mesh.position(v) - collision_mesh.box.center()), 0.0f);

  // With a mesh on the node, that surface is embedded in the block.
  level.nodes[0].mesh = 0;
  level.nodes[0].local.scale = vec3(1);
  for (vec3& p : level.meshes[0].primitives[0].position) p += vec3(0.5f);
  const World ridden = spawned_tets(level);
  const SoftBody& rider = ridden.registry.get<SoftBody>(find_by_name(ridden, "thing"));
  EXPECT_EQ(ridden.meshes[rider.collision_mesh].vertex_count, 642u);
  for (const Embedding& e : ridden.tet_meshes[rider.tets].embedding)
    for (const double w : e.weight) EXPECT_GE(w, -1e-9);
}

TEST(SpawnSoft, ARigidBodyHasASkinAndIsDrawn) {
  Level level = ball();
  level.nodes[0].soft_body.reset();
  level.nodes[0].rigid_body = RigidBody{};
  const World world = spawned_tets(level);
  const Entity thing = find_by_name(world, "thing");
  const Mesh& collision_mesh = world.meshes[world.registry.get<RigidBody>(thing).collision_mesh];
  EXPECT_EQ(collision_mesh.vertex_count, 642u);
  EXPECT_TRUE(world.registry.has<Pose>(thing) && world.registry.has<Drawable>(thing));
}

TEST(SpawnSoft, ADeformableOnASoftBodyIsTheLawOfItsDents) {
  Level level = ball();
  level.nodes[0].deformable = Deformable{};
  level.nodes[0].deformable->stiffness = 70.0;
  const World world = spawned_tets(level);
  const Entity thing = find_by_name(world, "thing");
  EXPECT_FALSE(world.registry.has<Deformable>(thing));
  const DentLaw& law = world.registry.get<DentLaw>(thing);
  const SoftBody& body = world.registry.get<SoftBody>(thing);
  EXPECT_EQ(law.stiffness, 70.0);
  EXPECT_GT(law.reach, 0.0);
  EXPECT_EQ(body.contact, SoftContact::kSplit);
  EXPECT_FALSE(world.tet_meshes[body.tets].samples.empty());
}

TEST(SpawnSoft, ContactsLeftToTheEngineAreSplitWhereThatIsMeasured) {
  const auto contact = [](const Level& level) {
    const World world = spawned_tets(level);
    const SoftBody& body = world.registry.get<SoftBody>(find_by_name(world, "thing"));
    EXPECT_EQ(body.contact == SoftContact::kSplit, !world.tet_meshes[body.tets].samples.empty());
    return body.contact;
  };
  Level level = ball();
  EXPECT_EQ(contact(level), SoftContact::kLattice) << "nothing pins it";
  SoftBody& body = *level.nodes[0].soft_body;
  body.contact = SoftContact::kSplit;
  EXPECT_EQ(contact(level), SoftContact::kSplit) << "asked for";
  body.contact = SoftContact::kAuto;
  body.pinned = {{-0.1f, -0.1f, -0.1f}, {0.1f, -0.03f, 0.1f}};
  EXPECT_EQ(contact(level), SoftContact::kSplit);
  const auto expect_plain = [&](const char* why, const auto& change) {
    Level other = level;
    change(other);
    EXPECT_EQ(contact(other), SoftContact::kLattice) << why;
  };
  expect_plain("asked for", [](Level& l) { l.nodes[0].soft_body->contact = SoftContact::kLattice; });
  expect_plain("large strain", [](Level& l) { l.nodes[0].soft_body->law = TissueLaw::kNeoHookean; });
  expect_plain("beyond the calibration", [](Level& l) { l.nodes[0].soft_body->poisson = 0.498; });
  expect_plain("uneven cells", [](Level& l) { l.nodes[0].soft_body->focus = {{0, 0, 0}, vec3(0.02f)}; });
  expect_plain("thinner than two cells", [](Level& l) { l.nodes[0].soft_body->cell = 0.055; });
  expect_plain("painted", [](Level& l) {
    Primitive& surface = l.meshes[0].primitives[0];
    surface.stiffness.assign(surface.position.size(), 2.0f);
  });
  expect_plain("a soft tool", [](Level& l) {
    l.nodes.push_back(l.nodes[0]);
    l.nodes.back().name = "tool";
    l.nodes.back().handle = Handle6{};
    l.nodes.back().handle->box = {{-0.1f, 0.03f, -0.1f}, {0.1f, 0.1f, 0.1f}};
  });
}

TEST(SpawnSoft, ValidateReportsContradictionsNotesOfFilesAndTissueThatFallsApart) {
  const Temporary file("notes.vtk", std::string(kBlock).replace(std::string(kBlock).find("4 0 1 2 4"), 9, "4 0 2 1 4"));
  const auto findings = [&](auto change) {
    Level level = ball();
    change(level);
    const Temporary saved("level.glb", "");
    EXPECT_TRUE(save_level(level, saved.path).ok());
    std::string all;
    for (const Finding& finding : validate_level(saved.path))
      all += (finding.severity == Severity::kError ? "error " : "other ") + finding.pointer + ": " + finding.message() +
             "\n";
    return all;
  };
  const std::string clash = findings([](Level& level) { level.nodes[0].rigid_body = RigidBody{}; });
  EXPECT_THAT(clash, HasSubstr("error /nodes/0: has both PLIANT_soft_body and PLIANT_rigid_body"));
  const std::string turned = findings([&](Level& level) {
    level.nodes[0].soft_body->mesh = file.path.filename().string();
    level.meshes[0].primitives[0].index.resize(30);
  });
  EXPECT_THAT(turned, HasSubstr("other /nodes/0: 1 inverted tetrahedron"));
  // Two balls connected by a thread.
  const std::string apart = findings([](Level& level) {
    Primitive& p = level.meshes[0].primitives[0];
    const auto count = static_cast<std::uint32_t>(p.position.size());
    const std::vector<std::uint32_t> index = p.index;
    for (std::uint32_t v = 0; v < count; ++v) p.position.push_back(p.position[v] + vec3(0.2f, 0, 0));
    for (const std::uint32_t v : index) p.index.push_back(v + count);
    p.index.insert(p.index.end(), {0, 5, count});
  });
  EXPECT_THAT(apart, HasSubstr("other /nodes/0: its tetrahedra fall into 2 parts where its surface has 1"));
  const std::string unheld = findings([](Level& level) { level.nodes[0].soft_body->pinned = Box{vec3(8), vec3(9)}; });
  EXPECT_THAT(unheld, HasSubstr("error /nodes/0: PLIANT_soft_body/pinned: holds no node"));
}

TEST(SpawnSoft, WhatCannotBeIsRefusedInOneSentenceThatNamesTheNode) {
  const auto expect = [](const char* part, auto change) {
    Level level = ball();
    change(level, level.nodes[0]);
    EXPECT_THAT(refusal(level), testing::AllOf(HasSubstr("`thing`"), HasSubstr(part)));
  };
  expect("PLIANT_soft_body and PLIANT_rigid_body", [](Level&, LevelNode& n) { n.rigid_body = RigidBody{}; });
  expect("neither PLIANT_soft_body nor PLIANT_rigid_body", [](Level&, LevelNode& n) {
    n.soft_body.reset();
    n.handle = Handle6{};
  });
  expect("PLIANT_handle on a rigid body that is `fixed`", [](Level&, LevelNode& n) {
    n.soft_body.reset();
    n.rigid_body = RigidBody{};
    n.rigid_body->fixed = true;
    n.handle = Handle6{};
  });
  expect("neither a mesh nor a tetrahedra file", [](Level&, LevelNode& n) { n.mesh = -1; });
  expect("PLIANT_rigid_body but no mesh", [](Level&, LevelNode& n) {
    n.soft_body.reset();
    n.rigid_body = RigidBody{};
    n.mesh = -1;
  });
  expect("encloses no volume", [](Level& level, LevelNode& n) {
    n.soft_body.reset();
    n.rigid_body = RigidBody{};
    level.meshes[0].primitives = {sheet(4)};
  });
  expect("encloses nothing", [](Level& level, LevelNode&) { level.meshes[0].primitives = {sheet(4)}; });
  expect("defines no rigid part", [](Level&, LevelNode& n) { n.handle = Handle6{}; });
  expect("PLIANT_handle/box: holds no node", [](Level&, LevelNode& n) {
    n.handle = Handle6{};
    n.handle->box = {{1, 1, 1}, {2, 2, 2}};
  });
  expect("pinned: holds no node", [](Level&, LevelNode& n) { n.soft_body->pinned = {{1, 1, 1}, {2, 2, 2}}; });
  expect("no free node", [](Level&, LevelNode& n) { n.soft_body->pinned = {{-1, -1, -1}, {1, 1, 1}}; });
  expect("`nobody`", [](Level&, LevelNode& n) {
    n.handle = Handle6{};
    n.handle->box = {{-1, 0, -1}, {1, 1, 1}};
    n.handle->device = "nobody";
  });
  expect("no such file", [](Level&, LevelNode& n) { n.soft_body->mesh = "no_such.msh"; });
  expect("outside the level's folder", [](Level&, LevelNode& n) { n.soft_body->mesh = "../no_such.msh"; });
  expect("choose a larger one", [](Level&, LevelNode& n) { n.soft_body->cell = 1e-7; });
}

}  // namespace
}  // namespace pliant
