// Ambient occlusion against its closed form, the ground, and what each quality leaves out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "systems/visual/renderer.h"
#include "systems/visual/viewpoint.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

constexpr int kNearWidth = 640, kNearHeight = 360;

// Only white surroundings light it, so that a picture shows their visible share.
void light_evenly(World& world) {
  world.environment.panorama = {.name = "white", .width = 8, .height = 4, .rgb = std::vector<float>(96, 1.0f)};
  world.registry.add<Light>(world.registry.create(), {.intensity = 0});
  Material dark;
  dark.base_color = vec4(0.1f, 0.1f, 0.1f, 1);
  dark.roughness = 1;
  dark.double_sided = true;
  world.materials = {dark};
  for (DrawPart& part : world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh].parts)
    part.material = 0;
}

// A floor, x < 0, that meets a wall, y > 0, in a right angle.
World corner() {
  World world = test::sheet(64);
  for (DrawVertex& v : world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh].vertices)
    if (v.position.x > 0) v = {.position = {0, v.position.x, v.position.z}, .normal = {-1, 0, 0}, .uv = v.uv};
  light_evenly(world);
  return world;
}

// [1] Linear light of a pixel's green, before shaders/tone.glsl and sRGB; up to a factor.
double light_at(const Image& image, vec2 pixel) {
  const auto i = 4 * (static_cast<std::size_t>(pixel.y) * kNearWidth + static_cast<std::size_t>(pixel.x)) + 1;
  const double s = image.rgba[i] / 255.0, toned = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  double low = 0, high = 20;
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (low + high);
    (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14) < toned ? low : high) = x;
  }
  return low;
}

vec2 place_in(const Viewpoint& view, const World& world, vec3 point) {
  const mat4 projection = projection_of(view, drawn_box(world, false), static_cast<float>(kNearWidth) / kNearHeight);
  const vec4 clip = projection * view_of(view) * vec4(point, 1);
  return {(0.5f + 0.5f * clip.x / clip.w) * kNearWidth, (0.5f - 0.5f * clip.y / clip.w) * kNearHeight};
}

// Share of the sky, weighted by the cosine, that is not behind the part of a wall within distance r: a half disc of
// radius a about the wall's foot at distance d, whose view factor is (atan(a / d) - a d / r2) / pi.
double open_beside_wall(double d, double r) {
  const double a = std::sqrt(std::max(r * r - d * d, 0.0));
  return 1 - (std::atan2(a, d) - a * d / (r * r)) / std::numbers::pi;
}

// Occluders count fully within 0.58 of the reach, 0.12 of the scene's diagonal, and fade up to all of it.
TEST(Nearby, TheFloorBesideAWallSeesTheShareOfTheSkyThatTheClosedFormGives) {
  NEEDS_A_CONTEXT();
  const World world = corner();
  const std::unique_ptr<Renderer> renderer = test::renderer_for(world);
  ASSERT_TRUE(renderer);
  renderer->options().reflection = renderer->options().background = false;
  const Viewpoint view{.eye = {-1.0, 1.0, 0.4}, .target = {-0.12, 0.05, 0}};
  const Image low = renderer->picture(view, kNearWidth, kNearHeight);
  const double reach = 0.12 * drawn_box(world, false).diagonal();
  for (const auto& [quality, error] : {std::pair(PictureQuality::kMedium, 0.08), {PictureQuality::kHigh, 0.04}}) {
    renderer->options().quality = quality;
    const Image picture = renderer->picture(view, kNearWidth, kNearHeight);
    for (const double d : {0.02, 0.05, 0.1, 0.25, 0.4}) {
      const vec2 at = place_in(view, world, vec3(-d, 0, 0));
      const double open = light_at(picture, at) / light_at(low, at);
      EXPECT_GT(open, open_beside_wall(d, reach) - error) << d << ' ' << static_cast<int>(quality);
      EXPECT_LT(open, open_beside_wall(d, 0.58 * reach) + error) << d << ' ' << static_cast<int>(quality);
    }
  }
}

TEST(Nearby, ABodyStandsOnTheGroundAndOnlyThereDarkensIt) {
  NEEDS_A_CONTEXT();
  World world = test::sphere(48);
  light_evenly(world);
  const std::unique_ptr<Renderer> renderer = test::renderer_for(world);
  ASSERT_TRUE(renderer);
  const Viewpoint view{.eye = {0, 1, 7}, .target = {0, 0, 0}};
  const Image low = renderer->picture(view, kNearWidth, kNearHeight);
  renderer->options().quality = PictureQuality::kHigh;
  const Image high = renderer->picture(view, kNearWidth, kNearHeight);
  const auto left = [&](vec3 point) {
    const vec2 at = place_in(view, world, point);
    return light_at(high, at) / light_at(low, at);
  };
  EXPECT_LT(left({0.25f, -1, 0.45f}), 0.9);
  EXPECT_NEAR(left({1.8f, -1, 0.5f}), 1, 0.05) << "to two steps of 255";
  EXPECT_NEAR(left({0, 1.6f, 0}), 1, 1e-6) << "above the horizon";
}

}  // namespace
}  // namespace pliant
