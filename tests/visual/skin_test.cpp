// Moving soft and rigid bodies: their drawn surface follows the soft clock, in every pass.
#include "systems/visual/skin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "systems/visual/gpu/program.h"
#include "systems/visual/renderer.h"
#include "tests/visual/compare.h"
#include "tests/visual/golden.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::expect_golden;
using test::perceived_difference;
using test::renderer_for;
using test::soft_snapshot_of;

constexpr int kSkinWidth = 192, kSkinHeight = 144;
const Viewpoint kSkinSlanted{.eye = {1.6, 2.0, 3.4}, .target = {0, 0.45, 0}};

// Squeezed from above, bulging, and twisted about the vertical.
vec3 squeezed(vec3 p) {
  const float turn = 0.8f * p.y, bulge = 1.0f + 0.9f * p.y * (1 - p.y);
  return {bulge * (std::cos(turn) * p.x + std::sin(turn) * p.z), 0.7f * p.y,
          bulge * (std::cos(turn) * p.z - std::sin(turn) * p.x)};
}

// The block over a floor, in the light of a lamp high on the left.
World block_on_floor() {
  World world = test::soft_block(16);
  Material clay, ground;
  clay.base_color = {0.55f, 0.28f, 0.22f, 1};
  clay.roughness = 0.45f;
  ground.base_color = {0.5f, 0.5f, 0.48f, 1};
  ground.double_sided = true;
  world.materials = {clay, ground};
  for (auto [entity, drawable] : world.registry.view<Drawable>())
    for (DrawPart& part : world.draw_meshes[drawable.mesh].parts) part.material = 0;
  const Entity floor = world.registry.create(), lamp = world.registry.create();
  DrawMesh draw;
  for (const vec3 p : {vec3(-2, 0, -2), vec3(-2, 0, 2), vec3(2, 0, 2), vec3(2, 0, -2)})
    draw.vertices.push_back({.position = p, .normal = {0, 1, 0}});
  draw.indices = {0, 1, 2, 0, 2, 3};
  draw.parts = {{0, 6, 1}};
  world.registry.add<Drawable>(floor, {world.draw_meshes.add(std::move(draw))});
  mat4 m(1);
  m[2] = vec4(normalize(vec3(-1.0f, 0.9f, 0.3f)), 0);
  world.registry.add<Light>(lamp, {.intensity = 6});
  world.registry.add<WorldTransform>(lamp, {m});
  return world;
}

TEST(Skin, FoldedNormalsComeBackToATenthOfAMilliradian) {
  NEEDS_A_CONTEXT();
  constexpr std::size_t kCount = 1024;
  std::mt19937 random(5);
  std::normal_distribution<float> even;
  std::vector<vec4> unit(kCount);
  std::vector<std::uint32_t> packed;
  const vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (std::size_t i = 0; i < kCount; ++i) {
    unit[i] = vec4(i < 6 ? axes[i] : normalize(vec3(even(random), even(random), even(random))), 0);
    packed.push_back(folded(vec3(unit[i])));
  }
  Result<gpu::ShaderSource> source = gpu::expand_shader("unfold.comp", R"(
#include "skin.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer Packed { uint folded[]; };
layout(std430, binding = 3) writeonly buffer Found { vec4 found[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  found[i] = vec4(unfolded(unpackSnorm2x16(folded[i])), 0.0);
}
)");
  ASSERT_TRUE(source) << source.error().message();
  const Result<gpu::Program> program = gpu::Program::link(std::span(&*source, 1));
  ASSERT_TRUE(program) << program.error().message();
  const gpu::Buffer in = gpu::Buffer::fixed<std::uint32_t>(packed),
                    out = gpu::Buffer::writable(nullptr, kCount * sizeof(vec4));
  program->use();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, in.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, out.id());
  glDispatchCompute(kCount / 64, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<vec4> found(kCount);
  glGetNamedBufferSubData(out.id(), 0, kCount * sizeof(vec4), found.data());
  for (std::size_t i = 0; i < kCount; ++i) EXPECT_LT(length(found[i] - unit[i]), 1e-4f) << i;
}

TEST(Skin, ASqueezedBlockLooksAsItDidWhenSomebodyLooked) {
  NEEDS_A_CONTEXT();
  const World world = block_on_floor();
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image rest = renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight);
  renderer->update(soft_snapshot_of(world, squeezed));
  expect_golden("skin", renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight), rest);
}

TEST(Skin, ABlockThatDidNotMoveLooksLikeTheSameBlockAtRest) {
  NEEDS_A_CONTEXT();
  const World world = block_on_floor();
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image rest = renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight);
  renderer->update(soft_snapshot_of(world, [](vec3 p) { return p; }));
  EXPECT_LT(perceived_difference(rest, renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight)), 0.1);
}

