// Whole pictures, against positions computed from geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "systems/visual/renderer.h"
#include "systems/visual/viewpoint.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::awake_only;
using test::dent;
using test::renderer_for;
using test::snapshot_of;

constexpr int kWidth = 160, kHeight = 120;

// The projection of a world point, in pixels from the top left.
vec2 pixel_of(const Viewpoint& view, const World& world, vec3 point) {
  const mat4 projection = projection_of(view, drawn_box(world, false), static_cast<float>(kWidth) / kHeight);
  const vec4 clip = projection * view_of(view) * vec4(point, 1);
  return {(0.5f + 0.5f * clip.x / clip.w) * kWidth, (0.5f - 0.5f * clip.y / clip.w) * kHeight};
}

// Largest difference of a channel at a pixel.
int difference(const Image& a, const Image& b, int x, int y) {
  int most = 0;
  for (int c = 0; c < 3; ++c) {
    const std::size_t i = 4 * static_cast<std::size_t>(y * kWidth + x) + static_cast<std::size_t>(c);
    most = std::max(most, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
  }
  return most;
}

int differing_pixels(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) count += difference(a, b, x, y) > 0;
  return count;
}

const Viewpoint kAbove{.eye = {0, 2.2, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}};
const Viewpoint kFront{.eye = {0, 0, 4}, .target = {0, 0, 0}};

TEST(Picture, ADentIsSeenWhereItIsAndNowhereElse) {
  NEEDS_A_CONTEXT();
  const World world = test::sheet(64);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const vec3 center(-0.5f, 0, 0.1f);
  constexpr float kReach = 0.25f;
  const Image rest = renderer->picture(kAbove, kWidth, kHeight);
  renderer->update(snapshot_of(world, dent(center, 0.05f, kReach)));
  const Image pressed = renderer->picture(kAbove, kWidth, kHeight);

  const vec2 middle = pixel_of(kAbove, world, center);
  const float radius = length(pixel_of(kAbove, world, center + vec3(kReach, 0, 0)) - middle);
  int inside = 0, seen = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const float away = length(vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) - middle);
      if (away > radius + 2) {
        EXPECT_EQ(difference(rest, pressed, x, y), 0) << x << ' ' << y;
      }
      if (away < 0.7f * radius) ++inside, seen += difference(rest, pressed, x, y) > 4;
    }
  ASSERT_GT(inside, 100);
  EXPECT_GT(seen, inside * 7 / 10);
}

TEST(Picture, ABodyPushedOutByAnEvenHeightHasTheSilhouetteOfALargerOne) {
  NEEDS_A_CONTEXT();
  World world = test::sphere(96);
  // Heights act along the touch normals: how the surface is shaded must not matter.
  for (DrawVertex& v : world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh].vertices)
    v.normal = {0, 0, 1};
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  auto picture_at = [&](float height) {
    renderer->update(snapshot_of(world, [=](vec3, vec3) { return vec4(0, 0, 0, height); }));
    return renderer->picture(kFront, kWidth, kHeight);
  };
  const Image nothing = picture_at(-1.0f);  // shrunk to a point
  for (const float height : {-0.3f, 0.0f, 0.2f}) {
    // Seen from distance D, a sphere of radius R fills a cone of sine R / D.
    const double angle = std::asin((1.0 + height) / length(kFront.eye));
    const double radius = std::tan(angle) / std::tan(0.5 * kFront.yfov) * kHeight / 2;
    const double area = std::numbers::pi * radius * radius, edge = 2 * std::numbers::pi * radius;
    // A pixel that is covered in part counts whole: half of the edge, on average.
    EXPECT_NEAR(differing_pixels(nothing, picture_at(height)), area + 0.5 * edge, 0.5 * edge) << height;
  }
}

