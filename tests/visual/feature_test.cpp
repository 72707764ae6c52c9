// One picture for each feature of the renderer, against a manually verified picture (golden/). Each test also draws
// without the feature, and that picture must fail the same comparison.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "systems/visual/renderer.h"
#include "tests/visual/compare.h"
#include "tests/visual/golden.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::dent;
using test::kTolerance;
using test::perceived_difference;
using test::renderer_for;
using test::snapshot_of;

constexpr int kFeatureWidth = 192, kFeatureHeight = 144;

const Viewpoint kFeatureFront{.eye = {0, 0.8, 4}, .target = {0, 0, 0}};
const Viewpoint kFeatureNear{.eye = {0.2, 1.0, 0.6}, .target = {-0.12, -0.1, 0}};
const Viewpoint kFeatureSlanted{.eye = {0, 1.5, 1.4}, .target = {0, 0, 0.05}};

// A sky of soft coloured tiles over a dark chequered floor: refraction bends its lines.
Panorama tiles() {
  constexpr float kPi = std::numbers::pi_v<float>;
  Panorama p{.name = "tiles", .width = 256, .height = 128, .rgb = {}};
  for (std::uint32_t y = 0; y < p.height; ++y)
    for (std::uint32_t x = 0; x < p.width; ++x) {
      const float turn = (static_cast<float>(x) + 0.5f) / 256, fall = (static_cast<float>(y) + 0.5f) / 128;
      const float wave = std::sin(24 * kPi * turn) * std::sin(12 * kPi * fall),
                  edge = glm::smoothstep(-0.2f, 0.2f, wave);
      const vec3 above = glm::mix(vec3(0.25f, 0.45f, 0.9f), vec3(1.3f, 1.1f, 0.7f), edge);
      const vec3 below = glm::mix(vec3(0.05f, 0.04f, 0.04f), vec3(0.4f, 0.15f, 0.08f), edge);
      const vec3 c = glm::mix(above, below, glm::smoothstep(0.49f, 0.51f, fall));
      p.rgb.insert(p.rgb.end(), {c.r, c.g, c.b});
    }
  return p;
}

void paint(World& world, const Material& material) {
  world.materials = {material};
  for (DrawPart& part : world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh].parts)
    part.material = 0;
}

// Light from the left, 20 degrees above the ground.
void light_low(World& world) {
  const Entity light = world.registry.create();
  mat4 m(1);
  m[2] = vec4(normalize(vec3(-1.0f, 0.36f, 0.1f)), 0);
  world.registry.add<Light>(light, {.color = {1, 0.97f, 0.9f}, .intensity = 8});
  world.registry.add<WorldTransform>(light, {m});
}

// The sheet of snapshot_of(stream), by the stream's function, and the part of it that light_low's lamp reaches.
struct StreamCheck {
  test::StreamAt stream;
  double height(double x, double z) const { return stream(vec3(x, 0, z), {0, 1, 0}).w; }
  // Cosine between the surface's normal and the lamp, in the middle row.
  double faces_lamp(double x) const {
    return dot(normalize(dvec3(0, 1, 0) + dvec3(stream(vec3(x, 0, 0), {0, 1, 0}))), normalize(dvec3(-1, 0.36, 0.1)));
  }
  bool open_to_lamp(double x) const {
    for (double t = 0.02; t < 1.0; t += 0.002)
      if (height(x - t, 0.1 * t) > height(x, 0) + 0.36 * t) return false;
    return true;
  }
};

World ball_of(const Material& material) {
  World world = test::sphere(64);
  world.meshes[world.registry.get<Deformable>(test::object_of(world)).mesh].closed = true;
  world.environment.panorama = tiles();
  paint(world, material);
  return world;
}

Material chrome() {
  Material m;
  m.base_color = {0.95f, 0.95f, 0.95f, 1};
  m.metallic = 1;
  m.roughness = 0.05f;
  return m;
}

Material glass() {
  Material m;
  m.base_color = vec4(1);
  m.roughness = 0;
  m.ior = 1.45f;
  m.transmission = 1;
  m.thickness = 2;
  m.attenuation_color = {1.0f, 0.6f, 0.6f};
  m.attenuation_distance = 3;
  return m;
}

World clay_sheet() {
  World world = test::sheet(96);
  Material clay;
  clay.base_color = {0.62f, 0.5f, 0.42f, 1};
  clay.roughness = 0.7f;
  clay.double_sided = true;
  paint(world, clay);
  light_low(world);
  return world;
}

// Draws `world` twice, with and without the feature that `switch_off` disables.
template <class SwitchOff>
void expect_option(const std::string& name, const World& world, const Snapshot& pressed, const Viewpoint& view,
                   SwitchOff switch_off) {
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  renderer->update(pressed);
  const Image on = renderer->picture(view, kFeatureWidth, kFeatureHeight);
  switch_off(renderer->options());
  test::expect_golden(name, on, renderer->picture(view, kFeatureWidth, kFeatureHeight));
}