TEST(Skin, ThatMovesAsAWholeLooksLikeARigidBodyThere) {
  NEEDS_A_CONTEXT();
  const World world = block_on_floor();
  const Pose pose{{0.3, 0.2, -0.1}, glm::angleAxis(0.5, normalize(dvec3(1, 2, 0.5)))};
  const std::unique_ptr<Renderer> skin = renderer_for(world), rigid = renderer_for(world);
  ASSERT_TRUE(skin && rigid);
  SoftSnapshot snapshot = soft_snapshot_of(world, [&](vec3 p) { return vec3(pose.to_world(dvec3(p))); });
  skin->update(snapshot);
  snapshot.objects[0].position.clear();
  snapshot.objects[0].normal.clear();
  snapshot.objects[0].pose = pose;
  rigid->update(snapshot);
  const Image a = skin->picture(kSkinSlanted, kSkinWidth, kSkinHeight),
              b = rigid->picture(kSkinSlanted, kSkinWidth, kSkinHeight);
  EXPECT_LT(perceived_difference(a, b), 0.1);
  EXPECT_GT(perceived_difference(a, renderer_for(world)->picture(kSkinSlanted, kSkinWidth, kSkinHeight)), 2.0);
}

TEST(Skin, ItsShadowGoesWhereItGoes) {
  NEEDS_A_CONTEXT();
  const World world = block_on_floor();
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Viewpoint above{.eye = {0, 6, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}};
  // Red of the floor at (x, 0, z).
  auto floor_at = [&](const Image& image, double x, double z) {
    const double metre = kSkinHeight / 2 / std::tan(0.5 * above.yfov) / above.eye.y;
    const auto column = static_cast<int>(kSkinWidth / 2 + metre * x),
               row = static_cast<int>(kSkinHeight / 2 + metre * z);
    return int{image.rgba[4 * static_cast<std::size_t>(row * kSkinWidth + column)]};
  };
  // The lamp is at (-1, 0.9, 0.3): a point at height y throws its shadow (y / 0.9) (1, -0.3) further.
  renderer->update(soft_snapshot_of(world, [](vec3 p) { return p; }));
  const Image low = renderer->picture(above, kSkinWidth, kSkinHeight);
  renderer->update(soft_snapshot_of(world, [](vec3 p) { return p * vec3(1, 0.3f, 1); }));
  const Image flat = renderer->picture(above, kSkinWidth, kSkinHeight);
  renderer->options().shadows = false;
  const Image none = renderer->picture(above, kSkinWidth, kSkinHeight);
  const double far = 0.5 + 0.7 / 0.9, z = -0.3 * 0.7 / 0.9;  // in the shadow of the block at rest, not of the flat one
  EXPECT_LT(floor_at(low, far, z), floor_at(none, far, z) - 20);
  EXPECT_NEAR(floor_at(flat, far, z), floor_at(none, far, z), 4);
  EXPECT_LT(floor_at(flat, 0.5 + 0.1 / 0.9, -0.03), floor_at(none, 0.5 + 0.1 / 0.9, -0.03) - 20);
}

TEST(Skin, IsPickedWhereItIs) {
  NEEDS_A_CONTEXT();
  const World world = test::soft_block(8);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  renderer->update(soft_snapshot_of(world, [](vec3 p) { return p + vec3(0, 0, 0.8f); }));
  renderer->pick({kSkinWidth / 2.0, kSkinHeight / 2.0, kSkinWidth, kSkinHeight});
  renderer->picture({.eye = {0, 0.5, 5}, .target = {0, 0.5, 0}}, kSkinWidth, kSkinHeight);
  const std::optional<PickAnswer> answer = renderer->picked(true);
  ASSERT_TRUE(answer && answer->seen);
  EXPECT_LT(length(answer->seen->point - dvec3(0, 0.5, 1.3)), 1e-5);
  EXPECT_LT(length(answer->seen->normal - dvec3(0, 0, 1)), 1e-3);
}

TEST(Skin, SixteenBytesAVertexTravelAndNoneWhileItStandsStill) {
  NEEDS_A_CONTEXT();
  const World world = test::soft_block(16);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  FrameStats stats;
  renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight, &stats);
  const std::uint64_t constants = stats.upload_bytes;
  renderer->update(soft_snapshot_of(world, squeezed));
  renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight, &stats);  // and the placement, which now follows the body
  EXPECT_EQ(stats.upload_bytes - constants, 16u * 6 * 17 * 17 + 144u);
  renderer->update(soft_snapshot_of(world, squeezed));
  renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight, &stats);
  EXPECT_EQ(stats.upload_bytes - constants, 16u * 6 * 17 * 17);
  renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight, &stats);
  EXPECT_EQ(stats.upload_bytes, constants);
}

TEST(Skin, OfAnotherBodyThanTheLevelsIsLeftOut) {
  NEEDS_A_CONTEXT();
  const World world = test::soft_block(8);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  SoftSnapshot snapshot = soft_snapshot_of(world, squeezed);
  snapshot.objects[0].position.pop_back();  // not whole: drawn at rest, by its pose
  const Image rest = renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight);
  renderer->update(snapshot);
  EXPECT_EQ(renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight).rgba, rest.rgba);
  snapshot.objects[0].object = kNoEntity;
  renderer->update(snapshot);
  EXPECT_EQ(renderer->picture(kSkinSlanted, kSkinWidth, kSkinHeight).rgba, rest.rgba);
}

}  // namespace
}  // namespace pliant
