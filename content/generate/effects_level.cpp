#include "content/generate/effects_level.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "content/author/save_script.h"
#include "content/generate/stage.h"

namespace pliant::generate {
namespace {

constexpr int kPlateSquares = 24;      // per side of a plate
constexpr float kPlate = 0.048f;       // [m] its side
constexpr double kApart = 0.06;        // [m] between the middles of two plates
constexpr double kFingertip = 0.0015;  // [m]
constexpr std::uint32_t kTexels = 256;

// Studs 4 mm apart, as heights of 0.2 mm.
Image studs() {
  Image out{"studs", kTexels, kTexels, {}};
  for (std::uint32_t y = 0; y < kTexels; ++y)
    for (std::uint32_t x = 0; x < kTexels; ++x) {
      const auto wave = [](std::uint32_t i) { return std::cos(2 * std::numbers::pi * 12 * (i + 0.5) / kTexels); };
      const auto level = static_cast<std::uint8_t>(std::lround(255 * (0.5 + 0.25 * (wave(x) + wave(y)))));
      out.rgba.insert(out.rgba.end(), {level, level, level, 255});
    }
  return out;
}

Primitive plate() {
  Primitive out;
  for (int j = 0; j <= kPlateSquares; ++j)
    for (int i = 0; i <= kPlateSquares; ++i) {
      const float u = static_cast<float>(i) / kPlateSquares, v = static_cast<float>(j) / kPlateSquares;
      out.position.push_back({kPlate * (u - 0.5f), 0.0f, kPlate * (v - 0.5f)});
      out.normal.push_back({0, 1, 0});
      out.uv.push_back({u, v});
    }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (kPlateSquares + 1) + i); };
  for (int j = 0; j < kPlateSquares; ++j)
    for (int i = 0; i < kPlateSquares; ++i)
      for (const std::uint32_t v : {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i + 1, j)})
        out.index.push_back(v);
  return out;
}

struct PlateKind {
  const char* name;
  const char* about;
  vec3 color;
  float roughness;
  std::function<void(Deformable&)> make;
};

const PlateKind kPlates[] = {
    {"glass",
     "smooth and slippery",
     {0.25f, 0.45f, 0.55f},
     0.08f,
     [](Deformable& d) { d.friction_static = d.friction_sliding = 0.06; }},
    {"rubber",
     "sticky, the more the faster it is stroked",
     {0.10f, 0.10f, 0.11f},
     0.7f,
     [](Deformable& d) {
       d.friction_static = d.friction_sliding = 1.0;
       d.friction_viscous = 3.0;
     }},
    {"rosin",
     "sticks when slow and lets go when fast: under a hand that gives way it stick-slips",
     {0.62f, 0.30f, 0.06f},
     0.3f,
     [](Deformable& d) {
       d.friction_static = 1.1;
       d.friction_sliding = 0.2;
       d.friction_stribeck = 0.03;
     }},
    {"sandpaper",
     "fine roughness",
     {0.48f, 0.36f, 0.22f},
     0.95f,
     [](Deformable& d) {
       d.texture_amplitude = 2e-5;
       d.texture_wavelength = 8e-4;
     }},
    {"studs", "coarse relief, drawn and felt", {0.30f, 0.42f, 0.28f}, 0.5f, [](Deformable& d) { d.relief = 1.0; }},
    {"bell", "hard, and rings when it is struck", {0.72f, 0.56f, 0.22f}, 0.2f, [](Deformable& d) {
       d.stiffness = 900.0;
       d.friction_static = d.friction_sliding = 0.15;
       d.transient_amplitude = 6.0;
       d.transient_frequency = 140.0;
       d.transient_decay = 35.0;
     }}};

dvec3 middle_of(std::size_t plate) {
  return {kApart * (static_cast<double>(plate % 3) - 1.0), 0.0, kApart * (static_cast<double>(plate / 3) - 0.5)};
}

// Strikes the plate at 40 mm/s, strokes it slowly one way and fast the other, and lifts.
Path stroke_of(std::size_t plate) {
  constexpr double kClear = 0.012, kDepth = 0.0015, kSeconds = 6.0;
  const dvec3 middle = middle_of(plate);
  const double late = 0.12 * static_cast<double>(plate);
  Path out;
  for (int row = 0; row <= 100 * static_cast<int>(kSeconds); ++row) {
    const double t = 0.01 * row, s = t - late;
    const double down = smooth_step(0.3, 0.75, s) - smooth_step(4.3, 4.9, s);
    const double along = smooth_step(1.2, 3.2, s) - smooth_step(3.4, 4.0, s);
    out.rows.push_back(
        {t, middle + dvec3(-0.016 + 0.032 * along, kFingertip + kClear - (kClear + kDepth) * down, 0.004 * along),
         dquat(1, 0, 0, 0)});
  }
  return out;
}

std::string script_of(std::size_t plate) {
  return std::string("effects_") + static_cast<char>('a' + plate) + ".csv";
}

}  // namespace

Level effects() {
  Level level;
  level.name = "effects";
  level.about = "Six plates that a finger tells apart blind: glass, rubber, rosin, sandpaper, studs and a bell.";
  level.images = {studs()};
  for (std::size_t p = 0; p < std::size(kPlates); ++p) {
    const PlateKind& kind = kPlates[p];
    Material material;
    material.name = kind.name;
    material.base_color = vec4(kind.color, 1.0f);
    material.roughness = kind.roughness;
    material.double_sided = true;
    Primitive primitive = plate();
    primitive.material = static_cast<std::int32_t>(p);
    LevelNode& node = add_node(level, kind.name);
    node.mesh = static_cast<std::int32_t>(p);
    node.local.translation = vec3(middle_of(p));
    node.deformable = Deformable{};
    node.deformable->stiffness = 400.0;
    node.deformable->reach = 0.008;
    kind.make(*node.deformable);
    if (node.deformable->relief > 0.0) {
      material.height_texture = 0;
      material.height_scale = 2e-4f;
    } else {
      primitive.uv.clear();
    }
    level.materials.push_back(material);
    level.meshes.push_back({kind.name, {std::move(primitive)}});
  }
  for (std::size_t p = 0; p < std::size(kPlates); ++p) {
    LevelNode& node = add_node(level, std::string("finger_") + kPlates[p].name);
    node.probe = Probe{};
    node.probe->radius = kFingertip;
    node.probe->color = p % 3 == 0 ? kCoral : p % 3 == 1 ? kTeal : kGold;
    node.probe_device = node.name;
    node.device = HapticDevice{};
    node.device->driver = DriverKind::kScript;
    node.device->file = script_of(p);
  }
  add_view(level, {0.0, 0.17, 0.19}, {0.0, 0.0, 0.004});
  return level;
}

Status write_effects(const std::filesystem::path& folder) {
  if (Status s = save_plain(effects(), folder / "effects.glb"); !s) return s;
  for (std::size_t p = 0; p < std::size(kPlates); ++p)
    if (Status s =
            save_script(stroke_of(p), std::string(kPlates[p].name) + ": " + kPlates[p].about, folder / script_of(p));
        !s)
      return s;
  return Done{};
}

}  // namespace pliant::generate
