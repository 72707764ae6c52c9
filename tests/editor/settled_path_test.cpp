// Paths on soft bodies that gravity draws away from where they are drawn: keys are set on them where they rest.
#include <cmath>

#include "content/author/instruments.h"
#include "content/author/organ.h"
#include "content/author/touchable.h"
#include "editor/core/editor.h"
#include "editor/core/path_editing.h"
#include "editor/document/resting_mesh.h"
#include "systems/soft/under_gravity.h"
#include "tests/content/mesh_shapes.h"
#include "tests/editor/small_level.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

// A slender body of 12 cm along x, grown to something at its left, that begins as `how` says.
Level hung(UnderGravity how, double young) {
  Level level;
  LevelMesh mesh{"lobe", {pliant::test::icosphere(4)}};
  for (vec3& p : mesh.primitives[0].position) p = normalize(p) * vec3(0.06f, 0.014f, 0.02f);
  mesh.primitives[0].normal.clear();
  level.meshes.push_back(std::move(mesh));
  LevelNode node;
  node.name = "lobe";
  node.mesh = 0;
  node.local.translation = {0.1f, 0.3f, -0.2f};
  node.local.rotation = quat(glm::angleAxis(0.4, dvec3(0, 1, 0)));
  level.nodes.push_back(node);
  SoftBodyParameters tissue;
  tissue.young = young;
  tissue.poisson = 0.4;
  tissue.under_gravity = how;
  EXPECT_TRUE(make_soft(level, 0, tissue).ok());
  EXPECT_TRUE(pin(level, 0, Side::kLeft, 0.25).ok());
  return level;
}

class SettledPath : public CommandTest {};

// As the world is made of it, each vertex where the body begins.
TEST_F(SettledPath, ABodyRestsInTheEditorWhereItBeginsInARun) {
  // [m] Two ways to one equilibrium, each as near as it stops; what reaches out of the tissue is extrapolated.
  constexpr double kConverged = 1e-4;
  // The first keeps its shape, the last is too soft to.
  for (const auto& [how, young] :
       {std::pair{UnderGravity::kModelled, 80e3}, {UnderGravity::kSettled, 12e3}, {UnderGravity::kModelled, 12e3}}) {
    const Level level = hung(how, young);
    const RestingMesh rest = resting_mesh(level, 0, folder);
    EXPECT_TRUE(rest.held);
    Result<World> world = spawn(level);
    ASSERT_TRUE(world.ok()) << world.error().message();
    begin_under_gravity(*world);
    for (auto [entity, body, pose] : world->registry.view<const SoftBody, const Pose>()) {
      const TetMesh& tets = world->tet_meshes[body.tets];
      ASSERT_FALSE(tets.start.empty());
      const Mesh& touch = world->meshes[body.collision_mesh];
      const dmat4 to_world = world_matrices(level.nodes)[0];
      const Primitive& moved = rest.mesh.primitives[0];
      double most = 0.0;
      for (std::size_t i = 0; i < moved.position.size(); ++i) {
        const Embedding& in = tets.embedding[touch.of_source[i]];
        dvec3 there(0);
        for (std::size_t k = 0; k < 4; ++k) there += in.weight[k] * tets.start[tets.tets[in.tet][k]];
        EXPECT_LT(length(dvec3(to_world * glm::dvec4(dvec3(moved.position[i]), 1.0)) - pose.to_world(there)),
                  kConverged);
        most =
            std::max(most, static_cast<double>(length(moved.position[i] - level.meshes[0].primitives[0].position[i])));
      }
      EXPECT_NEAR(most, rest.sag, kConverged);
      if (young > 50e3)
        EXPECT_EQ(rest.sag, 0.0);
      else
        EXPECT_GT(rest.sag, 0.01) << "too stiff for this test to prove anything";
    }
  }
}

TEST_F(SettledPath, WhatHasNoWeightOrNoPinsIsWhereItIsDrawn) {
  Level level = hung(UnderGravity::kSettled, 12e3);
  level.simulation.gravity = dvec3(0);
  EXPECT_EQ(resting_mesh(level, 0, folder).sag, 0.0);
  level = hung(UnderGravity::kFalls, 12e3);
  EXPECT_TRUE(resting_mesh(level, 0, folder).falls);
  unpin(level, 0);
  EXPECT_FALSE(resting_mesh(level, 0, folder).held);
  EXPECT_EQ(resting_mesh(level, 0, folder).sag, 0.0);
}

// A rod, or a probe, along a path on the far end, which sags by more than it is thick. The last cannot keep its shape.
TEST_F(SettledPath, ARodAndAProbeTouchASaggingBodyWhereTheirKeysAre) {
  for (const auto& [how, young] :
       {std::pair{UnderGravity::kSettled, 12e3}, {UnderGravity::kFalls, 12e3}, {UnderGravity::kModelled, 12e3}})
    for (const bool rod : {true, false}) {
      const std::string what = std::to_string(static_cast<int>(how)) + (rod ? " rod" : " probe");
      Level level = hung(how, young);
      const Result<std::int32_t> added = rod ? add_instrument(level, InstrumentKind::kRod, 0) : add_probe(level, 0);
      ASSERT_TRUE(added.ok());
      const std::string effector = level.nodes[static_cast<std::size_t>(*added)].name;
      ASSERT_TRUE(save_level(level, folder / "level.glb").ok());
      Result<Document> document = Document::open(folder / "level.glb");
      ASSERT_TRUE(document.ok()) << document.error().message();
      Editor editor;
      editor.take(*std::move(document));
      const NodeId device = device_of(editor.state(), id_of(editor.document, effector));
      const Editor::Ground ground = editor.ground_now(id_of(editor.document, "lobe"));
      ASSERT_TRUE(ground.surface) << what;
      EXPECT_GT(ground.sag, 0.01) << what;
      EXPECT_EQ(ground.falls, how == UnderGravity::kFalls) << what;
      // The place of its upper side that is farthest down.
      const dvec3 origin(editor.state().to_world(id_of(editor.document, "lobe"))[3]);
      const Mesh& mesh = ground.surface->mesh();
      dvec3 lowest(0, 1e9, 0);
      for (std::uint32_t i = 0; i < mesh.vertex_count; ++i)
        if (dvec3(mesh.position(i)).y < lowest.y) lowest = dvec3(mesh.position(i));
      const SurfaceHit hit = ground.surface->hit({lowest + dvec3(0, 1, 0), dvec3(0, -1, 0)});
      ASSERT_TRUE(hit.valid());
      const double clear = path_clearance(editor, device);
      ScriptKeys keys;
      keys.along = true;
      const double begins = how == UnderGravity::kFalls ? 3.0 : 0.0;  // [s] until it hangs still
      keys.keys = {{0.0, hit.point + origin, hit.normal, clear + 0.02},
                   {begins + 1.0, hit.point + origin, hit.normal, -0.004},
                   {begins + 1.5, hit.point + origin, hit.normal, -0.004},
                   {begins + 2.5, hit.point + origin, hit.normal, clear + 0.02}};
      ASSERT_TRUE(set_keys_of_node(editor, device, keys, "Path")) << what;
      ASSERT_TRUE(editor.document.save().ok());
      const Said run = pliant({"run", "level.glb", "--headless", "--lockstep", "--seconds", "6", "--frames", "0",
                               "--out", "out", "--force"});
      ASSERT_EQ(run.status, 0) << what << run.err;
      const Json probe = report("out")["probes"][0];
      EXPECT_GT(probe["max_force_N"].get<double>(), 1e-3) << what << '\n' << run.out << run.err;
    }
}

}  // namespace
}  // namespace pliant::testing
