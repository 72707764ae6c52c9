#include "content/generate/levels.h"

#include <cmath>

#include "content/author/presets.h"
#include "content/generate/effects_level.h"
#include "content/generate/fields_level.h"
#include "content/generate/forceps_level.h"
#include "content/generate/grasp_level.h"
#include "content/generate/hand_grip_level.h"
#include "content/generate/instrument_levels.h"
#include "content/generate/lattice_sphere.h"
#include "content/generate/layers_level.h"
#include "content/generate/minimal.h"
#include "content/generate/palpation_level.h"
#include "content/generate/sky.h"
#include "content/generate/stage.h"
#include "content/generate/strokes.h"
#include "content/generate/textures.h"
#include "content/generate/tool_levels.h"
#include "content/level_file.h"

namespace pliant::generate {
namespace {

void add_probe(Level& level, const std::string& name, double radius, vec3 color) {
  LevelNode& node = add_node(level, name);
  node.probe = Probe{};
  node.probe->radius = radius;
  node.probe->color = color;
  node.probe_device = name;
  node.device = HapticDevice{};
  node.device->driver = DriverKind::kScript;
  node.device->file = level.name + name.substr(name.rfind('_')) + ".csv";
}

struct NamedStroke {
  const char* letter;
  const char* comment;
  Stroke stroke;
};

// The right lobe from the left, the lobe below it, and the far lobe across the groove's side. From 3.8 s to 5 s all
// three probes are in contact. Then a and b slide side by side, close enough to interact.
std::vector<NamedStroke> organ_strokes() {
  //             radius clearance depth  press     lift
  const Stroke a{8.0,       0.004, 0.030, 0.008, 0.4, 2.0, 5.2, 6.8, {{-0.075, 0.020, 0.04}, {-0.026, 0.026, 0.06}},
                 {2.0, 5.2}};
  const Stroke b{8.0,       0.003, 0.030, 0.007, 1.2, 2.8, 5.4, 7.0, {{-0.066, -0.030, 0.05}, {-0.022, 0.006, 0.06}},
                 {2.8, 5.2}};
  const Stroke c{8.0,       0.000, 0.030, 0.006, 2.2, 3.6, 6.2, 7.6, {{0.088, 0.016, 0.02}, {0.050, 0.008, 0.05}},
                 {3.6, 6.2}};
  return {{"a", "presses 8 mm deep on the large lobe and slides towards the groove", a},
          {"b", "presses 7 mm deep on the lower lobe and slides up beside the first", b},
          {"c", "presses 6 mm deep on the far lobe and slides inward", c}};
}

// Two fingers: one strokes three lines over the half with the hard spot, one a line over the other half.
std::vector<NamedStroke> pad_strokes() {
  Stroke a{10.0, 0.005, 0.025, 0.004, 0.3, 1.3, 8.3, 9.3, {}, {}};
  a.through = {{0.005, 0.02, -0.016}, {0.065, 0.02, -0.016}, {0.065, 0.02, 0.002},
               {0.005, 0.02, 0.002},  {0.005, 0.02, 0.020},  {0.065, 0.02, 0.020}};
  a.at = {1.3, 3.3, 3.8, 5.8, 6.3, 8.3};
  const Stroke b{10.0,      0.005, 0.025, 0.004, 1.0, 2.0, 6.0, 7.0, {{-0.060, 0.02, 0.012}, {-0.015, 0.02, 0.012}},
                 {2.0, 6.0}};
  return {{"a", "sweeps three lines 4 mm deep over the half that hides the hard spot", a},
          {"b", "sweeps one line 4 mm deep over the soft half", b}};
}

// Both lobes from the front, and the flank below them.
std::vector<NamedStroke> heart_strokes() {
  const Stroke a{8.0,       0.005, 0.030, 0.010, 0.4, 2.0, 5.4, 7.0, {{-0.046, 0.034, 0.04}, {-0.022, 0.012, 0.05}},
                 {2.0, 5.2}};
  const Stroke b{8.0,       0.005, 0.030, 0.010, 1.0, 2.6, 5.8, 7.4, {{0.048, 0.012, 0.04}, {0.030, 0.036, 0.05}},
                 {2.6, 5.6}};
  const Stroke c{8.0,       0.004, 0.030, 0.008, 1.8, 3.4, 6.2, 7.6, {{0.008, -0.040, 0.04}, {-0.006, -0.014, 0.05}},
                 {3.4, 6.0}};
  return {{"a", "presses 10 mm deep on the left lobe and slides down", a},
          {"b", "presses 10 mm deep on the right lobe and slides up", b},
          {"c", "presses 8 mm deep above the point and slides up between them", c}};
}

// Two balls that meet in the middle and separate again.
std::vector<NamedStroke> cushion_strokes() {
  const Stroke a{8.0,
                 0.008,
                 0.030,
                 0.011,
                 0.4,
                 2.0,
                 5.6,
                 7.2,
                 {{-0.060, 0.03, 0.030}, {-0.018, 0.03, 0.010}, {-0.050, 0.03, -0.030}},
                 {2.0, 3.8, 5.6}};
  const Stroke b{8.0,
                 0.006,
                 0.030,
                 0.010,
                 0.9,
                 2.5,
                 5.8,
                 7.4,
                 {{0.062, 0.03, -0.020}, {0.020, 0.03, 0.014}, {0.045, 0.03, 0.045}},
                 {2.5, 4.1, 5.8}};
  return {{"a", "presses 11 mm deep on the left, slides to the middle and back", a},
          {"b", "presses 10 mm deep on the right, slides to the middle and forward", b}};
}

// A finger that keeps its position while the ball turns under it.
std::vector<NamedStroke> ball_strokes() {
  const Stroke a{8.0, 0.005, 0.030, 0.005, 0.4, 1.6, 6.4, 7.6, {{0, 0.004, 0.05}, {0, 0.006, 0.05}}, {1.6, 6.4}};
  return {{"a", "presses 5 mm deep at the front of the turning ball and stays there", a}};
}

// One turn about +Y, one key per quarter turn.
LevelAnimation turn_of(std::int32_t node, double seconds) {
  LevelChannel channel{node, NodeProperty::kRotation, {}};
  for (int quarter = 0; quarter <= 4; ++quarter) {
    const double half = 0.25 * 3.14159265358979323846 * quarter;
    channel.track.times.push_back(0.25 * seconds * quarter);
    channel.track.values.emplace_back(0.0, std::sin(half), 0.0, std::cos(half));
  }
  channel.track.length = seconds;
  return {"turn", seconds, {channel}};
}

Status save_strokes(const Level& level, const Solid& solid, const std::vector<NamedStroke>& strokes,
                    const std::filesystem::path& folder) {
  for (const NamedStroke& s : strokes) {
    Status saved = save_script(trace(solid, s.stroke), s.comment, folder / (level.name + "_" + s.letter + ".csv"));
    if (!saved) return saved;
  }
  return Done{};
}

// A body with one material, without texture coordinates where it has no painting.
using Painting = Image (*)(const LatticeSphere& sphere, std::uint32_t size);
LevelNode& add_body(Level& level, const Solid& solid, const Material& material, const Detail& detail,
                    Painting painting = nullptr) {
  level.materials.push_back(material);
  const LatticeSphere surface = cover(solid, detail.smooth_coarse, detail.smooth_doublings);
  Primitive primitive = to_primitive(surface, solid);
  primitive.material = 0;
  if (painting) {
    level.images = {painting(surface, detail.color_size)};
    level.materials[0].base_color_texture = 0;
  } else {
    primitive.uv.clear();
  }
  level.meshes.push_back({level.name, {std::move(primitive)}});
  LevelNode& node = add_node(level, "body");
  node.mesh = 0;
  node.deformable = Deformable{};
  return node;
}

// A picture of the pad's inside, on a board behind it.
void add_section(Level& level, const Detail& detail) {
  constexpr float kHalf = 0.080f, kTall = 0.040f, kFloor = -0.002f, kBehind = -0.058f;  // [m]
  level.images.push_back(pad_section({kHalf, 0.5 * kTall}, detail.color_size));
  Material board;
  board.name = "section";
  board.base_color = vec4(1);
  board.roughness = 0.6f;
  board.base_color_texture = static_cast<std::int32_t>(level.images.size()) - 1;
  board.double_sided = true;
  Primitive sheet;
  sheet.position = {{-kHalf, kFloor, kBehind},
                    {kHalf, kFloor, kBehind},
                    {kHalf, kFloor + kTall, kBehind - 0.4f * kTall},
                    {-kHalf, kFloor + kTall, kBehind - 0.4f * kTall}};
  sheet.normal.assign(4, normalize(vec3(0, 0.4f, 1)));
  sheet.uv = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  sheet.index = {0, 1, 2, 0, 2, 3};
  sheet.material = static_cast<std::int32_t>(level.materials.size());
  level.materials.push_back(board);
  level.meshes.push_back({"section", {std::move(sheet)}});
  add_node(level, "section").mesh = static_cast<std::int32_t>(level.meshes.size()) - 1;
}

}  // namespace

Level three_probes(const Detail& detail) {
  const Solid solid = organ();
  const LatticeSphere surface = cover(solid, detail.organ_coarse, detail.organ_doublings);
  Level level;
  level.name = "three_probes";
  level.about = "The demo: three probes press and slide on a soft organ.";
  level.images = {organ_color(surface, detail.color_size), organ_normals(surface, solid, detail.normal_size)};
  Material flesh;
  flesh.name = "wet flesh";
  flesh.base_color = vec4(1);
  flesh.roughness = 0.35f;
  flesh.base_color_texture = 0;
  flesh.normal_texture = 1;
  level.materials.push_back(flesh);
  Primitive primitive = to_primitive(surface, solid);
  primitive.material = 0;
  level.meshes.push_back({"organ", {std::move(primitive)}});

  LevelNode& node = add_node(level, "organ");
  node.mesh = 0;
  node.deformable = Deformable{};
  node.deformable->stiffness = 300.0;
  node.deformable->reach = 0.022;
  node.deformable->shape = Shape::kVolume;
  node.stated.insert("deformable.relief");  // its bumps are drawn alone: wet tissue is smooth
  add_probe(level, "probe_a", 0.004, kCoral);
  add_probe(level, "probe_b", 0.003, kTeal);
  add_probe(level, "probe_c", 0.0, kGold);
  // Lower than the sun and from the front, so that dents cast shadows.
  add_view(level, {0.02, 0.09, 0.36}, {0.002, -0.006, 0.0}, "sky.exr", {0.74, 0.60, 0.30});
  level.nodes.back().light->intensity = 3.5f;
  return level;
}

Level inclusion(const Detail& detail) {
  const Solid solid = pad();
  Level level;
  level.name = "inclusion";
  level.about = "Two fingers search a pad for a hard spot under the skin; a cut through the pad stands behind it.";
  level.materials.push_back(look_of(*find_preset("skin"), 0.03f));
  const LatticeSphere surface = cover(solid, detail.pad_coarse, detail.pad_doublings);
  Primitive primitive = to_primitive(surface, solid);
  primitive.material = 0;
  level.images = {skin_color(surface, detail.color_size)};
  level.materials[0].base_color = vec4(1);
  level.materials[0].base_color_texture = 0;  // the skin does not show the hard spot, only the section does
  for (const vec3& p : primitive.position)
    primitive.stiffness.push_back(static_cast<float>(1.0 + (p.y > 0.0f ? 5.0 * pad_hardness(p.x, p.z) : 0.0)));
  level.meshes.push_back({"pad", {std::move(primitive)}});

  LevelNode& node = add_node(level, "pad");
  node.mesh = 0;
  node.deformable = Deformable{};
  node.deformable->spring = SpringLaw::kExponential;
  node.deformable->stiffness = 80.0;
  node.deformable->stiffening = 120.0;
  node.deformable->reach = 0.018;
  node.deformable->volume = 0.8;
  add_section(level, detail);
  add_probe(level, "finger_a", 0.005, kCoral);
  add_probe(level, "finger_b", 0.005, kTeal);
  add_view(level, {0.0, 0.17, 0.26}, {0.0, 0.0, 0.005});
  return level;
}

Level glass_heart(const Detail& detail) {
  Level level;
  level.name = "glass_heart";
  level.about = "A heart of soft glass: what is seen through it bends with the dents of three probes.";
  Material glass;
  glass.name = "soft glass";
  glass.base_color = vec4(1);
  glass.roughness = 0.02f;
  glass.ior = 1.45f;
  glass.transmission = 1.0f;
  glass.thickness = 0.07f;
  glass.attenuation_color = {0.92f, 0.35f, 0.42f};
  glass.attenuation_distance = 0.09f;
  LevelNode& node = add_body(level, heart(), glass, detail);
  node.deformable->stiffness = 250.0;
  node.deformable->reach = 0.022;
  node.deformable->shape = Shape::kVolume;
  add_probe(level, "probe_a", 0.005, kCoral);
  add_probe(level, "probe_b", 0.005, kTeal);
  add_probe(level, "probe_c", 0.004, kGold);
  add_view(level, {0.05, 0.05, 0.36}, {0.0, 0.0, 0.0}, "terrace.exr");
  return level;
}

Level chrome_cushion(const Detail& detail) {
  Level level;
  level.name = "chrome_cushion";
  level.about = "A chrome cushion: what it mirrors bends with the dents of two probes.";
  Material chrome;
  chrome.name = "chrome";
  chrome.base_color = vec4(0.92f, 0.93f, 0.95f, 1.0f);
  chrome.metallic = 1.0f;
  chrome.roughness = 0.05f;
  LevelNode& node = add_body(level, cushion(), chrome, detail);
  node.deformable->stiffness = 250.0;
  node.deformable->reach = 0.034;
  node.deformable->shape = Shape::kVolume;
  add_probe(level, "probe_a", 0.008, kCoral);
  add_probe(level, "probe_b", 0.006, kTeal);
  add_view(level, {0.06, 0.20, 0.34}, {0.0, 0.012, 0.0}, "terrace.exr");
  return level;
}

Level turning_ball(const Detail& detail) {
  Level level;
  level.name = "turning_ball";
  level.about = "A ball with ridges on a turntable: they pass under a finger that stays where it is.";
  Material clay;
  clay.name = "soft clay";
  clay.base_color = vec4(1);
  clay.roughness = 0.4f;
  LevelNode& node = add_body(level, ridged_ball(), clay, detail, ball_color);
  node.deformable->stiffness = 250.0;
  node.deformable->reach = 0.016;
  node.deformable->shape = Shape::kVolume;
  // The ball is a child of the turning table.
  add_node(level, "turntable").children = {1};
  std::swap(level.nodes[0], level.nodes[1]);
  level.nodes[1].parent = 0;
  level.animations.push_back(turn_of(0, 8.0));
  add_probe(level, "finger_a", 0.005, kTeal);
  add_view(level, {0.06, 0.07, 0.24}, {0.0, 0.0, 0.0}, "sky.exr", {0.74, 0.60, 0.30});
  return level;
}

Status generate(const std::filesystem::path& folder, const Detail& detail) {
  const std::filesystem::path levels = folder / "levels", environments = folder / "environments";
  std::error_code code;
  std::filesystem::create_directories(levels, code);
  std::filesystem::create_directories(environments, code);
  if (code) return Error{folder.string(), "cannot make the folders levels/ and environments/", "check its permissions"};

  if (Status s = save_panorama(sky(detail.sky_width), environments / "sky.exr"); !s) return s;
  if (Status s = save_panorama(terrace(2 * detail.sky_width), environments / "terrace.exr"); !s) return s;
  const Level organ_level = three_probes(detail), pad_level = inclusion(detail);
  if (Status s = save_plain(organ_level, levels / "three_probes.glb"); !s) return s;
  if (Status s = save_strokes(organ_level, organ(), organ_strokes(), levels); !s) return s;
  if (Status s = save_level(pad_level, levels / "inclusion.glb", SaveOptions{kBits}); !s) return s;
  if (Status s = save_strokes(pad_level, pad(), pad_strokes(), levels); !s) return s;
  const Level heart_level = glass_heart(detail), cushion_level = chrome_cushion(detail);
  if (Status s = save_plain(heart_level, levels / "glass_heart.glb"); !s) return s;
  if (Status s = save_strokes(heart_level, heart(), heart_strokes(), levels); !s) return s;
  if (Status s = save_plain(cushion_level, levels / "chrome_cushion.glb"); !s) return s;
  if (Status s = save_strokes(cushion_level, cushion(), cushion_strokes(), levels); !s) return s;
  const Level ball_level = turning_ball(detail);
  if (Status s = save_plain(ball_level, levels / "turning_ball.glb"); !s) return s;
  if (Status s = save_strokes(ball_level, ridged_ball(), ball_strokes(), levels); !s) return s;
  if (Status s = write_tool_levels(levels); !s) return s;
  if (Status s = write_grasp_level(levels); !s) return s;
  if (Status s = write_forceps_level(levels); !s) return s;
  if (Status s = write_hand_grip_level(levels); !s) return s;
  if (Status s = write_instrument_levels(levels); !s) return s;
  if (Status s = write_fields_level(levels); !s) return s;
  if (Status s = write_layers_level(levels); !s) return s;
  if (Status s = write_palpation_level(levels); !s) return s;
  if (Status s = write_effects(levels); !s) return s;
  return write_minimal(levels);
}

}  // namespace pliant::generate
