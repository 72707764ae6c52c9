// Probe and force markers from typical views: towards the surface, so that arrows point at the eye.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "systems/visual/renderer.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::renderer_for;

constexpr int kMarkerWidth = 320, kMarkerHeight = 240;
const Viewpoint kMarkerFront{.eye = {0, 0, 4}, .target = {0, 0, 0}};

// Pixels in the yellow of arrows.
int yellow_pixels(const Image& image) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    count += image.rgba[i] > image.rgba[i + 2] + 70 && image.rgba[i + 1] > image.rgba[i + 2] + 70;
  return count;
}

// A probe on the front of a ball, pressed with any force. A set of one point looks like a probe without a stylus.
class Pressed {
 public:
  Pressed(double radius, bool with_stylus) : world_(test::sphere(24)) {
    probe_ = test::add_probe(world_, {0, 0, 1}, radius);
    if (!with_stylus) world_.registry.get<Probe>(probe_).points = {vec3(0)};
    renderer_ = renderer_for(world_);
  }
  int yellow_with(dvec3 force) {
    if (!renderer_) return 0;
    Snapshot pushed;
    pushed.probes.push_back({.probe = probe_, .position = {0, 0, 1}, .force = force, .touching = true});
    renderer_->update(pushed);
    return yellow_pixels(renderer_->picture(kMarkerFront, kMarkerWidth, kMarkerHeight));
  }

 private:
  World world_;
  Entity probe_;
  std::unique_ptr<Renderer> renderer_;
};

TEST(Marker, AStylusLeavesMostOfAnArrowInSightThatPointsAtTheEye) {
  NEEDS_A_CONTEXT();
  for (const double radius : {0.02, 0.15}) {
    Pressed bare(radius, false), held(radius, true);
    for (const double newtons : {0.5, 2.0})
      for (const double tilt : {0.0, 10.0, 20.0, 30.0, 40.0})
        for (double round = 0.0; round < (tilt > 0 ? 360.0 : 1.0); round += 45.0) {
          const double t = glm::radians(tilt), a = glm::radians(round);
          const dvec3 force = newtons * dvec3(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
          const int whole = bare.yellow_with(force);
          ASSERT_GT(whole, 30) << "the arrow is not where this test looks";
          EXPECT_GT(held.yellow_with(force), 0.6 * whole) << "radius " << radius << " m, " << newtons << " N, " << tilt
                                                          << " degrees from the eye, towards " << round;
        }
  }
}

}  // namespace
}  // namespace pliant
