// Pictures of a session through the public header alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "pliant/picture.h"
#include "pliant/pliant.h"

namespace pliant {
namespace {

using testing::HasSubstr;

MeshData sheet() {
  constexpr std::uint32_t kCells = 40;
  MeshData mesh;
  for (std::uint32_t z = 0; z <= kCells; ++z)
    for (std::uint32_t x = 0; x <= kCells; ++x)
      mesh.position.push_back({0.05f * (2.0f * float(x) / kCells - 1), 0, 0.05f * (2.0f * float(z) / kCells - 1)});
  for (std::uint32_t z = 0; z < kCells; ++z)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t i = z * (kCells + 1) + x, j = i + kCells + 1;
      mesh.index.insert(mesh.index.end(), {i, j, i + 1, i + 1, j, j + 1});
    }
  return mesh;
}

Session opened() {
  Scene scene;
  scene.add_surface("tissue", sheet());
  scene.add_probe("finger", {.radius = 0.004});
  return std::move(Session::open(scene)).value();
}

// Pixels that differ between two pictures by more than a few grey levels.
std::size_t differing(const Picture& a, const Picture& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4)
    count += std::abs(int(a.rgba[i]) - int(b.rgba[i])) > 8 || std::abs(int(a.rgba[i + 1]) - int(b.rgba[i + 1])) > 8;
  return count;
}

TEST(Pictures, MadeAfterTicksShowWhatThoseMadeBeforeThemShow) {
  const PictureView above{{0, 0.1, 0.15}, {0, 0, 0}};
  std::optional<Picture> shown[2];
  for (const bool late : {false, true}) {
    Scene scene;
    scene.add_surface("skin", sheet(), {}, {.position = {0.06, 0, 0}});
    MeshData block = sheet();
    block.position = {{-0.03f, 0, -0.03f},     {0.03f, 0, -0.03f},     {0.03f, 0, 0.03f},     {-0.03f, 0, 0.03f},
                      {-0.03f, 0.02f, -0.03f}, {0.03f, 0.02f, -0.03f}, {0.03f, 0.02f, 0.03f}, {-0.03f, 0.02f, 0.03f}};
    block.index = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6, 0, 4, 5, 0, 5, 1,
                   1, 5, 6, 1, 6, 2, 2, 6, 7, 2, 7, 3, 3, 7, 4, 3, 4, 0};
    scene.add_soft_body("block", block, {.young = 2000.0, .cell = 0.01}, {.position = {-0.06, 0, 0}});
    scene.add_probe("finger", {.radius = 0.004});
    auto session = Session::open(scene);
    ASSERT_TRUE(session) << session.error().message();
    std::optional<Pictures> pictures;
    const auto make = [&] {
      auto made = Pictures::headless(*session);
      if (made) pictures.emplace(std::move(*made));
      return made.ok();
    };
    if (!late && !make()) GTEST_SKIP() << "no OpenGL";
    for (int i = 0; i <= 150; ++i) {
      ASSERT_TRUE(session->move("finger", {0.06, 0.006 - 1e-4 * i, 0}));
      ASSERT_TRUE(session->step());
    }
    std::vector<vec3> looked;
    ASSERT_TRUE(session->vertices("skin", looked));  // takes what a picture would need
    if (late) ASSERT_TRUE(make());
    auto picture = pictures->picture(above, 320, 180);
    ASSERT_TRUE(picture);
    shown[late] = std::move(*picture);
  }
  EXPECT_EQ(differing(*shown[0], *shown[1]), 0u);
}

TEST(Pictures, SeesTheDentAndOutlivesNeitherARestartNorItsSession) {
  std::optional<Session> session(opened());
  auto pictures = Pictures::headless(*session);
  if (!pictures) GTEST_SKIP() << pictures.error().message();
  EXPECT_THAT(Pictures::headless(*session).error().message(), HasSubstr("has Pictures"));
  ASSERT_TRUE(session->move("finger", {0, 0.03, 0}));
  ASSERT_TRUE(session->step());
  const PictureView above{{0, 0.1, 0.1}, {0, 0, 0}};
  const auto before = pictures->picture(above, 160, 90);
  ASSERT_TRUE(before) << before.error().message();
  ASSERT_EQ(before->rgba.size(), 160u * 90u * 4u);
  for (int i = 0; i <= 300; ++i) {
    ASSERT_TRUE(session->move("finger", {0, 0.006 - 5e-5 * i, 0}));
    ASSERT_TRUE(session->step());
    std::vector<vec3> vertices;
    if (i % 50 == 0) ASSERT_TRUE(session->vertices("tissue", vertices)) << "what others look at is not lost to it";
  }
  ASSERT_TRUE(session->move("finger", {0, 0.03, 0}));  // out of the way: only the dent is visible
  ASSERT_TRUE(session->step());
  const auto dented = pictures->picture(above, 160, 90);
  ASSERT_TRUE(dented);
  EXPECT_GT(differing(*before, *dented), 20u);
  ASSERT_TRUE(session->step(3000));
  const auto after = pictures->picture(above, 160, 90);
  ASSERT_TRUE(after);
  EXPECT_LT(differing(*before, *after), 5u) << "it has come back";

  EXPECT_FALSE(pictures->picture(above, 0, 90));
  EXPECT_FALSE(pictures->picture(above, 160, 100000));
  EXPECT_FALSE(pictures->picture({{0, 0, 0}, {0, 0, 0}}, 160, 90));
  ASSERT_TRUE(session->restart());
  EXPECT_THAT(pictures->picture(above, 160, 90).error().message(), HasSubstr("restarted"));
  auto second = Pictures::headless(*session);
  ASSERT_TRUE(second) << second.error().message();
  EXPECT_TRUE(second->picture(second->view(), 64, 36));
  session.reset();
  EXPECT_FALSE(second->picture(above, 160, 90));
}

}  // namespace
}  // namespace pliant