TEST(Feature, TheSurroundingsStandBehindEverything) {
  NEEDS_A_CONTEXT();
  expect_option("environment", ball_of(Material{}), {}, kFeatureFront, [](RenderOptions& o) { o.background = false; });
}

TEST(Feature, ChromeMirrorsTheSurroundingsAndADentBendsThem) {
  NEEDS_A_CONTEXT();
  const World world = ball_of(chrome());
  const Snapshot pressed = snapshot_of(world, dent(normalize(vec3(0.3f, 0.35f, 0.9f)), 0.15f, 0.7f));
  expect_option("reflection", world, pressed, kFeatureFront, [](RenderOptions& o) { o.reflection = false; });
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image rest = renderer->picture(kFeatureFront, kFeatureWidth, kFeatureHeight);
  renderer->update(pressed);
  EXPECT_GT(perceived_difference(rest, renderer->picture(kFeatureFront, kFeatureWidth, kFeatureHeight)), kTolerance);
}

TEST(Feature, GlassShowsTheSurroundingsUpsideDown) {
  NEEDS_A_CONTEXT();
  const World world = ball_of(glass());
  const Snapshot pressed = snapshot_of(world, dent(normalize(vec3(-0.3f, 0.3f, 0.9f)), 0.1f, 0.6f));
  expect_option("refraction", world, pressed, kFeatureFront, [](RenderOptions& o) { o.refraction = false; });
  // The sky is blue and bright, the floor red and dark: in the ball the floor is above.
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image seen = renderer->picture(kFeatureFront, kFeatureWidth, kFeatureHeight);
  auto brightness = [&](int y) {
    int sum = 0;
    for (int x = kFeatureWidth / 2 - 12; x < kFeatureWidth / 2 + 12; ++x)
      for (std::size_t c = 0; c < 3; ++c) sum += seen.rgba[4 * static_cast<std::size_t>(y * kFeatureWidth + x) + c];
    return sum;
  };
  EXPECT_GT(brightness(kFeatureHeight / 2 + 28), 3 * brightness(kFeatureHeight / 2 - 28) / 2);
}

TEST(Feature, AHeightTextureRoughensTheSurface) {
  NEEDS_A_CONTEXT();
  World world = clay_sheet();
  Image cobbles{.name = "cobbles", .width = 128, .height = 64, .rgba = {}};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x) {
      const double wave = std::sin(std::numbers::pi * x / 8) * std::sin(std::numbers::pi * y / 8);
      const auto height = static_cast<std::uint8_t>(127.5 + 127.0 * wave);
      cobbles.rgba.insert(cobbles.rgba.end(), {height, height, height, 255});
    }
  world.images.push_back(std::move(cobbles));
  world.materials[0].height_texture = 0;
  world.materials[0].height_scale = 0.03f;
  expect_option("bump", world, {}, kFeatureSlanted, [](RenderOptions& o) { o.bump = false; });
}

TEST(Feature, ADentShadowsItself) {
  NEEDS_A_CONTEXT();
  const World world = clay_sheet();
  expect_option("self_shadow", world, snapshot_of(world, dent({-0.2f, 0, 0}, 0.25f, 0.5f)), kFeatureNear,
                [](RenderOptions& o) { o.shadows = false; });
}

TEST(Feature, WhatBlendsLetsTheSurroundingsThrough) {
  NEEDS_A_CONTEXT();
  Material film;
  film.base_color = {0.1f, 0.5f, 0.25f, 0.35f};
  film.roughness = 0.3f;
  film.alpha = Material::Alpha::kBlend;
  film.double_sided = true;
  World world = ball_of(film);
  const Image on = renderer_for(world)->picture(kFeatureFront, kFeatureWidth, kFeatureHeight);
  world.materials[0].alpha = Material::Alpha::kOpaque;
  test::expect_golden("transparent", on, renderer_for(world)->picture(kFeatureFront, kFeatureWidth, kFeatureHeight));
}

TEST(Shadow, FallsWhereARayToTheLampMeetsTheDentAndNowhereElse) {
  NEEDS_A_CONTEXT();
  const World world = clay_sheet();
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Viewpoint above{.eye = {0, 2.2, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}};
  const StreamCheck dented{dent({-0.2f, 0, 0}, 0.25f, 0.5f)};
  renderer->update(snapshot_of(world, dented.stream));
  const Image with = renderer->picture(above, kFeatureWidth, kFeatureHeight);
  renderer->options().shadows = false;
  const Image without = renderer->picture(above, kFeatureWidth, kFeatureHeight);

  // Along the middle row, where the expected picture follows from the function of the dent.
  const double metre = kFeatureHeight / 2 / std::tan(0.5 * above.yfov);
  int dark = 0, bright = 0;
  for (double x = -0.95; x < 0.95; x += 0.01) {
    bool all_open = true, all_blocked = true;  // about here: the shadow's soft edge counts for neither
    for (const double aside : {-0.03, -0.015, 0.0, 0.015, 0.03})
      (dented.open_to_lamp(x + aside) ? all_blocked : all_open) = false;
    const double column = kFeatureWidth / 2 + metre * x / (above.eye.y - dented.height(x, 0));
    const std::size_t i = 4 * static_cast<std::size_t>(kFeatureHeight / 2 * kFeatureWidth + static_cast<int>(column));
    const int taken = int{without.rgba[i]} - int{with.rgba[i]};
    if (all_open) {
      EXPECT_LE(std::abs(taken), 2) << x;
      ++bright;
    } else if (all_blocked && dented.faces_lamp(x) > 0.15) {
      EXPECT_GT(taken, 8) << x;
      ++dark;
    }
  }
  EXPECT_GT(dark, 3);
  EXPECT_GT(bright, 100);
}

