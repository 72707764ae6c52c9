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

// The palm comes down on a ball and rolls it forward. Then, on its edge, the hand sweeps what stands on the tray aside.
std::vector<Waypoint> crowd_path() {
  const dvec3 flat(0, 0, 0), edge(0, 0, -90);
  return {{0.0, {-0.105, 0.080, 0.010}, flat}, {1.2, {-0.105, 0.054, 0.010}, flat}, {2.8, {-0.105, 0.055, 0.060}, flat},
          {3.4, {-0.105, 0.110, 0.060}, flat}, {4.4, {0.110, 0.110, 0.020}, edge},  {4.8, {0.110, 0.068, 0.020}, edge},
          {7.0, {0.020, 0.068, 0.020}, edge},  {7.6, {0.060, 0.090, 0.030}, edge},  {8.0, {0.060, 0.090, 0.030}, edge}};
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
  level.about = "A soft hand rolls a ball and sweeps soft and rigid bodies across a tray.";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  add_slab(level, "tray", {0.17, 0.006, 0.12}, {0.0, -0.006, 0.0}, stone);
  add_slab(level, "rim_back", {0.182, 0.014, 0.006}, {0.0, 0.002, -0.126}, stone);
  add_slab(level, "rim_front", {0.182, 0.014, 0.006}, {0.0, 0.002, 0.126}, stone);
  add_slab(level, "rim_left", {0.006, 0.014, 0.120}, {-0.176, 0.002, 0.0}, stone);
  // Static friction equals dynamic friction: slip begins without a jump of the force.
  const auto add_yielding = [&](const char* name, const Solid& solid, dvec3 half, dvec3 at, vec3 color) {
    LevelNode& node = add_soft(level, name, solid, around(half + dvec3(0.012)), 0.008, 0.016, 2.5e4,
                               add_material(level, name, color, 0.4f));
    node.local.translation = vec3(at);
    node.soft_body->density = 1000.0;
    node.soft_body->rayleigh = {2.0, 0.02};
    node.soft_body->friction_static = node.soft_body->friction_sliding = 0.5;
  };
  const auto set_free = [](LevelNode& node, dvec3 at) {
    node.local.translation = vec3(at);
    node.rigid_body = RigidBody{};
    node.rigid_body->density = 800.0;
    node.rigid_body->friction_static = node.rigid_body->friction_sliding = 0.4;
  };
  add_yielding("ball", ball(0.024), dvec3(0.024), {-0.105, 0.0238, 0.010}, kCoral);
  add_yielding("cube", rounded_box(dvec3(0.022), 0.008), dvec3(0.022), {0.050, 0.0218, 0.010}, kTeal);
  add_yielding("ring", torus(0.022, 0.011), {0.034, 0.012, 0.034}, {0.050, 0.0108, -0.060}, kGold);
  const std::int32_t steel = add_material(level, "steel", kSteel, 0.3f);
  set_free(add_mesh(level, "die", box_mesh(dvec3(0.015)), steel), {-0.005, 0.015, 0.020});
  set_free(add_shape(level, "marble", ball(0.013), around(dvec3(0.019)), 0.005, steel), {0.000, 0.013, -0.025});
  const Solid drum = [](dvec3 p) { return tapered(p, {0, 0, -0.018}, {0, 0, 0.018}, 0.013, 0.013); };
  set_free(add_shape(level, "drum", drum, around({0.019, 0.019, 0.037}), 0.005, steel), {-0.010, 0.0134, -0.070});
  add_hand(level, crowd_path().front());
  level.nodes.back().soft_body->friction_static = level.nodes.back().soft_body->friction_sliding = 0.5;
  add_view(level, {-0.22, 0.20, -0.30}, {-0.01, 0.02, 0.0}, "sky.exr", {-0.5, 0.8, -0.4});
  return level;
}

Level hand_squeeze() {
  Level level;
  level.name = "hand_squeeze";
  level.about = "A soft hand is pushed between two walls until its fingers touch one another.";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  add_fixed(level, "table", {0.16, 0.006, 0.15}, {0.0, -0.041, -0.01}, 0.0, stone);
  add_fixed(level, "wall_left", {0.006, 0.045, 0.060}, {-0.039, 0.010, -0.070}, -17.5, stone);
  add_fixed(level, "wall_right", {0.006, 0.045, 0.060}, {0.039, 0.010, -0.070}, 17.5, stone);
  add_hand(level, squeeze_path().front());
  add_view(level, {0.02, 0.31, -0.20}, {0.0, 0.0, -0.055}, "sky.exr", {0.3, 0.8, -0.4});
  return level;
}

Status write_tool_levels(const std::filesystem::path& folder) {
  if (Status s = write_level(hand(), organ_path(), "presses, strokes and rolls on the organ, then leaves it", folder);
      !s)
    return s;
  if (Status s = write_level(hand_crowd(), crowd_path(), "rolls a ball, then sweeps the tray with its edge", folder);
      !s)
    return s;
  return write_level(hand_squeeze(), squeeze_path(), "pushes the fingers between two walls and draws them back",
                     folder);
}

}  // namespace pliant::generate
