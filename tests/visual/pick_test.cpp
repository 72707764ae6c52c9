// Picking, against geometry: the analytic dent, and rays cast at the displaced triangles one by one.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/visual/renderer.h"
#include "systems/visual/viewpoint.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::dent;
using test::renderer_for;
using test::snapshot_of;

constexpr int kPickWidth = 160, kPickHeight = 120;
const Viewpoint kPickSlanted{.eye = {0.1, 1.0, 1.1}, .target = {-0.2, 0, 0.05}};

struct Ray {
  dvec3 from{0}, along{0};  // [m], [1] world
};

// From the eye through a place of the picture.
Ray ray_through(const Viewpoint& view, const World& world, double x, double y) {
  const mat4 projection = projection_of(view, drawn_box(world, false), static_cast<float>(kPickWidth) / kPickHeight);
  const dmat4 back = glm::inverse(dmat4(projection) * dmat4(view_of(view)));
  const glm::dvec4 far = back * glm::dvec4(2 * x / kPickWidth - 1, 1 - 2 * y / kPickHeight, 1, 1);
  return {view.eye, normalize(dvec3(far) / far.w - view.eye)};
}

std::optional<Picked> pick(Renderer& renderer, const Viewpoint& view, double x, double y) {
  renderer.pick({x, y, kPickWidth, kPickHeight});
  renderer.picture(view, kPickWidth / 10, kPickHeight / 10);  // how fine the picture is does not matter
  const std::optional<PickAnswer> answer = renderer.picked(true);
  EXPECT_TRUE(answer) << "no answer";
  if (answer) {
    EXPECT_EQ(answer->question.x, x);
  }
  return answer ? answer->seen : std::nullopt;
}

// The nearest triangle hit by the ray in the mesh displaced by the stream (Moller and Trumbore, 1997): the slow
// reference of the picking pass.
std::optional<dvec3> cast(const Ray& ray, const World& world, const ObjectSnapshot& object) {
  const Mesh& mesh = test::mesh_of(world);
  auto moved = [&](std::uint32_t v) {
    return dvec3(mesh.position(v)) + double{object.stream[v].w} * dvec3(mesh.normal(v));
  };
  double nearest = std::numeric_limits<double>::max();
  for (const uvec3 t : mesh.triangles) {
    const dvec3 a = moved(t.x), ab = moved(t.y) - a, ac = moved(t.z) - a, p = cross(ray.along, ac);
    const double det = dot(ab, p);
    if (std::abs(det) < 1e-15) continue;
    const dvec3 from = ray.from - a, q = cross(from, ab);
    const double u = dot(from, p) / det, v = dot(ray.along, q) / det, s = dot(ac, q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && s > 0) nearest = std::min(nearest, s);
  }
  if (nearest == std::numeric_limits<double>::max()) return std::nullopt;
  return ray.from + nearest * ray.along;
}

TEST(Picking, OnADentedPlateIsTheDentedSurfaceUnderThePixelAndItsPlaceAtRest) {
  NEEDS_A_CONTEXT();
  const World world = test::sheet(48);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  constexpr float kDepth = 0.12f, kReach = 0.4f;
  const vec3 center(-0.2f, 0, 0);
  const test::StreamAt stream = dent(center, kDepth, kReach);
  const Snapshot pressed = snapshot_of(world, stream);
  renderer->update(pressed);
  // A rasteriser moves corners to a grid within the pixel: the point is that of a ray up to one step of it aside.
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  const double step = std::ldexp(1.0, -bits);
  double largest = 0;  // [m]
  int seen = 0, dented = 0;
  for (double y = 10.5; y < kPickHeight; y += 9)
    for (double x = 10.25; x < kPickWidth; x += 9) {
      const Ray ray = ray_through(kPickSlanted, world, x, y);
      const std::optional<Picked> picked = pick(*renderer, kPickSlanted, x, y);
      const std::optional<dvec3> twin = cast(ray, world, pressed.objects[0]);
      ASSERT_EQ(picked.has_value(), twin.has_value()) << x << ' ' << y;
      if (!picked) continue;
      ++seen;
      EXPECT_EQ(picked->object, test::object_of(world));
      const auto across = cast(ray_through(kPickSlanted, world, x + step, y), world, pressed.objects[0]),
                 along = cast(ray_through(kPickSlanted, world, x, y + step), world, pressed.objects[0]);
      ASSERT_TRUE(across && along);
      const double snapped = length(*across - *twin) + length(*along - *twin);
      largest = std::max(largest, snapped);
      EXPECT_LT(length(picked->point - *twin), snapped + 1e-6) << x << ' ' << y;
      // A facet of edge e = 1/48 m is off the curve by at most f'' e^2 / 8 each way, f'' = 16 depth / reach^2.
      const vec4 s = stream(vec3(picked->rest), {0, 1, 0});
      EXPECT_NEAR(picked->point.y, s.w, 2 * 16 * kDepth / (kReach * kReach) / (48.0 * 48.0) / 8) << x << ' ' << y;
      EXPECT_LT(length(dvec2(picked->point.x - picked->rest.x, picked->point.z - picked->rest.z)), 1e-6);
      EXPECT_LT(std::abs(picked->rest.y), 1e-6);
      EXPECT_LT(length(picked->normal - dvec3(0, 1, 0)), 1e-6);
      dented += picked->point.y < -0.01;
    }
  EXPECT_GT(seen, 60);
  EXPECT_GT(dented, 5) << "the dent was never looked at";
  EXPECT_LT(largest, 2e-4) << "the bound says nothing";
}

TEST(Picking, DistinguishesTwoObjectsAndSeesTheOneInFront) {
  NEEDS_A_CONTEXT();
  World world = test::sphere(32);
  const Entity behind = test::object_of(world), front = world.registry.create();
  world.registry.add<Pose>(front, {{0.6, 0, 1.5}, {1, 0, 0, 0}});
  world.registry.add<Drawable>(front, world.registry.get<Drawable>(behind));
  const Viewpoint view{.eye = {0, 0, 6}, .target = {0, 0, 0}};
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const std::optional<Picked> left = pick(*renderer, view, kPickWidth / 2 - 18, kPickHeight / 2);
  const std::optional<Picked> right = pick(*renderer, view, kPickWidth / 2 + 12, kPickHeight / 2);
  ASSERT_TRUE(left && right);
  EXPECT_EQ(left->object, behind);
  EXPECT_EQ(right->object, front);
  EXPECT_NEAR(length(right->point - dvec3(0.6, 0, 1.5)), 1.0, 5e-3);
  EXPECT_NEAR(length(left->point), 1.0, 5e-3);
  EXPECT_NEAR(dot(left->normal, normalize(left->point)), 1.0, 5e-3);
}

TEST(Picking, NothingThereMeansNothing) {
  NEEDS_A_CONTEXT();
  const World world = test::sphere(32);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  EXPECT_FALSE(renderer->picked(true)) << "an answer without a question";
  EXPECT_FALSE(pick(*renderer, {.eye = {0, 0, 4}, .target = {0, 0, 0}}, 3, 3));
  EXPECT_FALSE(renderer->picked(true)) << "the same answer twice";
}

TEST(Picking, LeavesThePictureAsItIs) {
  NEEDS_A_CONTEXT();
  const World world = test::sheet(32);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image without = renderer->picture(kPickSlanted, kPickWidth, kPickHeight);
  renderer->pick({80, 60, kPickWidth, kPickHeight});
  EXPECT_EQ(without.rgba, renderer->picture(kPickSlanted, kPickWidth, kPickHeight).rgba);
}

}  // namespace
}  // namespace pliant
