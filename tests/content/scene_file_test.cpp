// Level files through the public interface.
#include <gtest/gtest.h>

#include "pliant/content.h"
#include "pliant/pliant.h"

namespace pliant {
namespace {

TEST(SceneFile, IsASceneThatASessionRuns) {
  std::vector<std::string> notes;
  auto scene = load_scene(PLIANT_SOURCE_DIR "/content/levels/minimal.gltf", &notes);
  ASSERT_TRUE(scene) << scene.error().message();
  auto session = Session::open(*scene);
  ASSERT_TRUE(session) << session.error().message();
  ASSERT_FALSE(session->effectors().empty());
  ASSERT_TRUE(session->step(1500));
  bool felt = false;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(session->step(20));
    felt |= session->reading(session->effectors()[0])->touching;
  }
  EXPECT_TRUE(felt) << "by its own script";
  EXPECT_FALSE(load_scene("no_such.gltf"));
}

TEST(SceneFile, WhatWasMadeInCodeIsSavedAndReadAgain) {
  Scene scene("pad");
  scene.add_surface("tissue",
                    {.position = {{0, 0, 0}, {0, 0, 0.1f}, {0.1f, 0, 0}, {0.1f, 0, 0.1f}}, .index = {0, 1, 2, 2, 1, 3}},
                    {.stiffness = 300.0}, {.position = {0, 0.5, 0}});
  scene.add_probe("finger", {.radius = 0.002});
  ASSERT_TRUE(set_key(scene, "tissue.deformable.stiffness=123"));
  EXPECT_FALSE(set_key(scene, "tissue.deformable.stifness=123"));
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "scene_file_test.glb";
  ASSERT_TRUE(save_scene(scene, file));
  auto again = load_scene(file);
  ASSERT_TRUE(again) << again.error().message();
  auto session = Session::open(*again);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(*session->get("tissue", "stiffness"), 123.0);
  std::vector<vec3> vertices;
  ASSERT_TRUE(session->vertices("tissue", vertices));
  ASSERT_EQ(vertices.size(), 4u);
  EXPECT_EQ(vertices[3], vec3(0.1f, 0.5f, 0.1f));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace pliant
