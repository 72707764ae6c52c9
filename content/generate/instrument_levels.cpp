#include "content/generate/instrument_levels.h"

#include "content/generate/instrument.h"
#include "content/generate/stage.h"
#include "content/generate/tool_stage.h"

namespace pliant::generate {
namespace {

constexpr vec3 kWood{0.50f, 0.30f, 0.14f};  // linear RGB

// The pose of the stylus's device for which the tip is at `tip`.
Waypoint tip_at(double time, dvec3 tip, dvec3 turn) {
  return {time, tip - glm::normalize(dquat(glm::radians(turn))) * stylus_tip(), turn};
}

// Titanium, 25 g, held like a pen.
void add_stylus(Level& level, const Waypoint& start) {
  LevelNode& node = add_mesh(level, "stylus", stylus(), add_material(level, "steel", kSteel, 0.3f));
  place(node, start);
  node.rigid_body = RigidBody{};
  node.rigid_body->density = 4500.0;
  node.rigid_body->friction_static = node.rigid_body->friction_sliding = 0.4;
  node.handle = Handle6{};
  node.handle->translation = {1000.0, 8.0};
  node.handle->rotation = {2.0, 0.02};
  node.handle->max_force = 8.0;
  node.handle->max_torque = 0.6;
  node.handle->device = "stylus";
  node.device = script_device(level.name + "_stylus.csv", 8.0);
}

LevelNode& add_box(Level& level, const std::string& name, dvec3 half, dvec3 at, double yaw, std::int32_t material) {
  LevelNode& node = add_mesh(level, name, box_mesh(half), material);
  place(node, {0.0, at, {0, yaw, 0}});
  node.rigid_body = RigidBody{};
  return node;
}

constexpr double kTowerX = -0.04, kTowerTop = 0.130, kTopHalf = 0.027;  // [m]
constexpr dvec3 kUpright{-20, 0, 0};  // [degree] the stylus's ball straight below its bend

// Touches the tower's top, goes up and around to its left, and pushes the topmost box to the right until it falls.
std::vector<Waypoint> stack_path() {
  const double side = kTowerX - kTopHalf - kStylusTip;
  return {tip_at(0.0, {kTowerX, kTowerTop + 0.035, 0.0}, kUpright),
          tip_at(1.0, {kTowerX, kTowerTop + 0.006, 0.0}, kUpright),
          tip_at(2.2, {kTowerX, kTowerTop + 0.001, 0.0}, kUpright),
          tip_at(2.7, {kTowerX, kTowerTop + 0.001, 0.0}, kUpright),
          tip_at(3.7, {kTowerX, kTowerTop + 0.020, 0.0}, kUpright),
          tip_at(4.5, {side - 0.012, kTowerTop + 0.020, 0.0}, kUpright),
          tip_at(5.2, {side - 0.012, kTowerTop - 0.013, 0.0}, kUpright),
          tip_at(7.7, {side + 0.045, kTowerTop - 0.013, 0.0}, kUpright),
          tip_at(8.6, {side - 0.012, kTowerTop + 0.010, 0.0}, kUpright),
          tip_at(9.0, {side - 0.012, kTowerTop + 0.010, 0.0}, kUpright)};
}

// The organ of `three_probes` lying on its back: its groove points up.
double lying_organ(dvec3 p) {
  static const Solid upright = organ();
  return upright({p.x, -p.z, p.y});
}

// The organ's highest point at x, z, by bisection. [m]
dvec3 on_organ(double x, double z) {
  double inside = 0.0, outside = 0.1;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (inside + outside);
    (lying_organ({x, middle, z}) < 0.0 ? inside : outside) = middle;
  }
  return {x, inside, z};
}

// Presses on the large lobe, strokes over it towards the groove, and retracts.
std::vector<Waypoint> stylus_path() {
  const dvec3 from = on_organ(-0.070, -0.020), to = on_organ(-0.026, -0.026), up(0, 1, 0), lean(-5, 0, 25);
  const double clear = kStylusTip + 0.020, deep = kStylusTip - 0.009;
  return {tip_at(0.0, from + clear * up, lean), tip_at(2.0, from + deep * up, lean),
          tip_at(2.4, from + deep * up, lean),  tip_at(5.4, to + deep * up, lean),
          tip_at(7.4, to + clear * up, lean),   tip_at(8.0, to + clear * up, lean)};
}

constexpr double kFinger = 0.007;  // [m] radius of the probe

// Presses twice on the far lobe.
std::vector<Waypoint> finger_path() {
  const dvec3 first = on_organ(0.075, -0.012), second = on_organ(0.060, 0.004), up(0, 1, 0), none(0);
  const double clear = kFinger + 0.015, deep = kFinger - 0.007;
  return {{0.0, first + clear * up, none},  {0.8, first + clear * up, none},  {2.4, first + deep * up, none},
          {4.0, first + clear * up, none},  {4.6, second + clear * up, none}, {6.2, second + deep * up, none},
          {7.8, second + clear * up, none}, {8.0, second + clear * up, none}};
}

}  // namespace

