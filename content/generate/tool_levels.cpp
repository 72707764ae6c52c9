#include "content/generate/tool_levels.h"

#include <algorithm>
#include <cmath>

#include "content/generate/hand.h"
#include "content/generate/stage.h"
#include "content/generate/strokes.h"
#include "content/generate/surface_nets.h"

namespace pliant::generate {
namespace {

constexpr double kScriptRate = 100.0;                                                                 // [Hz] of rows
constexpr vec3 kSkin{0.72f, 0.42f, 0.32f}, kStone{0.42f, 0.44f, 0.47f}, kLiver{0.50f, 0.13f, 0.11f};  // linear RGB

// Where the hand stands at some moments; between them it moves smoothly.
struct Waypoint {
  double time;     // [s]
  dvec3 position;  // [m]
  dvec3 turn;      // [degree] about x, then y, then z
};

Path lead(const std::vector<Waypoint>& waypoints) {
  Path path;
  const int rows = static_cast<int>(std::lround(waypoints.back().time * kScriptRate));
  for (int row = 0; row <= rows; ++row) {
    const double t = row / kScriptRate;
    dvec3 position = waypoints.front().position, turn = waypoints.front().turn;
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
      const double s = smooth_step(waypoints[i - 1].time, waypoints[i].time, t);
      position += (waypoints[i].position - waypoints[i - 1].position) * s;
      turn += (waypoints[i].turn - waypoints[i - 1].turn) * s;
    }
    path.rows.push_back({t, position, glm::normalize(dquat(glm::radians(turn)))});
  }
  return path;
}

LevelNode& add_shape(Level& level, const std::string& name, const Solid& solid, const Box& box, double cell,
                     std::int32_t material) {
  Primitive primitive = to_primitive(cover_by_net(solid, box, cell), solid);
  primitive.material = material;
  level.meshes.push_back({name, {std::move(primitive)}});
  LevelNode& node = add_node(level, name);
  node.mesh = static_cast<std::int32_t>(level.meshes.size()) - 1;
  return node;
}

Box around(dvec3 half) {
  return {vec3(-half), vec3(half)};
}

Solid rounded_box(dvec3 half, double radius) {
  return [half, radius](dvec3 p) {
    const dvec3 q = glm::abs(p) - (half - dvec3(radius));
    return length(glm::max(q, dvec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0) - radius;
  };
}

void add_fixed(Level& level, const std::string& name, dvec3 half, dvec3 at, double yaw, std::int32_t material) {
  LevelNode& node = add_shape(level, name, rounded_box(half, 0.004), around(half + dvec3(0.01)), 0.006, material);
  node.local.translation = vec3(at);
  node.local.rotation = quat(dquat(dvec3(0, glm::radians(yaw), 0)));
  node.rigid_body = RigidBody{};
  node.rigid_body->fixed = true;
}

LevelNode& add_soft(Level& level, const std::string& name, const Solid& solid, const Box& box, double net_cell,
                    double cell, double young, std::int32_t material) {
  LevelNode& node = add_shape(level, name, solid, box, net_cell, material);
  node.soft_body = SoftBody{};
  node.soft_body->young = young;
  node.soft_body->poisson = 0.4;
  node.soft_body->rayleigh = {0.5, 0.01};
  node.soft_body->cell = cell;
  return node;
}

// Flesh stiff enough to carry its fingers, on a bone held by a strong coupling.
void add_hand(Level& level, const Waypoint& start) {
  const std::int32_t skin = add_material(level, "skin", kSkin, 0.45f);
  LevelNode& node = add_soft(level, "hand", hand_solid(), hand_box(), 0.0042, 0.0115, 2e5, skin);
  node.local.translation = vec3(start.position);
  node.local.rotation = quat(glm::normalize(dquat(glm::radians(start.turn))));
  node.soft_body->density = 500.0;
  node.soft_body->friction_static = 0.5;
  node.soft_body->friction_sliding = 0.4;
  node.handle = Handle6{};
  node.handle->box = hand_bone();
  node.handle->translation = {1200.0, 12.0};
  node.handle->rotation = {3.0, 0.03};
  node.handle->max_force = 12.0;
  node.handle->max_torque = 1.0;
  node.handle->device = "hand";
  node.device = HapticDevice{};
  node.device->driver = Driver::kScript;
  node.device->file = level.name + ".csv";
  node.device->max_force = 12.0;
}

// On the organ: down with the fingers first, a stroke across, a roll about the fingers' axis, up.
std::vector<Waypoint> organ_path() {
  return {{0.0, {0.0, 0.115, 0.075}, {0, 0, 0}},     {1.5, {0.0, 0.072, 0.060}, {0, 0, 0}},
          {2.3, {0.0, 0.054, 0.060}, {4, 0, 0}},     {4.3, {0.035, 0.056, 0.050}, {4, 0, 0}},
          {5.3, {0.030, 0.056, 0.055}, {4, 0, -10}}, {6.3, {-0.005, 0.056, 0.060}, {4, 0, 6}},
          {7.2, {0.0, 0.100, 0.075}, {0, 0, 0}},     {8.0, {0.0, 0.115, 0.075}, {0, 0, 0}}};
}

// Low over the tray: through the bodies from the right, back, and down on one of them.
std::vector<Waypoint> crowd_path() {
  return {{0.0, {0.125, 0.055, 0.105}, {0, 15, 0}},  {1.0, {0.125, 0.034, 0.100}, {0, 15, 0}},
          {3.2, {-0.010, 0.034, 0.090}, {0, 15, 0}}, {4.4, {0.050, 0.034, 0.090}, {0, -10, 0}},
          {5.6, {0.020, 0.085, 0.090}, {0, 0, 0}},   {6.6, {-0.020, 0.060, 0.085}, {0, 0, 0}},
          {7.4, {-0.020, 0.060, 0.100}, {0, 0, 0}},  {8.0, {-0.010, 0.100, 0.110}, {0, 0, 0}}};
}

// Forward between the walls, a small twist while squeezed, and back.
std::vector<Waypoint> squeeze_path() {
  return {{0.0, {0.0, 0.03, 0.105}, {0, 0, 0}}, {2.4, {0.0, 0.03, 0.012}, {0, 0, 0}},
          {3.4, {0.0, 0.03, 0.012}, {0, 3, 0}}, {4.4, {0.0, 0.03, 0.012}, {0, -3, 0}},
          {5.2, {0.0, 0.03, 0.012}, {0, 0, 0}}, {7.2, {0.0, 0.03, 0.105}, {0, 0, 0}},
          {8.0, {0.0, 0.03, 0.105}, {0, 0, 0}}};
}

Status write_level(const Level& level, const std::vector<Waypoint>& path, const char* comment,
                   const std::filesystem::path& folder) {
  if (Status s = save_level(level, folder / (level.name + ".glb"), SaveOptions{16}); !s) return s;
  return save_script(lead(path), comment, folder / (level.name + ".csv"));
}

}  // namespace

Level hand() {
  Level level;
  level.name = "hand";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  const std::int32_t liver = add_material(level, "liver", kLiver, 0.3f);
  // The organ lies on its back: its groove looks up.
  const Solid upright = organ();
  const Solid lying = [upright](dvec3 p) { return upright({p.x, -p.z, p.y}); };
  LevelNode& body =
      add_soft(level, "organ", lying, {{-0.13f, -0.07f, -0.10f}, {0.14f, 0.07f, 0.11f}}, 0.006, 0.021, 8e3, liver);
  body.soft_body->pinned = {{-0.2f, -0.1f, -0.2f}, {0.2f, -0.022f, 0.2f}};
  add_fixed(level, "table", {0.16, 0.008, 0.13}, {0.0, -0.060, 0.0}, 0.0, stone);
  add_hand(level, organ_path().front());
  add_view(level, {0.34, 0.22, 0.12}, {0.0, 0.02, 0.0}, "sky.exr", {0.4, 0.8, 0.3});
  return level;
}

Level hand_crowd() {
  Level level;
  level.name = "hand_crowd";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  add_fixed(level, "tray", {0.17, 0.006, 0.12}, {0.0, -0.006, 0.0}, 0.0, stone);
  add_fixed(level, "rim_left", {0.006, 0.014, 0.12}, {-0.176, 0.002, 0.0}, 0.0, stone);
  add_fixed(level, "rim_right", {0.006, 0.014, 0.12}, {0.176, 0.002, 0.0}, 0.0, stone);
  add_fixed(level, "rim_back", {0.182, 0.014, 0.006}, {0.0, 0.002, -0.126}, 0.0, stone);
  const auto add = [&](const char* name, const Solid& solid, dvec3 half, dvec3 at, vec3 color) {
    LevelNode& node = add_soft(level, name, solid, around(half + dvec3(0.012)), 0.005, 0.016, 2.5e4,
                               add_material(level, name, color, 0.4f));
    node.local.translation = vec3(at);
    node.soft_body->density = 400.0;
  };
  const auto ball = [](double r) { return [r](dvec3 p) { return length(p) - r; }; };
  const Solid ring = [](dvec3 p) { return length(dvec2(length(dvec2(p.x, p.z)) - 0.026, p.y)) - 0.013; };
  add("ball", ball(0.026), dvec3(0.026), {0.045, 0.028, -0.020}, kCoral);
  add("cube", rounded_box(dvec3(0.024), 0.008), dvec3(0.024), {-0.025, 0.026, -0.055}, kTeal);
  add("ring", ring, {0.040, 0.014, 0.040}, {-0.020, 0.015, 0.020}, kGold);
  add("little_ball", ball(0.020), dvec3(0.020), {-0.100, 0.022, -0.010}, kLiver);
  add_hand(level, crowd_path().front());
  add_view(level, {0.06, 0.32, 0.40}, {0.0, 0.0, -0.01}, "sky.exr", {0.3, 0.8, 0.4});
  return level;
}

Level hand_squeeze() {
  Level level;
  level.name = "hand_squeeze";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  add_fixed(level, "table", {0.16, 0.006, 0.15}, {0.0, -0.041, -0.01}, 0.0, stone);
  add_fixed(level, "wall_left", {0.006, 0.045, 0.060}, {-0.054, 0.010, -0.070}, -17.5, stone);
  add_fixed(level, "wall_right", {0.006, 0.045, 0.060}, {0.054, 0.010, -0.070}, 17.5, stone);
  add_hand(level, squeeze_path().front());
  add_view(level, {0.03, 0.34, 0.10}, {0.0, 0.02, -0.05}, "sky.exr", {0.3, 0.8, 0.4});
  return level;
}

Status write_tool_levels(const std::filesystem::path& folder) {
  if (Status s = write_level(hand(), organ_path(), "presses, strokes and rolls on the organ, then leaves it", folder);
      !s)
    return s;
  if (Status s =
          write_level(hand_crowd(), crowd_path(), "sweeps through the bodies on the tray and presses one", folder);
      !s)
    return s;
  return write_level(hand_squeeze(), squeeze_path(), "pushes the fingers between two walls and draws them back",
                     folder);
}

}  // namespace pliant::generate
