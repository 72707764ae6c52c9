// Views, lights and output paths of pictures: all without a GPU.
#include "systems/visual/viewpoint.h"

#include <gtest/gtest.h>
#include <stb_image.h>

#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "systems/visual/environment.h"
#include "systems/visual/marker_shapes.h"
#include "systems/visual/png.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

TEST(Viewpoint, WithoutACameraEveryVertexIsInTheMiddleOfThePicture) {
  for (const vec3 scale : {vec3(1), vec3(1e-3f, 5e-3f, 1e-3f), vec3(300, 10, 20)}) {
    World world = test::sphere(16);
    for (DrawVertex& v : world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh].vertices)
      v.position *= scale;
    world.registry.get<Pose>(test::object_of(world)).position = {7, -3, 2};
    const Viewpoint view = default_viewpoint(world);
    EXPECT_GT(view.eye.y, view.target.y);
    EXPECT_GT(view.eye.z, view.target.z);
    const Box box = drawn_box(world, true);
    const mat4 clip_from_world = projection_of(view, box, 4.0f / 3.0f) * view_of(view);
    float widest = 0;
    for (const DrawVertex& v : world.draw_meshes[world.registry.get<Drawable>(test::object_of(world)).mesh].vertices) {
      const vec4 clip = clip_from_world * vec4(v.position + vec3(7, -3, 2), 1);
      widest = std::max({widest, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
      EXPECT_LT(std::abs(clip.z), clip.w);
    }
    EXPECT_GT(widest, 0.6f);
    EXPECT_LT(widest, 0.8f);
  }
}

TEST(Viewpoint, TheLevelsCameraIsTakenWhereItStandsAndLooks) {
  World world = test::sphere(8);
  const Entity camera = world.registry.create();
  world.registry.add<Camera>(camera, {.yfov = 0.5f});
  // At (5, 0, 0), turned left by a quarter: looks along -X.
  const mat4 placed =
      glm::translate(mat4(1), vec3(5, 0, 0)) * glm::rotate(mat4(1), 0.5f * float(kHalfTurn), vec3(0, 1, 0));
  world.registry.add<WorldTransform>(camera, {placed});
  const Viewpoint view = default_viewpoint(world);
  EXPECT_LT(length(view.eye - dvec3(5, 0, 0)), 1e-6);
  EXPECT_LT(length(view.target), 1e-5);
  EXPECT_LT(length(view.up - dvec3(0, 1, 0)), 1e-6);
  EXPECT_EQ(view.yfov, 0.5f);
}

Panorama panorama_lit_by(std::uint32_t width, vec3 (*radiance)(vec3)) {
  Panorama p{.name = "made", .width = width, .height = width / 2, .rgb = {}};
  for (std::uint32_t y = 0; y < p.height; ++y)
    for (std::uint32_t x = 0; x < p.width; ++x) {
      const double azimuth = 2 * kHalfTurn * ((x + 0.5) / p.width - 0.5), polar = kHalfTurn * (y + 0.5) / p.height;
      const vec3 c =
          radiance(vec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)));
      p.rgb.insert(p.rgb.end(), {c.r, c.g, c.b});
    }
  return p;
}

TEST(Environment, IrradianceHasItsClosedFormForEveryDegreeOfTheHarmonics) {
  // Radiance 1, d.x, d.y^2 give irradiance pi, 2 pi/3 n.x, pi/4 (1 + n.y^2): the cosine lobe's factors pi, 2 pi/3,
  // pi/4.
  const std::array<vec4, 9> c =
      irradiance_of(panorama_lit_by(256, [](vec3 d) { return vec3(1, 1 + 0.5f * d.x, d.y * d.y); }));
  for (const vec3 n : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, -1), normalize(vec3(1, -2, 3))}) {
    const vec3 e = irradiance_on(c, n);
    EXPECT_NEAR(e.r, kHalfTurn, 1e-3);
    EXPECT_NEAR(e.g, kHalfTurn + 0.5 * 2 * kHalfTurn / 3 * n.x, 1e-3);
    EXPECT_NEAR(e.b, kHalfTurn / 4 * (1 + double{n.y} * n.y), 1e-3);
  }
}

TEST(Environment, TheMiddleColumnLightsWhatFacesMinusZ) {
  const std::array<vec4, 9> c = irradiance_of(panorama_lit_by(64, [](vec3 d) { return vec3(d.z < -0.9f ? 1 : 0); }));
  EXPECT_GT(irradiance_on(c, {0, 0, -1}).r, 10 * std::abs(irradiance_on(c, {0, 0, 1}).r));
}

TEST(Marker, EveryShapesTrianglesFaceTheWayTheirNormalsPoint) {
  for (const MarkerMesh& mesh : {make_ball(), make_rod(), make_cone()})
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const MarkerVertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]],
                         &c = mesh.vertices[mesh.indices[i + 2]];
      const vec3 face = cross(b.position - a.position, c.position - a.position);
      if (length(face) < 1e-6f) continue;  // at a pole
      EXPECT_GT(dot(face, a.normal + b.normal + c.normal), 0) << i;
    }
}

TEST(Png, APictureComesBackFromItsFile) {
  Image image{.name = "", .width = 5, .height = 3, .rgba = {}};
  for (int i = 0; i < 60; ++i) image.rgba.push_back(static_cast<std::uint8_t>(i % 4 == 3 ? 255 : 4 * i));
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "pliant_round_trip.png";
  const Status written = write_png(image, path);
  ASSERT_TRUE(written) << written.error().message();
  int width = 0, height = 0, channels = 0;
  std::uint8_t* pixels = stbi_load(path.c_str(), &width, &height, &channels, 4);
  ASSERT_TRUE(pixels);
  EXPECT_EQ(width, 5);
  EXPECT_EQ(height, 3);
  EXPECT_EQ(std::vector<std::uint8_t>(pixels, pixels + 60), image.rgba);
  stbi_image_free(pixels);
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
}

TEST(Png, AFolderThatIsNotThereIsNamed) {
  const Image image{.name = "", .width = 1, .height = 1, .rgba = {1, 2, 3, 255}};
  const Status written = write_png(image, "/nowhere/at/all/picture.png");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().where, "/nowhere/at/all/picture.png");
}

}  // namespace
}  // namespace pliant
