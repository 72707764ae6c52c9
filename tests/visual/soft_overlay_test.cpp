// Debug overlays of soft bodies: tetrahedra, contacts, handles.
#include <gtest/gtest.h>

#include <algorithm>

#include "systems/visual/renderer.h"
#include "tests/visual/compare.h"
#include "tests/visual/golden.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::renderer_for;

constexpr int kOverlayWidth = 192, kOverlayHeight = 144;
const Viewpoint kNear{.eye = {0.5, 1.9, 1.5}, .target = {0, 1, 0}};
const Viewpoint kSlanted{.eye = {1.6, 2.0, 3.4}, .target = {0, 0.45, 0}};

vec3 leaning(vec3 p) {
  return p + vec3(0.4f * p.y * p.y, 0, 0);
}

// Pixels in which `wanted` colour clearly exceeds the other two.
int leading(const Image& image, int wanted, const Image& before) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const int w = image.rgba[i + static_cast<std::size_t>(wanted)],
              a = image.rgba[i + static_cast<std::size_t>((wanted + 1) % 3)],
              b = image.rgba[i + static_cast<std::size_t>((wanted + 2) % 3)];
    count += w > a + 40 && w > b + 40 && !std::equal(&image.rgba[i], &image.rgba[i + 3], &before.rgba[i]);
  }
  return count;
}

TEST(SoftOverlay, TetrahedraStandWhereTheNodesAre) {
  NEEDS_A_CONTEXT();
  const World world = test::soft_block(12);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  renderer->update(test::soft_snapshot_of(world, leaning));
  FrameStats off, on, again;
  const Image without = renderer->picture(kSlanted, kOverlayWidth, kOverlayHeight, &off);
  renderer->options().tetrahedra = true;
  const Image with = renderer->picture(kSlanted, kOverlayWidth, kOverlayHeight, &on);
  test::expect_golden("tetrahedra", with, without);
  renderer->picture(kSlanted, kOverlayWidth, kOverlayHeight, &again);
  EXPECT_EQ(on.upload_bytes - again.upload_bytes, 27u * 12u) << "nodes travel once";
  renderer->options().tetrahedra = false;
  EXPECT_EQ(renderer->picture(kSlanted, kOverlayWidth, kOverlayHeight).rgba, without.rgba);
}

TEST(SoftOverlay, ContactsShowTheirNormalsAndForces) {
  NEEDS_A_CONTEXT();
  World world = test::soft_block(8);
  for (auto [entity, drawable] : world.registry.view<Drawable>())
    for (DrawPart& part : world.draw_meshes[drawable.mesh].parts) part.material = 0;
  world.materials.resize(1);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  SoftSnapshot snapshot = test::soft_snapshot_of(world, [](vec3 p) { return p; });
  snapshot.contacts = {{{-0.3f, 1, 0}, {0, 1, 0}, {0, 0, 0}, false}, {{0.3f, 1, 0}, {0, 1, 0}, {0, 0, 0}, true}};
  snapshot.contact_count = 2;
  renderer->update(snapshot);
  const Image without = renderer->picture(kNear, kOverlayWidth, kOverlayHeight);
  renderer->options().contacts = true;
  const Image normals = renderer->picture(kNear, kOverlayWidth, kOverlayHeight);
  EXPECT_GT(leading(normals, 1, without), 2) << "what sticks is green";
  EXPECT_GT(leading(normals, 0, without), 2) << "what slides is red";
  snapshot.contacts[0].force = {0, 2, 0};
  renderer->update(snapshot);
  EXPECT_GT(test::perceived_difference(normals, renderer->picture(kNear, kOverlayWidth, kOverlayHeight)), 0.05);
  snapshot.contact_count = 0;
  renderer->update(snapshot);
  EXPECT_EQ(renderer->picture(kNear, kOverlayWidth, kOverlayHeight).rgba, without.rgba);
}

TEST(SoftOverlay, MoreContactsThanThereIsRoomForAreCutShort) {
  NEEDS_A_CONTEXT();
  const World world = test::soft_block(4);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  renderer->options().contacts = renderer->options().handles = true;
  SoftSnapshot snapshot;
  snapshot.contacts.assign(3 * kMaxShownContacts, {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, false});
  snapshot.contact_count = 5 * kMaxShownContacts;
  snapshot.handles.resize(9);  // of tools that are not in this level
  renderer->update(snapshot);
  FrameStats stats;
  renderer->picture(kSlanted, kOverlayWidth, kOverlayHeight, &stats);
  EXPECT_LT(stats.upload_bytes, 3 * kMaxShownContacts * 64 + 4096);
}

TEST(SoftOverlay, AHandleShowsItsFrameAndWhatHoldsIt) {
  NEEDS_A_CONTEXT();
  World world = test::soft_block(8);
  Entity tool = kNoEntity;
  for (auto [entity, soft] : world.registry.view<SoftBody>()) tool = entity;
  world.registry.add<Handle6>(tool, {});
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  SoftSnapshot snapshot = test::soft_snapshot_of(world, [](vec3 p) { return p; });
  HandleMark mark;
  mark.tool = tool;
  mark.middle = mark.wanted = {0, 1.1f, 0};
  snapshot.handles = {mark};
  renderer->update(snapshot);
  const Image without = renderer->picture(kNear, kOverlayWidth, kOverlayHeight);
  renderer->options().handles = true;
  const Image frame = renderer->picture(kNear, kOverlayWidth, kOverlayHeight);
  for (const int axis : {0, 1, 2}) EXPECT_GT(leading(frame, axis, without), 1) << axis;
  snapshot.handles[0].wanted = {-0.9f, 1.1f, 0};
  renderer->update(snapshot);
  EXPECT_GT(test::perceived_difference(frame, renderer->picture(kNear, kOverlayWidth, kOverlayHeight)), 0.1)
      << "the coupling";
}

}  // namespace
}  // namespace pliant
