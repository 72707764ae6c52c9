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

TEST(SceneFile, ForceLimitsOfAFileAreCappedAndThoseOfTheProgramAreNot) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "safety_cap_test.gltf";
  Scene strong("strong");
  strong.add_surface("tissue", {.position = {{0, 0, 0}, {0, 0, 0.1f}, {0.1f, 0, 0}}, .index = {0, 1, 2}});
  strong.add_probe("finger", {}, {.max_force = 80.0, .max_slew = 1e6});
  EXPECT_EQ(*Session::open(strong)->get("finger", "max_force"), 80.0) << "a scene in code is the program's word";
  ASSERT_TRUE(save_scene(strong, file));

  std::vector<std::string> notes;
  auto scene = load_scene(file, &notes);
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("`finger`: the file asks for more than max_force 10 N"), std::string::npos) << notes[0];
  auto session = Session::open(*scene);
  ASSERT_TRUE(session);
  EXPECT_EQ(*session->get("finger", "max_force"), 10.0);
  EXPECT_EQ(*session->get("finger", "max_slew"), SafetyCap{}.max_slew());
  EXPECT_NEAR(SafetyCap{3.3}.max_slew(), DeviceParameters().max_slew, 1e-9) << "as quick as the usual device";
  EXPECT_FALSE(session->notes().empty());
  ASSERT_TRUE(session->restart());
  EXPECT_EQ(*session->get("finger", "max_force"), 10.0);
  ASSERT_TRUE(session->set("finger", "max_force", 20.0)) << "the program's word";
  EXPECT_EQ(*session->get("finger", "max_force"), 20.0);

  ASSERT_TRUE(save_scene(*scene, file)) << "saved, it still says what it said";
  EXPECT_EQ(*Session::open(*load_scene(file, nullptr, {100.0}))->get("finger", "max_force"), 80.0);
  EXPECT_EQ(*Session::open(*load_scene(file, nullptr, {2.0}))->get("finger", "max_force"), 2.0);
  ASSERT_TRUE(set_key(*scene, "finger.haptic_device.max_force=30"));
  EXPECT_EQ(*Session::open(*scene)->get("finger", "max_force"), 30.0);
  std::filesystem::remove(file);
  std::filesystem::remove(std::filesystem::path(file).replace_extension(".bin"));
}

}  // namespace
}  // namespace pliant
