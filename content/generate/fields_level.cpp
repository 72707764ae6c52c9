#include "content/generate/fields_level.h"

#include <cmath>
#include <numbers>

#include "content/author/save_script.h"
#include "content/generate/instrument.h"
#include "content/generate/stage.h"
#include "content/generate/tool_stage.h"

namespace pliant::generate {
namespace {

constexpr double kHeight = 0.03;  // [m] of the row
constexpr double kDrag = -0.16, kMagnet = -0.10, kWeight = -0.04, kBall = 0.03, kComb = 0.09, kRail = 0.155;  // [m] x

Effect effect_of(EffectKind kind) {
  Effect effect;
  effect.kind = kind;
  return effect;
}

DBox box_of(dvec3 half) {
  return {-half, half};
}

LevelNode& add_effect(Level& level, const std::string& name, dvec3 at, const Effect& effect, dvec3 turn = dvec3(0)) {
  LevelNode& node = add_node(level, name);
  node.effect = effect;
  place(node, {0.0, at, turn});
  return node;
}

// Through the drag, past the magnet, up and down in the weight, onto the ball, through the detents, across the rail's
// bends, onto the board, and back beside all of them.
std::vector<Waypoint> effects_row_path() {
  const auto at = [](double time, double x, double y, double z = 0.0) { return Waypoint{time, {x, y, z}, dvec3(0)}; };
  return {at(0.0, -0.20, kHeight),         at(0.7, -0.20, kHeight),      at(2.2, -0.13, kHeight),
          at(3.2, -0.07, kHeight + 0.008), at(3.8, kWeight, kHeight),    at(4.6, kWeight, kHeight + 0.012),
          at(5.4, kWeight, kHeight),       at(6.2, 0.0, 0.055),          at(6.7, kBall, 0.055),
          at(7.4, kBall, 0.033),           at(8.1, kBall, 0.055),        at(8.6, 0.06, kHeight),
          at(10.2, 0.118, kHeight),        at(12.4, 0.19, kHeight),      at(12.9, 0.19, kHeight, 0.04),
          at(13.6, 0.16, -0.011, 0.04),    at(13.9, 0.16, -0.011, 0.04), at(14.5, 0.16, kHeight, 0.05),
          at(16.0, -0.20, kHeight, 0.05),  at(16.5, -0.20, kHeight)};
}

// Two waves of 6 mm, in the frame of its node.
Path fields_rail() {
  Path path;
  for (int i = 0; i <= 120; ++i) {
    const double x = 0.0005 * (i - 60);
    path.rows.push_back({0.01 * i, {x, 0, 0.006 * std::sin(2 * std::numbers::pi * x / 0.03)}, {1, 0, 0, 0}});
  }
  return path;
}

}  // namespace

Level fields_level() {
  Level level;
  level.name = "fields";
  level.about = "Felt in the air: drag, a magnet, weight, a forbidden ball, detents, a rail; a soft board below.";
  LevelNode& board = add_shape(level, "board", rounded_box({0.21, 0.01, 0.065}, 0.006), around({0.22, 0.02, 0.075}),
                               0.0045, add_material(level, "wood", {0.50f, 0.30f, 0.14f}, 0.5f));
  board.deformable = Deformable{};
  board.deformable->reach = 0.03;
  place(board, {0.0, {0, -0.02, 0}, dvec3(0)});

  Effect drag = effect_of(EffectKind::kViscosity);
  drag.region = EffectRegion::kBox;
  drag.box = box_of({0.02, 0.02, 0.02});
  drag.damping = 6.0;
  add_effect(level, "drag", {kDrag, kHeight, 0}, drag);

  LevelNode& magnet =
      add_shape(level, "magnet", ball(0.005), around(dvec3(0.008)), 0.0012, add_material(level, "steel", kSteel, 0.3f));
  place(magnet, {0.0, {kMagnet, kHeight, 0}, dvec3(0)});
  magnet.effect = effect_of(EffectKind::kAttraction);
  magnet.effect->stiffness = 150.0;

  Effect weight = effect_of(EffectKind::kGravity);
  weight.region = EffectRegion::kBox;
  weight.box = box_of({0.022, 0.028, 0.022});
  weight.force = {0, -0.4, 0};
  add_effect(level, "weight", {kWeight, kHeight, 0}, weight);

  LevelNode& forbidden =
      add_shape(level, "ball", ball(0.015), around(dvec3(0.02)), 0.003, add_material(level, "red", kCoral, 0.4f));
  place(forbidden, {0.0, {kBall, 0.02, 0}, dvec3(0)});
  forbidden.effect = effect_of(EffectKind::kForbidden);
  forbidden.effect->radius = 0.015;
  forbidden.effect->stiffness = 400.0;

  Effect comb = effect_of(EffectKind::kDetents);
  comb.region = EffectRegion::kBox;
  comb.box = box_of({0.015, 0.02, 0.015});
  comb.edge = 0.005;
  comb.spacing = 0.005;
  comb.peak = 0.4;
  add_effect(level, "comb", {kComb, kHeight, 0}, comb, {0, 0, -90});  // along x

  Effect guided = effect_of(EffectKind::kGuidance);
  guided.path = "fields_rail.csv";
  guided.stiffness = 300.0;
  guided.range = 0.015;
  add_effect(level, "rail", {kRail, kHeight, 0}, guided);

  LevelNode& finger = add_node(level, "finger");
  finger.probe = Probe{};
  finger.probe->radius = 0.003;
  finger.probe->color = kTeal;
  finger.probe_device = "finger";
  finger.device = script_device("fields_finger.csv", 3.3);
  place(finger, effects_row_path().front());
  add_view(level, {0.05, 0.22, 0.42}, {0.0, 0.01, 0.0});
  return level;
}

Status write_fields_level(const std::filesystem::path& folder) {
  if (Status s = write_scene(fields_level(), folder); !s) return s;
  if (Status s = save_script(fields_rail(), "two waves, in the frame of the node `rail`", folder / "fields_rail.csv");
      !s)
    return s;
  return write_path(effects_row_path(), "goes along the effects, presses the board 4 mm deep and returns",
                    "fields_finger.csv", folder);
}

}  // namespace pliant::generate
