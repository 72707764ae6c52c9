#include "systems/visual/shadow.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace pliant {
namespace {

constexpr int kMapSize = 1024;  // [pixels]
constexpr float kRoom = 0.06f;  // [1] of the diagonal, margin around the scene at rest for rims and bulges

// The scene in the lamp's view (looking along -Z).
Box seen_from(const mat4& view, const Box& scene) {
  Box seen;
  for (int i = 0; i < 8; ++i) {
    const vec3 corner(i & 1 ? scene.max.x : scene.min.x, i & 2 ? scene.max.y : scene.min.y,
                      i & 4 ? scene.max.z : scene.min.z);
    seen.add(vec3(view * vec4(corner, 1)));
  }
  return seen;
}

mat4 looking(vec3 eye, vec3 forward) {
  return glm::lookAtRH(eye, eye + forward, std::abs(forward.y) < 0.99f ? vec3(0, 1, 0) : vec3(1, 0, 0));
}

}  // namespace

Shadow Shadow::make() {
  Shadow made;
  made.map_ = gpu::DepthMap(kMapSize);
  return made;
}

bool Shadow::place(const LampConstants& lamp, const Box& scene, FrameConstants& frame) const {
  const bool spot = lamp.axis.w > 0;
  if (lamp.place.w > 0 && !spot) return false;
  const vec3 room(kRoom * scene.diagonal());
  const Box box{scene.min - room, scene.max + room};
  mat4 view, projection;
  float width = 0;  // [m] that the map spans, at the scene's middle
  if (spot) {
    view = looking(vec3(lamp.place), vec3(lamp.axis));
    const Box seen = seen_from(view, box);
    const float outer = std::acos(glm::clamp(-lamp.more.x / lamp.axis.w, 0.03f, 0.9999f));
    const float far = -seen.min.z, near = std::max(-seen.max.z, 0.01f * far);
    if (far <= 0) return false;
    projection = glm::perspectiveRH_NO(2 * outer, 1.0f, near, far);
    width = std::tan(outer) * (near + far);
  } else {
    view = looking(box.center(), -vec3(lamp.place));
    const Box seen = seen_from(view, box);
    projection = glm::orthoRH_NO(seen.min.x, seen.max.x, seen.min.y, seen.max.y, -seen.max.z, -seen.min.z);
    width = std::max(seen.size().x, seen.size().y);
  }
  const mat4 to_texture = glm::translate(mat4(1), vec3(0.5f)) * glm::scale(mat4(1), vec3(0.5f));
  frame.shadow_from_world = to_texture * projection * view;
  frame.shadow = vec4(width / kMapSize, 1.0f / kMapSize, 0, 0);
  return true;
}

}  // namespace pliant
