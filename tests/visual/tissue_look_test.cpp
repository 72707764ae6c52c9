// Light that scatters below a surface, clear coat and specular colour, against surfaces that shine by themselves with
// the radiance that the equations of docs/reference.md give.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "systems/visual/renderer.h"
#include "tests/visual/compare.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::renderer_for;

constexpr int kLookWidth = 160, kLookHeight = 120;
constexpr float kPiLook = std::numbers::pi_v<float>;
const Viewpoint kLookFront{.eye = {0, 0, 4}, .target = {0, 0, 0}};

constexpr float kRoom = 0.5f;  // [1] radiance of the room; the exposure depends on it and on the lamp

// A ball of this material in a room, under a lamp from `lamp` (0: none).
World ball_in_room(const Material& material, vec3 lamp = vec3(0)) {
  World world = test::sphere(64);
  world.environment.panorama = {.name = "room", .width = 8, .height = 4, .rgb = std::vector<float>(96, kRoom)};
  world.materials = {material};
  for (DrawPart& part : world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh].parts)
    part.material = 0;
  const Entity light = world.registry.create();
  mat4 m(1);
  m[2] = vec4(length(lamp) > 0 ? normalize(lamp) : vec3(0, 1, 0), 0);
  world.registry.add<Light>(light, {.intensity = length(lamp)});
  world.registry.add<WorldTransform>(light, {m});
  return world;
}

vec3 middle_of(Renderer& renderer) {
  renderer.options().shadows = false;
  const Image image = renderer.picture(kLookFront, kLookWidth, kLookHeight);
  const std::uint8_t* p = &image.rgba[std::size_t{4} * kLookWidth * (kLookHeight / 2) + 4 * (kLookWidth / 2)];
  return {p[0], p[1], p[2]};
}
vec3 middle_of(const World& world) {
  return middle_of(*renderer_for(world));
}

Material matte(vec3 albedo) {
  Material m;
  m.base_color = vec4(albedo, 1);
  m.roughness = 1;
  m.specular = 0;
  return m;
}

Material shining(vec3 radiance) {
  Material m = matte(vec3(0));
  m.emissive = radiance;
  return m;
}

TEST(TissueLook, ScatteredLightIsThatOfAWrappedCosineAndOfTheSameTotal) {
  NEEDS_A_CONTEXT();
  Material tissue = matte(vec3(0.6f, 0.3f, 0.2f));
  tissue.diffuse_transmission = 0.5f;
  tissue.diffuse_transmission_color = vec3(0);
  tissue.thickness = 0.02f;
  tissue.attenuation_color = {0.8f, 0.45f, 0.35f};
  tissue.attenuation_distance = 0.002f;
  const vec3 path = vec3(-0.002f) / glm::log(tissue.attenuation_color);
  const vec3 wrap = 0.5f * path / (path + 0.02f), albedo(tissue.base_color);
  for (const float angle : {0.0f, 0.9f, 1.4f, kPiLook / 2, 1.7f}) {  // from the middle of the picture to the lamp
    const vec3 n_l(std::cos(angle));
    const vec3 shade = glm::max(n_l + wrap, vec3(0)) / ((1.0f + wrap) * (1.0f + wrap));
    const vec3 lamp = 3.0f * vec3(std::sin(angle), 0, std::cos(angle));
    const Material as_bright = shining(albedo * (3.0f / kPiLook * shade + kRoom));
    EXPECT_LE(length(middle_of(ball_in_room(tissue, lamp)) - middle_of(ball_in_room(as_bright, lamp))), 3) << angle;
  }
  for (int c = 0; c < 3; ++c) {  // over all directions as much as Lambert's cosine: pi
    double sum = 0;
    for (int i = 0; i < 20'000; ++i) {
      const double mu = -1 + (i + 0.5) / 10'000, w = static_cast<double>(wrap[c]);
      sum += 2 * std::numbers::pi * std::max(mu + w, 0.0) / ((1 + w) * (1 + w)) / 10'000;
    }
    EXPECT_NEAR(sum, std::numbers::pi, 1e-3);
  }
}

