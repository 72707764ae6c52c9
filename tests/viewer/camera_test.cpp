// The user's camera against the geometry of perspective projection.
#include <gtest/gtest.h>

#include <cmath>

#include "systems/visual/viewpoint.h"
#include "viewer/hand/camera_control.h"

namespace pliant {
namespace {

constexpr int kWidth = 640, kHeight = 480;

Box unit_box() {
  Box box;
  box.add(vec3(-0.5f));
  box.add(vec3(0.5f));
  return box;
}

const Viewpoint kHome{.eye = {1.0, 1.5, 3.0}, .target = {0.1, 0.2, -0.1}, .yfov = 0.7f};

// The view after the camera has come to rest.
Viewpoint settled(CameraControl& camera) {
  camera.update(10.0);
  return camera.viewpoint();
}

// [pixel] Projection of a point by the renderer's matrices.
dvec2 pixel_of(const Viewpoint& view, const dvec3& point) {
  const mat4 m = projection_of(view, unit_box(), static_cast<float>(kWidth) / kHeight) * view_of(view);
  const glm::dvec4 clip = glm::dmat4(m) * glm::dvec4(point, 1);
  return {(0.5 + 0.5 * clip.x / clip.w) * kWidth, (0.5 - 0.5 * clip.y / clip.w) * kHeight};
}

TEST(Camera, BeginsAtItsHomeAndComesBackToIt) {
  CameraControl camera(kHome, unit_box());
  EXPECT_LT(length(camera.viewpoint().eye - kHome.eye), 1e-9);
  EXPECT_LT(length(camera.viewpoint().target - kHome.target), 1e-9);
  camera.orbit(200, -90, kHeight);
  camera.pan(33, 44, kHeight);
  camera.zoom(3);
  EXPECT_GT(length(settled(camera).eye - kHome.eye), 0.1);
  camera.home();
  EXPECT_LT(length(settled(camera).eye - kHome.eye), 1e-9);
}

TEST(Camera, OrbitKeepsTargetAndDistanceAndALevelHorizon) {
  CameraControl camera(kHome, unit_box());
  const double distance = length(kHome.eye - kHome.target);
  for (const double dx : {37.0, -400.0, 1000.0})
    for (const double dy : {-250.0, 90.0, 5000.0}) {
      camera.orbit(dx, dy, kHeight);
      camera.update(0.05);  // on the way as well as at the end
      for (const Viewpoint& view : {camera.viewpoint(), settled(camera)}) {
        EXPECT_LT(length(view.target - kHome.target), 1e-12);
        EXPECT_NEAR(length(view.eye - view.target), distance, 1e-9 * distance);
        EXPECT_EQ(view.up, dvec3(0, 1, 0));
        EXPECT_LT(std::abs(dot(normalize(view.eye - view.target), view.up)), 1.0 - 1e-6) << "straight down";
      }
    }
}

TEST(Camera, DraggingToTheRightTurnsTheSceneToTheRight) {
  CameraControl camera(kHome, unit_box());
  const dvec3 front = kHome.target + 0.3 * normalize(kHome.eye - kHome.target);  // a point on the near side
  camera.orbit(20, 0, kHeight);
  EXPECT_GT(pixel_of(settled(camera), front).x, pixel_of(kHome, front).x + 1);
  camera.home();
  camera.orbit(0, 20, kHeight);
  EXPECT_GT(pixel_of(settled(camera), front).y, pixel_of(kHome, front).y + 1);
}

TEST(Camera, PanMovesEyeAndTargetAlikeAndWhatIsAtTheTargetsDistanceStaysUnderTheHand) {
  CameraControl camera(kHome, unit_box());
  const dvec2 before = pixel_of(kHome, kHome.target);
  camera.pan(60, -25, kHeight);
  const Viewpoint view = settled(camera);
  EXPECT_LT(length((view.eye - kHome.eye) - (view.target - kHome.target)), 1e-9);
  const dvec2 after = pixel_of(view, kHome.target);
  EXPECT_NEAR(after.x - before.x, 60, 1e-3);
  EXPECT_NEAR(after.y - before.y, -25, 1e-3);
}

TEST(Camera, ZoomKeepsTheTargetInPlaceAndOneClickInUndoesOneOut) {
  CameraControl camera(kHome, unit_box());
  camera.zoom(2);
  const Viewpoint near = settled(camera);
  EXPECT_LT(length(near.eye - near.target), length(kHome.eye - kHome.target));
  EXPECT_LT(length(pixel_of(near, kHome.target) - pixel_of(kHome, kHome.target)), 1e-3);
  EXPECT_NEAR(dot(normalize(near.eye - near.target), normalize(kHome.eye - kHome.target)), 1.0, 1e-12);
  camera.zoom(-2);
  EXPECT_LT(length(settled(camera).eye - kHome.eye), 1e-9);
  camera.zoom(1000);
  EXPECT_GT(length(settled(camera).eye - kHome.target), 0.01) << "through the target";
  camera.zoom(-5000);
  EXPECT_LT(length(settled(camera).eye), 100) << "out of sight";
}

TEST(Camera, FrameShowsTheWholeBoxAndFillsMuchOfThePicture) {
  for (const auto& [azimuth, elevation] : {std::pair(0.0, 0.0), std::pair(2.0, 0.7), std::pair(-1.0, -1.2)}) {
    CameraControl camera(kHome, unit_box());
    camera.pan(500, 300, kHeight);
    camera.zoom(-20);
    camera.look_from(azimuth, elevation);
    camera.frame();
    const Viewpoint view = settled(camera);
    double least = 1e9, most = -1e9;
    for (int corner = 0; corner < 8; ++corner) {
      const dvec2 at = pixel_of(view, dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 0.5);
      EXPECT_TRUE(at.x >= 0 && at.x <= kWidth && at.y >= 0 && at.y <= kHeight) << corner;
      least = std::min(least, at.y);
      most = std::max(most, at.y);
    }
    EXPECT_GT(most - least, 0.4 * kHeight);
  }
}

TEST(Camera, LooksFromTheFrontTheRightAndAbove) {
  CameraControl camera(kHome, unit_box());
  const auto way = [&](double azimuth, double elevation) {
    camera.look_from(azimuth, elevation);
    const Viewpoint view = settled(camera);
    return normalize(view.eye - view.target);
  };
  const double quarter = glm::half_pi<double>();
  EXPECT_LT(length(way(0, 0) - dvec3(0, 0, 1)), 1e-9);
  EXPECT_LT(length(way(quarter, 0) - dvec3(1, 0, 0)), 1e-9);
  EXPECT_LT(length(way(0, quarter) - dvec3(0, 1, 0)), 0.03) << "a little short of straight down, where up is lost";
}

TEST(Camera, FollowsSmoothlyAtAnyFrameRate) {
  CameraControl fast(kHome, unit_box()), slow(kHome, unit_box());
  for (CameraControl* camera : {&fast, &slow}) camera->pan(100, 0, kHeight), camera->orbit(50, 20, kHeight);
  for (int i = 0; i < 100; ++i) fast.update(0.002);
  slow.update(0.2);
  EXPECT_LT(length(fast.viewpoint().eye - slow.viewpoint().eye), 1e-9);
}

TEST(Camera, ARayThroughAPixelMeetsWhatIsDrawnThere) {
  for (const double x : {0.0, 200.5, 640.0})
    for (const double y : {0.0, 111.0, 480.0}) {
      const ViewRay ray = ray_through(kHome, x, y, kWidth, kHeight);
      EXPECT_NEAR(length(ray.along), 1.0, 1e-12);
      const dvec2 at = pixel_of(kHome, ray.from + 3.0 * ray.along);
      EXPECT_NEAR(at.x, x, 2e-3);
      EXPECT_NEAR(at.y, y, 2e-3);
    }
}

}  // namespace
}  // namespace pliant