TEST(Picture, ANormalCorrectionAloneChangesShadingButNotTheSilhouette) {
  NEEDS_A_CONTEXT();
  const World world = test::sphere(96);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image rest = renderer->picture(kFront, kWidth, kHeight);
  renderer->update(snapshot_of(world, [](vec3, vec3) { return vec4(0.5f, 0, 0, 0); }));
  const Image tilted = renderer->picture(kFront, kWidth, kHeight);
  renderer->update(snapshot_of(world, [](vec3, vec3) { return vec4(0, 0, 0, -1); }));
  const Image nothing = renderer->picture(kFront, kWidth, kHeight);

  EXPECT_NEAR(differing_pixels(rest, nothing), differing_pixels(tilted, nothing), 2);
  EXPECT_GT(differing_pixels(rest, tilted), differing_pixels(rest, nothing) * 8 / 10);
}

TEST(Picture, NothingTravelsButAwakeZonesAndTheFramesConstants) {
  NEEDS_A_CONTEXT();
  World world = test::sheet(64);
  test::add_probe(world, {0, 0, 0});
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  FrameStats stats;
  renderer->picture(kAbove, kWidth, kHeight, &stats);
  EXPECT_LE(stats.upload_bytes, 4096u);
  const std::uint64_t constants = stats.upload_bytes;

  const Snapshot pressed = awake_only(world, snapshot_of(world, dent({0, 0, 0}, 0.02f, 0.1f)));
  const ObjectSnapshot& object = pressed.objects[0];
  ASSERT_GT(object.zone_count, 2u);
  ASSERT_LT(object.zone_count, test::mesh_of(world).zone_count() / 2);
  renderer->update(pressed);
  renderer->update(pressed);  // the same zones again before the next picture: they travel once
  renderer->picture(kAbove, kWidth, kHeight, &stats);
  EXPECT_EQ(stats.upload_bytes - constants, std::uint64_t{object.zone_count} * kZoneSize * sizeof(vec4));
  EXPECT_LE(stats.upload_bytes, 16u * object.awake_vertices + 4096u);
  renderer->picture(kAbove, kWidth, kHeight, &stats);
  EXPECT_EQ(stats.upload_bytes, constants);
}

TEST(Picture, TheSameStateGivesTheSamePictureFromTwoRenderers) {
  NEEDS_A_CONTEXT();
  World world = test::sheet(32);
  test::add_probe(world, {0.3, 0, 0});
  const Snapshot pressed = snapshot_of(world, dent({0.3f, 0, 0}, 0.05f, 0.3f));
  Image pictures[2];
  for (Image& picture : pictures) {
    const std::unique_ptr<Renderer> renderer = renderer_for(world);
    ASSERT_TRUE(renderer);
    renderer->update(pressed);
    picture = renderer->picture(default_viewpoint(world), kWidth, kHeight);
    EXPECT_EQ(picture.rgba, renderer->picture(default_viewpoint(world), kWidth, kHeight).rgba);
  }
  EXPECT_EQ(pictures[0].rgba, pictures[1].rgba);
}

TEST(Picture, AProbeIsSeenInItsColourAtItsPlaceAndItsForceAsAnArrow) {
  NEEDS_A_CONTEXT();
  World world = test::sheet(32);
  const Entity probe = test::add_probe(world, {0.3, 0, 0.1}, 0.05);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  renderer->options().markers = false;
  const Image bare = renderer->picture(kFront, kWidth, kHeight);
  renderer->options().markers = true;
  const Image idle = renderer->picture(kFront, kWidth, kHeight);
  const vec2 at = pixel_of(kFront, world, {0.3f, 0, 0.1f});
  const std::uint8_t* rgb = &idle.rgba[4 * static_cast<std::size_t>(int(at.y) * kWidth + int(at.x))];
  EXPECT_GT(rgb[0], 2 * rgb[1]);  // red
  EXPECT_GT(rgb[0], 2 * rgb[2]);

  // Two newtons to the left: an arrow of a fifth of the scene's diagonal, and nothing of it on the right.
  Snapshot pushed;
  pushed.probes.push_back({.probe = probe, .position = {0.3, 0, 0.1}, .force = {-2, 0, 0}, .touching = true});
  renderer->update(pushed);
  const Image felt = renderer->picture(kFront, kWidth, kHeight);
  const float along = 0.5f * 0.2f * drawn_box(world, false).diagonal();
  const vec2 middle = pixel_of(kFront, world, vec3(0.3f - along, 0, 0.1f));
  const vec2 opposite = pixel_of(kFront, world, vec3(0.3f + along, 0, 0.1f));
  EXPECT_GT(difference(bare, felt, int(middle.x), int(middle.y)), 10);
  EXPECT_EQ(difference(bare, idle, int(middle.x), int(middle.y)), 0);
  EXPECT_EQ(difference(bare, felt, int(opposite.x), int(opposite.y)), 0);
}

