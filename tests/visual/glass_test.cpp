// Transparency: textures of transmission and thickness, objects behind glass, blended layers.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "systems/visual/renderer.h"
#include "tests/visual/compare.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::renderer_for;

constexpr int kGlassWidth = 160, kGlassHeight = 120;
const Viewpoint kGlassFront{.eye = {0, 0, 4}, .target = {0, 0, 0}};

vec3 at(const Image& image, double x, double y) {
  const std::uint8_t* p = &image.rgba[4 * (static_cast<std::size_t>(y) * image.width + static_cast<std::size_t>(x))];
  return {p[0], p[1], p[2]};
}

// In front of a bright wall, in a dark room: transmitting material is bright.
World glass_ball() {
  World world = test::sphere(48);
  world.meshes[world.registry.get<Deformable>(test::object_of(world)).mesh].closed = true;
  Panorama wall{.name = "wall", .width = 4, .height = 2, .rgb = {}};
  for (int i = 0; i < 8; ++i) wall.rgb.insert(wall.rgb.end(), 3, i % 4 == 1 || i % 4 == 2 ? 1.0f : 0.02f);
  world.environment.panorama = wall;
  Material glass;
  glass.base_color = vec4(1);
  glass.roughness = 0;
  glass.ior = 1.2f;
  glass.transmission = 1;
  world.materials = {glass};
  for (DrawPart& part : world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh].parts)
    part.material = 0;
  return world;
}

// A picture whose left half is `left` and whose right half is `right`, in the red and green channel.
std::int32_t add_halves(World& world, std::uint8_t left, std::uint8_t right) {
  Image image{.name = "halves", .width = 64, .height = 2, .rgba = {}};
  for (int i = 0; i < 128; ++i) {
    const std::uint8_t value = i % 64 < 32 ? left : right;
    image.rgba.insert(image.rgba.end(), {value, value, 0, 255});
  }
  world.images.push_back(std::move(image));
  return static_cast<std::int32_t>(world.images.size()) - 1;
}

TEST(Glass, ATransmissionTextureIsOpaqueWhereItIsBlack) {
  NEEDS_A_CONTEXT();
  World world = glass_ball();
  world.materials[0].base_color = {0.5f, 0.02f, 0.02f, 1};
  world.materials[0].transmission_texture = add_halves(world, 0, 255);
  // The front of the sphere is u = 0 and u = 1: its right side has small u.
  const Image half = renderer_for(world)->picture(kGlassFront, kGlassWidth, kGlassHeight);
  world.materials[0].transmission_texture = -1;
  const Image clear = renderer_for(world)->picture(kGlassFront, kGlassWidth, kGlassHeight);
  world.materials[0].transmission = 0;
  const Image opaque = renderer_for(world)->picture(kGlassFront, kGlassWidth, kGlassHeight);
  const vec3 black_side = at(half, kGlassWidth / 2 + 15, kGlassHeight / 2),
             white_side = at(half, kGlassWidth / 2 - 15, kGlassHeight / 2);
  EXPECT_LT(length(black_side - at(opaque, kGlassWidth / 2 + 15, kGlassHeight / 2)), 3);
  EXPECT_LT(length(white_side - at(clear, kGlassWidth / 2 - 15, kGlassHeight / 2)), 3);
  EXPECT_GT(length(black_side - white_side), 15);
}

TEST(Glass, AThicknessTextureScalesHowMuchIsAbsorbed) {
  NEEDS_A_CONTEXT();
  World world = glass_ball();
  world.materials[0].thickness = 2;
  world.materials[0].attenuation_color = {0.2f, 0.5f, 0.9f};
  world.materials[0].attenuation_distance = 1;
  auto red_with = [&](std::uint8_t share) {
    world.materials[0].thickness_texture = add_halves(world, share, share);
    return at(renderer_for(world)->picture(kGlassFront, kGlassWidth, kGlassHeight), kGlassWidth / 2, kGlassHeight / 2)
        .r;
  };
  const float full = red_with(255), half = red_with(128), none = red_with(0);
  EXPECT_GT(half, full + 10);
  EXPECT_GT(none, half + 10);
  world.materials[0].thickness_texture = -1;
  EXPECT_NEAR(
      at(renderer_for(world)->picture(kGlassFront, kGlassWidth, kGlassHeight), kGlassWidth / 2, kGlassHeight / 2).r,
      full, 1);
}

