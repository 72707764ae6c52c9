// When the shadow map is drawn, and its content besides surfaces.
#include <gtest/gtest.h>

#include <cmath>

#include "systems/visual/renderer.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

constexpr int kShadowWidth = 160, kShadowHeight = 120;
const Viewpoint kShadowAbove{.eye = {0, 2.2, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}};

// A sheet under a lamp 45 degrees over the left.
World lit_sheet() {
  World world = test::sheet(48);
  const Entity light = world.registry.create();
  mat4 m(1);
  m[2] = vec4(normalize(vec3(-1, 1, 0)), 0);
  world.registry.add<Light>(light, {.intensity = 6});
  world.registry.add<WorldTransform>(light, {m});
  return world;
}

using test::renderer_for;
using test::snapshot_of;

TEST(ShadowPass, IsLeftOutWhileNothingThatCastsOneMoves) {
  NEEDS_A_CONTEXT();
  World world = lit_sheet();
  const Entity probe = test::add_probe(world, {0.3, 0.2, 0}, 0.05);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  auto drawn = [&](const Viewpoint& view) {
    FrameStats stats;
    renderer->picture(view, kShadowWidth, kShadowHeight, &stats);
    return stats.shadow_drawn;
  };
  Snapshot moved;
  moved.probes.push_back({.probe = probe, .position = {0.31, 0.2, 0}});
  EXPECT_TRUE(drawn(kShadowAbove)) << "the first";
  EXPECT_FALSE(drawn(kShadowAbove)) << "nothing happened";
  EXPECT_FALSE(drawn({.eye = {1, 2, 1}, .target = {0, 0, 0}})) << "only the eye moved";
  renderer->update(snapshot_of(world, test::dent({0, 0, 0}, 0.05f, 0.3f)));
  EXPECT_TRUE(drawn(kShadowAbove)) << "a dent";
  EXPECT_FALSE(drawn(kShadowAbove));
  renderer->update(moved);
  EXPECT_TRUE(drawn(kShadowAbove)) << "a probe";
  renderer->update(moved);
  EXPECT_FALSE(drawn(kShadowAbove)) << "a probe that stays";
  renderer->options().markers = false;
  EXPECT_TRUE(drawn(kShadowAbove)) << "no probe any more";
  renderer->options().shadows = false;
  EXPECT_FALSE(drawn(kShadowAbove));
  renderer->update(snapshot_of(world, test::dent({0, 0, 0}, 0.02f, 0.3f)));
  EXPECT_FALSE(drawn(kShadowAbove));
  renderer->options().shadows = true;
  EXPECT_TRUE(drawn(kShadowAbove)) << "a dent while shadows were off";
}

TEST(ShadowPass, APictureWithoutItIsTheSame) {
  NEEDS_A_CONTEXT();
  const World world = lit_sheet();
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  renderer->update(snapshot_of(world, test::dent({-0.2f, 0, 0}, 0.2f, 0.4f)));
  const Image first = renderer->picture(kShadowAbove, kShadowWidth, kShadowHeight);
  EXPECT_EQ(first.rgba, renderer->picture(kShadowAbove, kShadowWidth, kShadowHeight).rgba);
}

TEST(ShadowPass, AProbeCastsItsShadowWhereTheLampSaysAndNowhereElse) {
  NEEDS_A_CONTEXT();
  World world = lit_sheet();
  constexpr double kUp = 0.3;  // [m] offset of its shadow to the right
  test::add_probe(world, {-0.2, kUp, 0}, 0.08);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image with = renderer->picture(kShadowAbove, kShadowWidth, kShadowHeight);
  renderer->options().shadows = false;
  const Image without = renderer->picture(kShadowAbove, kShadowWidth, kShadowHeight);
  const double metre = kShadowHeight / 2 / std::tan(0.5 * kShadowAbove.yfov) / kShadowAbove.eye.y;
  auto darker = [&](double x, double z) {
    const auto pixel = static_cast<std::size_t>(static_cast<int>(kShadowHeight / 2 + metre * z) * kShadowWidth +
                                                static_cast<int>(kShadowWidth / 2 + metre * x));
    return int{without.rgba[4 * pixel]} - int{with.rgba[4 * pixel]};
  };
  EXPECT_GT(darker(-0.2 + kUp, 0), 15);
  EXPECT_LE(std::abs(darker(0.5, 0.3)), 2);
  EXPECT_LE(std::abs(darker(0.1, 0.25)), 2);
}

}  // namespace
}  // namespace pliant
