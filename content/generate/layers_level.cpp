#include "content/generate/layers_level.h"

#include "content/generate/stage.h"
#include "content/generate/tool_stage.h"

namespace pliant::generate {
namespace {

constexpr double kBack = -0.045, kClay = 0.045;  // [m] x of the two pads
constexpr double kLifted = 0.02;                 // [m] over them

Layer layer_of(const char* name, double thickness, double stiffness, double force, double remains, double grip) {
  Layer layer;
  layer.name = name;
  layer.thickness = thickness;
  layer.stiffness = stiffness;
  layer.force = force;
  layer.remains = remains;
  layer.grip = grip;
  return layer;
}

// Through both layers, out, into the same hole, out, and through the skin beside it.
std::vector<Waypoint> needle_path() {
  const auto at = [](double time, double x, double y) { return Waypoint{time, {kBack + x, y, 0.0}, dvec3(0)}; };
  return {at(0.0, -0.008, kLifted), at(0.4, -0.008, kLifted), at(3.0, -0.008, -0.016),  at(3.4, -0.008, -0.016),
          at(4.8, -0.008, kLifted), at(6.6, -0.008, -0.016),  at(7.8, -0.008, kLifted), at(8.3, 0.012, kLifted),
          at(9.6, 0.012, -0.006),   at(10.4, 0.012, kLifted), at(11.0, -0.008, kLifted)};
}

// Two presses in one place, the second one deeper, and a groove.
std::vector<Waypoint> clay_path() {
  const auto at = [](double time, double z, double y) { return Waypoint{time, {kClay, y, z}, dvec3(0)}; };
  return {at(0.0, -0.014, kLifted), at(0.6, -0.014, kLifted), at(2.0, -0.014, -0.001),  at(3.2, -0.014, kLifted),
          at(4.8, -0.014, -0.003),  at(6.0, -0.014, kLifted), at(6.6, -0.002, kLifted), at(7.6, 0.000, -0.001),
          at(9.4, 0.022, -0.001),   at(10.4, 0.022, kLifted), at(11.0, -0.014, kLifted)};
}

}  // namespace

Level layers_level() {
  Level level;
  level.name = "layers";
  level.about = "A needle pops through skin and ligament and finds its hole again; a finger leaves dents in clay.";
  const dvec3 half{0.035, 0.02, 0.035};
  const auto pad = [&](const char* name, double x, vec3 color, float roughness) -> LevelNode& {
    LevelNode& node = add_shape(level, name, rounded_box(half, 0.006), around(half + 0.006), 0.0028,
                                add_material(level, name, color, roughness));
    place(node, {0.0, {x, -half.y, 0}, dvec3(0)});
    node.deformable = Deformable{};
    node.deformable->reach = 0.014;
    return node;
  };
  Deformable& back = *pad("back", kBack, kSkin, 0.5f).deformable;
  back.stiffness = 150.0;
  back.friction_static = back.friction_sliding = 0.1;
  back.layers = {layer_of("skin", 0.009, 600.0, 1.2, 0.08, 15.0), layer_of("ligament", 0.005, 500.0, 1.6, 0.05, 25.0)};
  Deformable& clay = *pad("clay", kClay, {0.45f, 0.40f, 0.36f}, 0.8f).deformable;
  clay.stiffness = 400.0;
  clay.yield_force = 0.9;
  clay.yield_hardening = 120.0;

  LevelNode& needle = add_node(level, "needle");
  needle.probe = Probe{};
  needle.probe->radius = 0.0007;
  needle.probe->length = 0.06;
  needle.probe->color = kSteel;
  needle.probe_device = "needle";
  needle.device = script_device("layers_needle.csv", 3.3);
  needle.device->max_slew = 2000.0;  // [N/s] of a break
  place(needle, needle_path().front());
  LevelNode& finger = add_node(level, "finger");
  finger.probe = Probe{};
  finger.probe->radius = 0.004;
  finger.probe->color = kTeal;
  finger.probe_device = "finger";
  finger.device = script_device("layers_finger.csv", 3.3);
  place(finger, clay_path().front());
  add_view(level, {0.03, 0.13, 0.19}, {0.0, -0.004, 0.0});
  return level;
}

Status write_layers_level(const std::filesystem::path& folder) {
  if (Status s = write_scene(layers_level(), folder); !s) return s;
  if (Status s = write_path(needle_path(), "goes through both layers, into the same hole, and beside it",
                            "layers_needle.csv", folder);
      !s)
    return s;
  return write_path(clay_path(), "presses twice in one place, and a groove", "layers_finger.csv", folder);
}

}  // namespace pliant::generate
