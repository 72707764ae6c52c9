#include "systems/visual/viewpoint.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "components/soft_body.h"

namespace pliant {
namespace {

// Calls visit(point) for every drawn vertex at rest, world frame.
template <class Visit>
void each_point(const World& world, bool only_soft, Visit visit) {
  for (auto [entity, drawable] : world.registry.view<Drawable>()) {
    if (only_soft && !world.registry.has<Deformable>(entity) && !world.registry.has<SoftBody>(entity)) continue;
    const mat4 to_world = placement_of(world, entity);
    for (const DrawVertex& v : world.draw_meshes[drawable.mesh].vertices) visit(vec3(to_world * vec4(v.position, 1)));
  }
}

// The level's camera looks along its -Z; the target is at the distance of the scene's centre.
Viewpoint from_camera(const Camera& camera, const mat4& m, const Box& scene) {
  const dvec3 eye(m[3]), forward = -normalize(dvec3(m[2])), up = normalize(dvec3(m[1]));
  const double away = scene.empty() ? 1.0 : std::max(dot(dvec3(scene.center()) - eye, forward), 1e-3);
  return {.eye = eye, .target = eye + away * forward, .up = up, .yfov = camera.yfov};
}

}  // namespace

mat4 matrix_of(const Pose& pose) {
  return pose.matrix();
}

mat4 placement_of(const World& world, Entity entity) {
  if (const Pose* pose = world.registry.find<Pose>(entity)) return matrix_of(*pose);
  const WorldTransform* transform = world.registry.find<WorldTransform>(entity);
  return transform ? transform->matrix : mat4(1);
}

Box drawn_box(const World& world, bool only_soft) {
  Box all;
  each_point(world, only_soft, [&](vec3 point) { all.add(point); });
  return all;
}

Viewpoint default_viewpoint(const World& world) {
  Box scene = drawn_box(world, true);
  const bool only_soft = !scene.empty();
  if (!only_soft) scene = drawn_box(world, false);
  for (auto [entity, camera] : world.registry.view<Camera>())
    if (const WorldTransform* transform = world.registry.find<WorldTransform>(entity))
      return from_camera(camera, transform->matrix, scene);
  if (scene.empty()) scene.add(Box{vec3(-0.5f), vec3(0.5f)});

  // Slightly above the front and a little from the right; as close as a 4:3 picture allows with room for probes.
  constexpr float kElevation = 0.55f, kAzimuth = 0.3f;     // [rad]
  constexpr float kFilled = 0.70f, kAspect = 4.0f / 3.0f;  // [1]
  Viewpoint view;
  const vec3 backward(std::cos(kElevation) * std::sin(kAzimuth), std::sin(kElevation),
                      std::cos(kElevation) * std::cos(kAzimuth));
  const vec3 right = normalize(cross(vec3(0, 1, 0), backward)), up = cross(backward, right);
  const float slope = std::tan(0.5f * view.yfov) * kFilled;
  float away = 1e-6f;
  auto keep_in_sight = [&](vec3 point) {
    const vec3 p = point - scene.center();
    away = std::max(away, dot(p, backward) + std::max(std::abs(dot(p, up)), std::abs(dot(p, right)) / kAspect) / slope);
  };
  each_point(world, only_soft, keep_in_sight);
  view.target = scene.center();
  view.eye = view.target + dvec3(away * backward);
  return view;
}

mat4 view_of(const Viewpoint& viewpoint) {
  // Looking exactly along `up`, any other axis serves.
  const dvec3 forward = viewpoint.target - viewpoint.eye;
  const bool along = length(cross(forward, viewpoint.up)) < 1e-6 * length(forward);
  return mat4(glm::lookAtRH(viewpoint.eye, viewpoint.target, along ? dvec3(0, 0, -1) : viewpoint.up));
}

mat4 projection_of(const Viewpoint& viewpoint, const Box& scene, float aspect) {
  // Probes hover around the scene: the clip planes leave twice its diagonal in front and behind.
  const float away = static_cast<float>(length(dvec3(scene.center()) - viewpoint.eye));
  const float far = away + 2.0f * scene.diagonal();
  const float near = std::max(away - 2.0f * scene.diagonal(), 2e-3f * far);
  return glm::perspectiveRH_NO(viewpoint.yfov, aspect, near, far);
}

}  // namespace pliant
