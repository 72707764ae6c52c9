#include "content/generate/palpation_level.h"

#include "content/generate/stage.h"
#include "content/generate/tool_stage.h"

namespace pliant::generate {
namespace {

constexpr dvec3 kPadHalf{0.042, 0.0125, 0.034};           // [m] of the pad
constexpr double kPalpationTip = 0.005;                   // [m] radius
constexpr double kPadOver = 0.012, kPadPressed = 0.0035;  // [m] of the finger's lowest point above and in the pad
constexpr double kPadColumns[] = {-0.024, -0.012, 0.0, 0.012, 0.024}, kPadRows[] = {-0.018, -0.006, 0.006, 0.018};

// Presses place by place, to and fro.
std::vector<Waypoint> palpation_path() {
  std::vector<Waypoint> out{{0.0, {kPadColumns[0], kPadOver + kPalpationTip, kPadRows[0]}, dvec3(0)}};
  double time = 0.0;
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i < 5; ++i) {
      const double x = kPadColumns[row % 2 == 0 ? i : 4 - i], z = kPadRows[row];
      for (const auto& [seconds, height] :
           {std::pair{0.25, 0.004}, {0.35, -kPadPressed}, {0.15, -kPadPressed}, {0.3, 0.004}})
        out.push_back({time += seconds, {x, height + kPalpationTip, z}, dvec3(0)});
    }
  out.push_back({time + 0.8, out.front().position, dvec3(0)});
  return out;
}

}  // namespace

Level palpation() {
  Level level;
  level.name = "palpation";
  level.about = "A finger presses place by place on a soft pad, and feels the lump inside that cannot be seen.";
  LevelNode& pad = add_soft(level, "pad", rounded_box(kPadHalf, 0.005), around(kPadHalf + 0.007), 0.003, 0.007, 8e3,
                            add_tissue(level, "skin", 0.03f));
  place(pad, {0.0, {0, -kPadHalf.y, 0}, dvec3(0)});
  pad.soft_body->poisson = 0.45;
  pad.soft_body->contact = SoftContact::kSplit;
  pad.soft_body->friction_static = pad.soft_body->friction_sliding = 0.2;
  pad.soft_body->pinned = {{-0.1f, -0.1f, -0.1f}, {0.1f, static_cast<float>(-kPadHalf.y + 0.002), 0.1f}};
  TissuePart lump;
  lump.name = "lump";
  lump.young = 1.6e5;
  pad.soft_body->materials = {lump};
  pad.soft_body->carries = Carries::kInside;
  LevelNode& inside = add_shape(level, "lump", ball(kLumpRadius), around(dvec3(kLumpRadius + 0.002)), 0.002,
                                add_material(level, "lump", kCoral, 0.6f));
  place(inside, {0.0, kLump, dvec3(0)});
  LevelNode& finger = add_node(level, "finger");
  finger.probe = Probe{};
  finger.probe->radius = kPalpationTip;
  finger.probe->color = kTeal;
  finger.probe_device = "finger";
  finger.device = script_device("palpation.csv", 10.0);
  place(finger, palpation_path().front());
  add_view(level, {0.05, 0.075, 0.12}, {0.0, -0.006, 0.0}, "sky.exr", {0.3, 0.5, -0.4});
  return level;
}

Status write_palpation_level(const std::filesystem::path& folder) {
  if (Status s = write_scene(palpation(), folder); !s) return s;
  return write_path(palpation_path(), "presses on twenty places of the pad", "palpation.csv", folder);
}

}  // namespace pliant::generate