TEST(Glass, AProbeBehindAPaneIsSeenThroughItAndOneBeforeItOnlyOnce) {
  NEEDS_A_CONTEXT();
  for (const double z : {-1.6, 1.6}) {
    World world = glass_ball();
    test::add_probe(world, {0.15, 0.1, z}, 0.3);
    const std::unique_ptr<Renderer> renderer = renderer_for(world);
    ASSERT_TRUE(renderer);
    const Image with = renderer->picture(kGlassFront, kGlassWidth, kGlassHeight);
    renderer->options().markers = false;
    const Image without = renderer->picture(kGlassFront, kGlassWidth, kGlassHeight);
    renderer->options().markers = true;
    renderer->options().refraction = false;
    const Image solid = renderer->picture(kGlassFront, kGlassWidth, kGlassHeight);
    // The probe's disc as a straight line of sight has it: the ball is a pane, which does not bend.
    const double metre = kGlassHeight / 2 / std::tan(0.5 * kGlassFront.yfov) / (4 - z);
    const double x = kGlassWidth / 2 - 0.05 * metre, y = kGlassHeight / 2 + 0.05 * metre;  // below the stylus
    const vec3 seen = at(with, x, y);
    EXPECT_GT(seen.r, seen.g + 40) << z << ": it is red";
    EXPECT_GT(at(without, x, y).g, seen.g + 40) << z;
    if (z < 0) {
      EXPECT_LT(at(solid, x, y).r - at(solid, x, y).g, 40) << "a solid ball hides it";
    }
    const double beside = x - 0.4 * metre;  // on the ball, off the probe
    EXPECT_LT(length(at(with, beside, y) - at(without, beside, y)), 12) << z;
  }
}

// A body of some thickness bends sight, so that places far from a probe look up the picture at its outline.
TEST(Glass, TheOutlineOfAProbeInFrontIsNotSeenThroughTheBody) {
  NEEDS_A_CONTEXT();
  // With and without the probe.
  const auto pictures = [](World world) {
    test::add_probe(world, {0.15, 0.1, 1.6}, 0.3);
    const std::unique_ptr<Renderer> renderer = renderer_for(world);
    renderer->options().shadows = false;
    const Image with = renderer->picture(kGlassFront, kGlassWidth, kGlassHeight);
    renderer->options().markers = false;
    return std::pair(with, renderer->picture(kGlassFront, kGlassWidth, kGlassHeight));
  };
  World world = glass_ball();
  world.materials[0].thickness = 1.5f;
  const auto [glass_with, glass] = pictures(std::move(world));
  const auto [clay_with, clay] = pictures(test::sphere(48));
  int covered = 0, ghosts = 0;
  for (int y = 0; y < kGlassHeight; ++y)
    for (int x = 0; x < kGlassWidth; ++x) {
      const bool by_the_probe = length(at(clay, x, y) - at(clay_with, x, y)) > 0;
      covered += by_the_probe;
      ghosts += !by_the_probe && length(at(glass, x, y) - at(glass_with, x, y)) > 3;
    }
  EXPECT_GT(covered, 1000);
  EXPECT_EQ(ghosts, 0);
}

// Two films one behind the other, created in this order and in reverse.
TEST(Glass, WhatBlendsIsDrawnFromTheBackToTheFrontWhateverItsOrderInTheLevel) {
  NEEDS_A_CONTEXT();
  auto picture_of = [](bool far_first, const Viewpoint& view) {
    World world;
    for (const vec4 color : {vec4(0.9f, 0.02f, 0.02f, 0.6f), vec4(0.02f, 0.02f, 0.9f, 0.6f)}) {
      Material film;
      film.base_color = color;
      film.alpha = Material::Alpha::kBlend;
      film.double_sided = true;
      world.materials.push_back(film);
    }
    for (const int i : {0, 1}) {
      const bool red = (i == 0) == far_first;  // red lies at z = -0.5, blue at z = 0.5
      DrawMesh draw;
      for (const vec2 p : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)})
        draw.vertices.push_back({.position = {p, red ? -0.5f : 0.5f}, .normal = {0, 0, 1}});
      draw.indices = {0, 1, 2, 0, 2, 3};
      draw.parts = {{0, 6, red ? 0 : 1}};
      world.registry.add<Drawable>(world.registry.create(), {world.draw_meshes.add(std::move(draw))});
    }
    return renderer_for(world)->picture(view, kGlassWidth, kGlassHeight);
  };
  const Viewpoint back{.eye = {0, 0, -4}, .target = {0, 0, 0}};
  const Image a = picture_of(true, kGlassFront), b = picture_of(false, kGlassFront);
  EXPECT_LT(test::perceived_difference(a, b), 0.5);
  const vec3 front = at(a, kGlassWidth / 2, kGlassHeight / 2);
  EXPECT_GT(front.b, front.r + 20) << "blue lies nearer";
  const vec3 from_behind = at(picture_of(true, back), kGlassWidth / 2, kGlassHeight / 2);
  EXPECT_GT(from_behind.r, from_behind.b + 20) << "red lies nearer";
  EXPECT_LT(test::perceived_difference(picture_of(true, back), picture_of(false, back)), 0.5);
}

}  // namespace
}  // namespace pliant