TEST(Option, WireframeShowsTheBackgroundBetweenItsLines) {
  NEEDS_A_CONTEXT();
  const World world = ball_of(Material{});
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image filled = renderer->picture(kFeatureFront, 2 * kFeatureWidth, 2 * kFeatureHeight);
  renderer->options().wireframe = true;
  const Image lines = renderer->picture(kFeatureFront, 2 * kFeatureWidth, 2 * kFeatureHeight);
  EXPECT_GT(perceived_difference(filled, lines), kTolerance);
  renderer->options().wireframe = false;
  EXPECT_EQ(renderer->picture(kFeatureFront, 2 * kFeatureWidth, 2 * kFeatureHeight).rgba, filled.rgba);
}

TEST(Option, EveryZoneHasAColourOfItsOwn) {
  NEEDS_A_CONTEXT();
  const World world = clay_sheet();
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image plain = renderer->picture(kFeatureSlanted, kFeatureWidth, kFeatureHeight);
  renderer->options().zones = true;
  EXPECT_GT(perceived_difference(plain, renderer->picture(kFeatureSlanted, kFeatureWidth, kFeatureHeight)), kTolerance);
}

TEST(Option, ForcesAndContactFramesComeAndGoByThemselves) {
  NEEDS_A_CONTEXT();
  World world = clay_sheet();
  const Entity probe = test::add_probe(world, {0, 0.05, 0}, 0.05);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  Snapshot pushed;
  pushed.probes.push_back(
      {.probe = probe, .position = {0, 0.05, 0}, .force = {0, 2, 0}, .touching = true, .normal = {0, 1, 0}});
  renderer->update(pushed);
  auto drawn = [&](bool forces, bool frames) {
    renderer->options().forces = forces;
    renderer->options().contact_frames = frames;
    return renderer->picture(kFeatureSlanted, kFeatureWidth, kFeatureHeight);
  };
  const Image bare = drawn(false, false), arrow = drawn(true, false), frame = drawn(false, true);
  EXPECT_NE(bare.rgba, arrow.rgba);
  EXPECT_NE(bare.rgba, frame.rgba);
  int green = 0;  // the frame's normal
  for (std::size_t i = 0; i < frame.rgba.size(); i += 4)
    green += frame.rgba[i + 1] > frame.rgba[i] + 60 && frame.rgba[i + 1] > frame.rgba[i + 2] + 60;
  EXPECT_GT(green, 10);
  EXPECT_EQ(bare.rgba, drawn(false, false).rgba);
}

TEST(Lamp, ASecondLampAddsItsLightWhereItReaches) {
  NEEDS_A_CONTEXT();
  World world = clay_sheet();
  const std::unique_ptr<Renderer> one = renderer_for(world);
  const Entity entity = world.registry.create();
  mat4 m(1);
  m[3] = vec4(0.7f, 0.2f, 0, 1);
  world.registry.add<Light>(entity,
                            {.kind = Light::Kind::kPoint, .color = {0, 0, 1}, .intensity = 0.3f, .range = 0.5f});
  world.registry.add<WorldTransform>(entity, {m});
  const std::unique_ptr<Renderer> two = renderer_for(world);
  ASSERT_TRUE(one && two);
  const Viewpoint above{.eye = {0, 2.2, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}};
  const Image a = one->picture(above, kFeatureWidth, kFeatureHeight),
              b = two->picture(above, kFeatureWidth, kFeatureHeight);
  const double metre = kFeatureHeight / 2 / std::tan(0.5 * above.yfov) / above.eye.y;
  auto at = [&](double x) {
    return 4 * static_cast<std::size_t>(kFeatureHeight / 2 * kFeatureWidth +
                                        static_cast<int>(kFeatureWidth / 2 + metre * x)) +
           2;
  };
  EXPECT_GT(b.rgba[at(0.7)], a.rgba[at(0.7)] + 20);
  EXPECT_EQ(b.rgba[at(-0.5)], a.rgba[at(-0.5)]);
}

}  // namespace
}  // namespace pliant