Level stack() {
  Level level;
  level.name = "stack";
  level.about = "A stylus presses on a tower of wooden boxes, then pushes the topmost one off.";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f),
                     wood = add_material(level, "wood", kWood, 0.6f);
  add_box(level, "table", {0.16, 0.006, 0.11}, {0.01, -0.006, 0.0}, 0.0, stone).rigid_body->fixed = true;
  const struct {
    const char* name;
    dvec3 half;
    double yaw;
  } boxes[] = {{"box_1", {0.036, 0.018, 0.036}, 0.0},
               {"box_2", {0.033, 0.016, 0.033}, 8.0},
               {"box_3", {0.030, 0.016, 0.030}, -6.0},
               {"box_4", {kTopHalf, 0.015, 0.027}, 0.0}};
  double top = 0.0;
  for (const auto& box : boxes) {
    LevelNode& node = add_box(level, box.name, box.half, {kTowerX, top + box.half.y, 0.0}, box.yaw, wood);
    node.rigid_body->density = 600.0;
    node.rigid_body->friction_static = node.rigid_body->friction_sliding = 0.4;
    top += 2.0 * box.half.y;
  }
  const auto add_cube = [&](const char* name, double x, vec3 color) {
    LevelNode& node = add_soft(level, name, rounded_box(dvec3(0.020), 0.006), around(dvec3(0.032)), 0.006, 0.013, 1.5e4,
                               add_material(level, name, color, 0.4f));
    node.local.translation = vec3(dvec3(x, 0.0205, 0.0));
  };
  add_cube("cube_1", 0.040, kTeal);
  add_cube("cube_2", 0.092, kCoral);
  add_stylus(level, stack_path().front());
  add_view(level, {0.10, 0.20, 0.40}, {0.005, 0.065, 0.0}, "sky.exr", {0.3, 0.8, 0.5});
  return level;
}

Level instrument() {
  Level level;
  level.name = "instrument";
  level.about = "A rigid stylus and a probe press and stroke one soft organ.";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  LevelNode& body = add_soft(level, "organ", lying_organ, {{-0.13f, -0.07f, -0.10f}, {0.14f, 0.07f, 0.11f}}, 0.006,
                             0.021, 8e3, add_tissue(level, "liver", 0.08f));
  body.soft_body->pinned = {{-0.2f, -0.1f, -0.2f}, {0.2f, -0.022f, 0.2f}};
  add_fixed(level, "table", {0.16, 0.008, 0.13}, {0.0, -0.060, 0.0}, 0.0, stone);
  add_stylus(level, stylus_path().front());
  LevelNode& finger = add_node(level, "finger");
  finger.probe = Probe{};
  finger.probe->radius = kFinger;
  finger.probe->color = kGold;
  finger.probe_device = "finger";
  finger.device = script_device("instrument_finger.csv", 8.0);
  add_view(level, {0.06, 0.15, 0.26}, {-0.005, 0.045, -0.01}, "sky.exr", {0.4, 0.8, 0.3});
  return level;
}

Status write_instrument_levels(const std::filesystem::path& folder) {
  if (Status s = write_scene(stack(), folder); !s) return s;
  if (Status s =
          write_path(stack_path(), "presses on the tower, then pushes its topmost box off", "stack_stylus.csv", folder);
      !s)
    return s;
  if (Status s = write_scene(instrument(), folder); !s) return s;
  if (Status s = write_path(stylus_path(), "presses on the large lobe and strokes it", "instrument_stylus.csv", folder);
      !s)
    return s;
  return write_path(finger_path(), "presses twice on the far lobe", "instrument_finger.csv", folder);
}

}  // namespace pliant::generate
