#include "content/author/staging.h"

#include <cmath>

#include "content/author/edit_nodes.h"

namespace pliant {

namespace {

struct Target {
  dvec3 middle{0};
  double radius = 0.5;  // [m]
};

Target target_of(const Level& level, std::int32_t object) {
  const Box box = object < 0 ? world_box(level) : world_box(level, object);
  if (box.empty() || box.diagonal() == 0.0f) return {};
  return {dvec3(box.center()), 0.5 * static_cast<double>(box.diagonal())};
}

// A point given by right, up and front coordinates of the level; up is against gravity.
dvec3 from(const Level& level, double right, double up, double front) {
  const dvec3 y = up_of(level), z = std::abs(y.z) > 0.9 ? dvec3(0, -1, 0) : dvec3(0, 0, 1);
  const dvec3 x = normalize(cross(y, z));
  return normalize(right * x + up * y + front * cross(x, y));
}

}  // namespace

std::int32_t add_light(Level& level, std::int32_t object) {
  const Target target = target_of(level, object);
  LevelNode node;
  node.name = "key_light";
  node.light = Light{};
  node.light->color = {1.0f, 0.95f, 0.88f};
  node.light->intensity = 2.5f;
  node.local =
      looking(target.middle + 4.0 * target.radius * from(level, 0.55, 0.62, 0.56), target.middle, up_of(level));
  return add_node(level, std::move(node));
}

std::int32_t add_camera(Level& level, std::int32_t object) {
  constexpr double kRoom = 0.9;  // [1] margin: the tip of an instrument over the object is in the picture too
  const Target target = target_of(level, object);
  LevelNode node;
  node.name = "camera";
  Camera camera;
  camera.yfov = 0.55f;
  const double away = kRoom * target.radius / std::sin(0.5 * static_cast<double>(camera.yfov));
  camera.znear = static_cast<float>(0.02 * away);
  camera.zfar = static_cast<float>(20.0 * away);
  node.camera = camera;
  node.local = looking(target.middle + away * from(level, 0.35, 0.40, 1.0), target.middle, up_of(level));
  return add_node(level, std::move(node));
}

std::int32_t add_material(Level& level, const std::string& name, vec3 color, float roughness) {
  Material material;
  material.name = name;
  material.base_color = vec4(color, 1.0f);
  material.roughness = roughness;
  level.materials.push_back(material);
  return static_cast<std::int32_t>(level.materials.size()) - 1;
}

}  // namespace pliant
