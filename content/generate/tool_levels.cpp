#include "content/generate/tool_levels.h"

#include "content/author/hand.h"
#include "content/generate/stage.h"
#include "content/generate/tool_stage.h"

namespace pliant::generate {
namespace {

// A hand of soft tissue, stiff enough to keep its fingers straight, on a bone with a strong virtual coupling.
void add_hand(Level& level, const Waypoint& start) {
  const std::int32_t skin = add_tissue(level, "skin", 0.02f);
  LevelNode& node = add_soft(level, "hand", hand_solid(), hand_box(), 0.0042, 0.0115, 2e5, skin);
  place(node, start);
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
  node.device = script_device(level.name + ".csv", 10.0);
}

// On the organ: down, fingers first, a stroke across, a roll about the fingers' axis, up.
std::vector<Waypoint> organ_path() {
  return {{0.0, {0.0, 0.115, 0.075}, {0, 0, 0}},     {1.5, {0.0, 0.072, 0.060}, {0, 0, 0}},
          {2.3, {0.0, 0.054, 0.060}, {4, 0, 0}},     {4.3, {0.035, 0.056, 0.050}, {4, 0, 0}},
          {5.3, {0.030, 0.056, 0.055}, {4, 0, -10}}, {6.3, {-0.005, 0.056, 0.060}, {4, 0, 6}},
          {7.2, {0.0, 0.100, 0.075}, {0, 0, 0}},     {8.0, {0.0, 0.115, 0.075}, {0, 0, 0}}};
}

// Down onto the cube and the ring in front of it, and up. Then down onto two balls in their cups, a roll from one to
// the other, and up. Slow, so that the bodies yield and roll without impacts.
std::vector<Waypoint> crowd_path() {
  return {{0.0, {0.055, 0.105, 0.130}, {0, 0, 0}},   {0.6, {0.055, 0.105, 0.130}, {0, 0, 0}},
          {2.4, {0.055, 0.066, 0.130}, {0, 0, 0}},   {3.4, {0.055, 0.066, 0.130}, {0, 0, 6}},
          {5.0, {0.055, 0.105, 0.130}, {0, 0, 0}},   {6.2, {-0.062, 0.100, 0.105}, {0, 0, 0}},
          {8.2, {-0.062, 0.070, 0.105}, {0, 0, 0}},  {9.2, {-0.062, 0.070, 0.105}, {0, 0, 8}},
          {10.5, {-0.062, 0.105, 0.110}, {0, 0, 0}}, {11.0, {-0.062, 0.105, 0.110}, {0, 0, 0}}};
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
  if (Status s = write_scene(level, folder); !s) return s;
  return write_path(path, comment, level.name + ".csv", folder);
}

}  // namespace

Level hand() {
  Level level;
  level.name = "hand";
  level.about = "A soft hand presses and strokes a soft organ, sticks, slips and rolls on it.";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  const std::int32_t liver = add_tissue(level, "liver", 0.08f);
  // The organ lies on its back: its groove points up.
  const Solid upright = organ();
  const Solid lying = [upright](dvec3 p) { return upright({p.x, -p.z, p.y}); };
  LevelNode& body =
      add_soft(level, "organ", lying, {{-0.13f, -0.07f, -0.10f}, {0.14f, 0.07f, 0.11f}}, 0.006, 0.021, 8e3, liver);
  body.soft_body->pinned = {{-0.2f, -0.1f, -0.2f}, {0.2f, -0.022f, 0.2f}};
  add_fixed(level, "table", {0.16, 0.008, 0.13}, {0.0, -0.060, 0.0}, 0.0, stone);
  add_hand(level, organ_path().front());
  add_view(level, {0.20, 0.11, -0.22}, {0.0, 0.03, -0.03}, "sky.exr", {0.4, 0.8, -0.3});
  return level;
}

Level hand_crowd() {
  Level level;
  level.name = "hand_crowd";
  level.about = "A soft hand among soft bodies: a cube and a ring on a tray, two balls in cups.";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  add_slab(level, "tray", {0.17, 0.006, 0.12}, {0.0, -0.006, 0.0}, stone);
  add_slab(level, "rim_back", {0.182, 0.014, 0.006}, {0.0, 0.002, -0.126}, stone);
  const auto add_cup = [&](const char* name, dvec3 at) {
    LevelNode& node = add_shape(level, name, torus(0.018, 0.007), around({0.032, 0.014, 0.032}), 0.004, stone);
    node.local.translation = vec3(at);
    node.rigid_body = RigidBody{};
    node.rigid_body->fixed = true;
  };
  // Static friction equals dynamic friction: slip begins without a jump of the force.
  const auto add = [&](const char* name, const Solid& solid, dvec3 half, dvec3 at, vec3 color) {
    LevelNode& node = add_soft(level, name, solid, around(half + dvec3(0.012)), 0.006, 0.016, 2.5e4,
                               add_material(level, name, color, 0.4f));
    node.local.translation = vec3(at);
    node.soft_body->density = 500.0;
    node.soft_body->rayleigh = {2.0, 0.02};
    node.soft_body->friction_static = node.soft_body->friction_sliding = 0.5;
  };
  add("cube", rounded_box(dvec3(0.024), 0.008), dvec3(0.024), {0.050, 0.0243, 0.0}, kTeal);
  add("ring", torus(0.026, 0.013), {0.040, 0.014, 0.040}, {0.050, 0.0133, -0.066}, kGold);
  add_cup("cup", {-0.085, 0.002, -0.010});
  add("ball", ball(0.026), dvec3(0.026), {-0.085, 0.0300, -0.010}, kCoral);
  add_cup("little_cup", {-0.025, 0.002, -0.010});
  add("little_ball", ball(0.022), dvec3(0.022), {-0.025, 0.0250, -0.010}, {0.50f, 0.13f, 0.11f});
  add_hand(level, crowd_path().front());
  level.nodes.back().soft_body->friction_static = level.nodes.back().soft_body->friction_sliding = 0.5;
  add_view(level, {0.06, 0.15, -0.32}, {-0.01, 0.02, 0.0}, "sky.exr", {0.3, 0.8, -0.4});
  return level;
}

Level hand_squeeze() {
  Level level;
  level.name = "hand_squeeze";
  level.about = "A soft hand is pushed between two walls until its fingers touch one another.";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  add_fixed(level, "table", {0.16, 0.006, 0.15}, {0.0, -0.041, -0.01}, 0.0, stone);
  add_fixed(level, "wall_left", {0.006, 0.045, 0.060}, {-0.054, 0.010, -0.070}, -17.5, stone);
  add_fixed(level, "wall_right", {0.006, 0.045, 0.060}, {0.054, 0.010, -0.070}, 17.5, stone);
  add_hand(level, squeeze_path().front());
  add_view(level, {0.05, 0.20, -0.27}, {0.0, 0.0, -0.06}, "sky.exr", {0.3, 0.8, -0.4});
  return level;
}

Status write_tool_levels(const std::filesystem::path& folder) {
  if (Status s = write_level(hand(), organ_path(), "presses, strokes and rolls on the organ, then leaves it", folder);
      !s)
    return s;
  if (Status s =
          write_level(hand_crowd(), crowd_path(), "presses on a cube and a ring, then on two balls in cups", folder);
      !s)
    return s;
  return write_level(hand_squeeze(), squeeze_path(), "pushes the fingers between two walls and draws them back",
                     folder);
}

}  // namespace pliant::generate