TEST(Picture, WhatDoesNotGiveWayIsDrawnTooAndStaysAtRest) {
  NEEDS_A_CONTEXT();
  World world = test::sphere(32);
  const Entity object = test::object_of(world);
  const Snapshot pressed = snapshot_of(world, [](vec3, vec3) { return vec4(0, 0, 0, -0.5f); });
  world.registry.remove<Deformable>(object);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image rest = renderer->picture(kFront, kWidth, kHeight);
  renderer->update(pressed);
  EXPECT_EQ(differing_pixels(rest, renderer->picture(kFront, kWidth, kHeight)), 0);
  world.registry.remove<Drawable>(object);
  EXPECT_GT(differing_pixels(rest, renderer_for(world)->picture(kFront, kWidth, kHeight)), 3000);
}

TEST(Picture, HeightsThatStandBeforeTheFirstSnapshotAreDrawn) {
  NEEDS_A_CONTEXT();
  World world = test::sheet(32);
  const Snapshot pressed = snapshot_of(world, dent({0, 0, 0}, 0.1f, 0.4f));
  const std::unique_ptr<Renderer> reported = renderer_for(world);
  ASSERT_TRUE(reported);
  reported->update(pressed);
  HeightField field;
  field.stream = pressed.objects[0].stream;
  world.registry.get<Deformable>(test::object_of(world)).field = world.fields.add(field);
  const std::unique_ptr<Renderer> found = renderer_for(world);
  ASSERT_TRUE(found);
  EXPECT_EQ(reported->picture(kAbove, kWidth, kHeight).rgba, found->picture(kAbove, kWidth, kHeight).rgba);
}

TEST(Picture, HeightAsColourIsOffByDefaultAndPaintsDentsBlue) {
  NEEDS_A_CONTEXT();
  const World world = test::sheet(32);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  renderer->update(snapshot_of(world, dent({0, 0, 0}, 0.1f, 0.4f)));
  const Image plain = renderer->picture(kAbove, kWidth, kHeight);
  renderer->options().tint_height = 0.1f;
  const Image tinted = renderer->picture(kAbove, kWidth, kHeight);
  const std::size_t middle = 4 * (kHeight / 2 * kWidth + kWidth / 2);
  EXPECT_GT(plain.rgba[middle], plain.rgba[middle + 2]);
  EXPECT_LT(tinted.rgba[middle], tinted.rgba[middle + 2]);
}

