#include "systems/visual/nearby.h"

#include <algorithm>

namespace pliant {
namespace {

// Shares of the scene's diagonal.
constexpr float kOcclusionReach = 0.12f;
constexpr float kContactReach = 0.03f;
constexpr float kGroundRadius = 1.6f;
constexpr float kGap = 1e-3f;  // below the scene

}  // namespace

Result<NearbyLight> NearbyLight::make() {
  NearbyLight made;
  Result<gpu::Program> ground = gpu::Program::load({"ground.vert", "ground.frag"});
  if (!ground) return ground.error();
  made.ground_program_ = *std::move(ground);
  Result<gpu::Program> occlusion = gpu::Program::load({"screen.vert", "occlusion.frag"});
  if (!occlusion) return occlusion.error();
  made.occlusion_ = *std::move(occlusion);
  Result<gpu::Program> mean = gpu::Program::load({"screen.vert", "occlusion_mean.frag"});
  if (!mean) return mean.error();
  made.mean_ = *std::move(mean);
  made.nothing_ = gpu::VertexArray::make();
  return made;
}

void NearbyLight::place_ground(const std::vector<Box>& boxes) {
  Box scene;
  for (const Box& box : boxes)
    if (!box.empty()) scene.add(box);
  if (scene.empty()) return;
  ground_ = scene.center();
  ground_.y = scene.min.y - kGap * scene.diagonal();
  radius_ = kGroundRadius * scene.diagonal();
}

void NearbyLight::place(const Box& scene, const mat4& projection, const mat4& view, FrameConstants& frame) const {
  frame.view = view;
  frame.lens = {1 / projection[0][0], 1 / projection[1][1], projection[2][2], projection[3][2]};
  frame.ground = vec4(ground_, radius_);
  frame.nearby = vec4(kOcclusionReach, kContactReach, 0, 0) * scene.diagonal();
}

void NearbyLight::draw(const Surfaces& surfaces, bool ground, int width, int height) {
  const int wide = std::max(width / 2, 1), high = std::max(height / 2, 1);
  if (!seen_.has_size(wide, high)) {
    seen_ = gpu::SceneTexture(wide, high, GL_RGBA8);
    for (gpu::SceneTexture& plane : found_) plane = gpu::SceneTexture(wide, high, GL_RGBA8, false);
  }
  seen_.begin();
  surfaces.draw_depth();
  glBindVertexArray(nothing_.id());
  if (ground) {
    glEnable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
    ground_program_.use();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  found_[0].begin();
  seen_.bind_color(kSeenNormalUnit);
  seen_.bind_depth(kSeenDepthUnit);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  occlusion_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  found_[1].begin();
  found_[0].bind_color(kNearbyUnit);
  mean_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  found_[1].bind_color(kNearbyUnit);
}

}  // namespace pliant