TEST(TissueLook, ASheetLetsTheRestOfItsLightThrough) {
  NEEDS_A_CONTEXT();
  Material leaf = matte(vec3(0.5f));
  leaf.diffuse_transmission = 0.4f;
  leaf.diffuse_transmission_color = {0.9f, 0.5f, 0.2f};
  const vec3 behind = 0.4f * leaf.diffuse_transmission_color / kPiLook;
  for (const float side : {1.0f, -1.0f}) {
    const vec3 from = {0, 0, 3 * side};
    const vec3 light = 3.0f * (side > 0 ? vec3(0.6f * 0.5f / kPiLook) : behind);
    const Material as_bright = shining(light + kRoom * (vec3(0.6f * 0.5f) + kPiLook * behind));
    EXPECT_LE(length(middle_of(ball_in_room(leaf, from)) - middle_of(ball_in_room(as_bright, from))), 3);
  }
}

TEST(TissueLook, ACoatMirrorsItsShareAndLetsTheRestIn) {
  NEEDS_A_CONTEXT();
  Material wet = matte(vec3(0));
  wet.clearcoat = 1;
  EXPECT_LE(length(middle_of(ball_in_room(wet)) - middle_of(ball_in_room(shining(vec3(0.04f * kRoom))))), 3);
  wet.base_color = vec4(1);  // a white furnace: what the coat mirrors it does not let in
  EXPECT_LE(length(middle_of(ball_in_room(wet)) - middle_of(ball_in_room(shining(vec3(kRoom))))), 3);
  Material gold = matte(vec3(0));
  gold.specular = 0.5f;
  gold.specular_color = {20, 10, 5};  // reflectance 0.04 times this, at most 1, times 0.5
  gold.roughness = 0;
  EXPECT_LE(length(middle_of(ball_in_room(gold)) - middle_of(ball_in_room(shining(kRoom * vec3(0.4f, 0.2f, 0.1f))))),
            4);
}

TEST(TissueLook, AProbeOverASurfaceKeepsItsShareOfTheSurroundingsFromIt) {
  NEEDS_A_CONTEXT();
  World world = ball_in_room(matte(vec3(0.8f)));
  test::add_probe(world, {0, 0, 1.5}, 0.3);  // 0.5 m before the middle of the picture
  auto renderer = renderer_for(world);
  renderer->options().background = false;
  Viewpoint aside = kLookFront;
  aside.eye = {1.5, 0, 2};  // past the probe
  aside.target = {0, 0, 1};
  const auto looked_at = [&](Renderer& from) {
    const Image image = from.picture(aside, kLookWidth, kLookHeight);
    const std::uint8_t* p = &image.rgba[std::size_t{4} * kLookWidth * (kLookHeight / 2) + 4 * (kLookWidth / 2)];
    return vec3(p[0], p[1], p[2]);
  };
  const Material as_bright = shining(vec3(0.8f * kRoom * (1 - 0.36f)));
  EXPECT_LE(length(looked_at(*renderer) - looked_at(*renderer_for(ball_in_room(as_bright)))), 3);
  renderer->options().shadows = false;
  const Material open = shining(vec3(0.8f * kRoom));
  EXPECT_LE(length(looked_at(*renderer) - looked_at(*renderer_for(ball_in_room(open)))), 3);
}

TEST(TissueLook, PressedTissueIsPale) {
  NEEDS_A_CONTEXT();
  Material tissue = matte(vec3(0.5f, 0.1f, 0.08f));
  tissue.diffuse_transmission = 0.5f;
  tissue.thickness = 0.5f;
  tissue.attenuation_distance = 1e-4f;
  tissue.attenuation_color = vec3(0.1f);
  World world = ball_in_room(tissue);
  const vec3 rest = middle_of(world);
  const auto renderer = renderer_for(world);
  const Snapshot pressed = test::snapshot_of(world, [](vec3, vec3) { return vec4(0, 0, 0, -0.004f); });
  renderer->update(pressed);
  const vec3 pale = middle_of(*renderer);
  EXPECT_NEAR(pale.r, rest.r, 3);
  EXPECT_GT(pale.g, rest.g + 20);
}

}  // namespace
}  // namespace pliant