TEST(Picture, MaterialsColourTheirPartOfTheMesh) {
  NEEDS_A_CONTEXT();
  World world = test::sheet(32);
  Material green, blue;
  green.base_color = {0.05f, 0.6f, 0.05f, 1};
  green.double_sided = blue.double_sided = true;
  world.images.push_back({.name = "blue", .width = 1, .height = 1, .rgba = {10, 10, 220, 255}});
  blue.base_color = vec4(1);
  blue.base_color_texture = 0;
  world.materials = {green, blue};
  DrawMesh& draw = world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh];
  const std::uint32_t half = static_cast<std::uint32_t>(draw.indices.size()) / 2;  // rows go from -Z to +Z
  draw.parts = {{0, half, 0}, {half, half, 1}};
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image picture = renderer->picture(kAbove, kWidth, kHeight);
  const std::uint8_t* far = &picture.rgba[4 * (static_cast<std::size_t>(kHeight) / 3 * kWidth + kWidth / 2)];
  const std::uint8_t* near = &picture.rgba[4 * (static_cast<std::size_t>(kHeight) * 2 / 3 * kWidth + kWidth / 2)];
  EXPECT_GT(far[1], far[0] + 20);
  EXPECT_GT(far[1], far[2] + 20);
  EXPECT_GT(near[2], near[0] + 20);
  EXPECT_GT(near[2], near[1] + 20);
}

TEST(Picture, LeavingOutTheBackOfAClosedBodyChangesNothing) {
  NEEDS_A_CONTEXT();
  World world = test::sphere(32);
  const Image both = renderer_for(world)->picture(kFront, kWidth, kHeight);
  Mesh& mesh = world.meshes[world.registry.get<Deformable>(test::object_of(world)).mesh];
  mesh.closed = true;
  EXPECT_LE(differing_pixels(both, renderer_for(world)->picture(kFront, kWidth, kHeight)), 4);
  for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);  // inside out: only its back is visible
  EXPECT_EQ(differing_pixels(both, renderer_for(world)->picture(kFront, kWidth, kHeight)), 0);
}

TEST(Picture, ABlendedBodyWithoutTransparencyLooksLikeAnOpaqueOneAndAClearOneLikeNone) {
  NEEDS_A_CONTEXT();
  World world = test::sphere(32);
  DrawMesh& draw = world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh];
  // A glowing core, drawn after the shell that hides it.
  const std::uint32_t count = static_cast<std::uint32_t>(draw.vertices.size());
  const std::uint32_t shell = static_cast<std::uint32_t>(draw.indices.size());
  for (std::uint32_t i = 0; i < count; ++i) draw.vertices.push_back(draw.vertices[i]);
  for (std::uint32_t i = count; i < 2 * count; ++i) draw.vertices[i].position *= 0.5f;
  for (std::uint32_t i = 0; i < shell; ++i) draw.indices.push_back(count + draw.indices[i]);
  draw.parts = {{0, shell, 0}, {shell, shell, 1}};
  world.materials.resize(2);
  for (Material& m : world.materials) m.double_sided = true;
  world.materials[1].emissive = {1, 0, 0};
  const Image opaque = renderer_for(world)->picture(kFront, kWidth, kHeight);
  for (Material& m : world.materials) m.alpha = Material::Alpha::kBlend;
  const Image blended = renderer_for(world)->picture(kFront, kWidth, kHeight);
  for (Material& m : world.materials) m.base_color.a = 0.0f;
  const Image clear = renderer_for(world)->picture(kFront, kWidth, kHeight);
  world.registry.remove<Drawable>(test::object_of(world));
  const Image nothing = renderer_for(world)->picture(kFront, kWidth, kHeight);

  // The edge's samples may lie over the far side instead of the background.
  EXPECT_LT(differing_pixels(opaque, blended), 150);
  EXPECT_GT(differing_pixels(opaque, nothing), 3000);
  int seen = 0;  // the light's exposure knows the scene's size, the background's rays the clip planes: to a step of 255
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) seen += difference(clear, nothing, x, y) > 2;
  EXPECT_EQ(seen, 0);
}

TEST(Picture, AMaterialsBrokenPictureStopsTheRendererWithItsName) {
  NEEDS_A_CONTEXT();
  World world = test::sheet(4);
  world.images.push_back({.name = "hole.png", .width = 8, .height = 8, .rgba = {}});
  world.materials.emplace_back().base_color_texture = 0;
  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(world);
  ASSERT_FALSE(renderer);
  EXPECT_EQ(renderer.error().where, "hole.png");
}

}  // namespace
}  // namespace pliant
