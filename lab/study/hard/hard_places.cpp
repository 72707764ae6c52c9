// Geometry: probes on vertices, edges, borders and creases.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "lab/study/hard/hard_case.h"
#include "lab/study/hard/hard_solids.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

constexpr double kPress = 0.003;  // [m]

// Pressed 3 mm deep and kept there, first still, then with a tremor of 0.01 mm. Figure: deviation of the force from the
// law, relative.
void press(HardFigure& worst, const char* name, const Primitive& surface, dvec3 at) {
  Stage stage;
  const Deformable d = frictionless();
  const Entity sheet = stage.add(surface, d);
  const Entity probe = stage.add_probe(at + dvec3(0, 0.008, 0));
  stage.prepare();
  double before = 0;
  const double force = law(d, kPress);
  stage.move(probe, at, 0.2, [&](const ProbeReading& r) {
    worst.need(std::abs(r.normal_force - before) < 0.05, fmt::format("{}: a step of the force", name));
    before = r.normal_force;
  });
  worst.add(std::abs(before - force) / force, name);
  stage.wait(0.2);
  for (int i = 0; i < 200; ++i) {
    stage.place(probe, at + 1e-5 * dvec3(std::sin(2.0 * i), std::sin(3.1 * i), std::cos(1.7 * i)));
    stage.tick();
    worst.need(stage.read(probe).in_contact, fmt::format("{}: it let go", name));
    worst.add(std::abs(stage.read(probe).normal_force - before) / force, fmt::format("{}, trembling", name));
  }
  for (const vec4& s : stage.field(sheet).stream)
    worst.need(std::isfinite(s.x + s.y + s.z + s.w), fmt::format("{}: the surface", name));
}

HardFigure in_a_sheet(const HardSetting&) {
  HardFigure worst;
  const Primitive sheet = scenes::sheet(10, 0.1);
  press(worst, "vertex", sheet, {0.01, -kPress, 0.01});
  press(worst, "edge", sheet, {0.015, -kPress, 0.01});
  press(worst, "diagonal", sheet, {0.015, -kPress, 0.015});
  return worst;
}

// Along lines between vertices of a coarse sphere, 3 mm deep: the foot meets vertices and edges exactly.
HardFigure from_vertex_to_vertex(const HardSetting&) {
  HardFigure worst;
  Stage stage;
  const Deformable d = frictionless();
  const Entity ball = stage.add(scenes::sphere(12, 0.1), d);
  const Mesh& mesh = stage.mesh(ball);
  const auto above = [&](std::uint32_t v) { return dvec3(mesh.normal(v)); };
  const Entity probe = stage.add_probe(0.101 * above(0));
  stage.prepare();
  std::uint32_t at = 0;
  stage.move(probe, 0.097 * above(at), 0.1);
  std::vector<bool> seen(mesh.vertex_count);
  for (int way = 0; way < 400; ++way) {
    seen[at] = true;
    std::uint32_t next = at;
    double least = 1e30;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
      if (const double far = length(dvec3(mesh.position(v)) - dvec3(mesh.position(at))); !seen[v] && far < least)
        least = far, next = v;
    const dvec3 from = above(at), to = above(next);
    for (int i = 1; i <= 50; ++i) {
      const dvec3 out = normalize(from + (to - from) * (i / 50.0));
      stage.place(probe, 0.097 * out);
      stage.tick();
      worst.add(length(raw_force(stage, probe) - law(d, 0.003) * out) / law(d, 0.003), fmt::format("way {}", way));
    }
    at = next;
  }
  return worst;
}

// A sphere moves over a corner and the edges and sides around it, 3 mm deep: its force is that of its distance.
HardFigure over_corners(const HardSetting&) {
  HardFigure worst;
  constexpr double kRadius = 0.008;
  for (const Solid& solid : {box_solid(), octahedron_solid()}) {
    Stage stage;
    const Deformable d = frictionless();
    stage.add(solid.surface, d);
    const dvec3 u = normalize(cross(solid.out, dvec3(0.3, -0.2, 1))), v = cross(solid.out, u);
    const Entity probe = stage.add_probe(solid.corner + 0.05 * solid.out, kRadius);
    stage.prepare();
    stage.tick();
    double nearest = 1.0, farthest = 0.0;
    for (int i = 0; i <= 8000; ++i) {
      const double a = 2 * M_PI * 7 * i / 8000, lean = 1.4 * std::sin(2 * M_PI * i / 8000);
      const dvec3 away =
          solid.corner + 0.03 * (std::cos(lean) * solid.out + std::sin(lean) * (std::cos(a) * u + std::sin(a) * v));
      const dvec3 p = solid.closest(away), n = normalize(away - p);
      const double depth = kPress * std::min(1.0, i / 200.0);
      stage.place(probe, p + (kRadius - depth) * n);
      stage.tick();
      worst.add(length(raw_force(stage, probe) - law(d, depth) * n) / law(d, kPress), solid.name);
      nearest = std::min(nearest, length(p - solid.corner));
      farthest = std::max(farthest, length(p - solid.corner));
    }
    worst.need(nearest < 1e-9 && farthest > 0.015, fmt::format("{}: the path", solid.name));
  }
  return worst;
}

// By how much a force is outside of the negative gradients of the stored energy on both sides of a place, which differ
// where the nearest side of a solid switches. [N]
dvec3 outside_gradients(Stage& stage, Entity probe, dvec3 x, dvec3 force) {
  constexpr double kStep = 1e-6;  // [m]
  const auto energy = [&](dvec3 at) {
    stage.place(probe, at);
    stage.tick();
    return stored(stage);
  };
  const double here = energy(x);
  dvec3 outside(0);
  for (int k = 0; k < 3; ++k) {
    dvec3 step(0);
    step[k] = kStep;
    const double ahead = (here - energy(x + step)) / kStep, behind = (energy(x - step) - here) / kStep;
    outside[k] = std::max({0.0, std::min(ahead, behind) - force[k], force[k] - std::max(ahead, behind)});
  }
  return outside;
}

// Points below a corner, a tip and a ridge, where the surface has no unique normal, and spheres over a tip.
HardFigure by_energy(const HardSetting&) {
  HardFigure worst;
  struct Under {
    const char* name;
    Primitive surface;
    double radius;
    dvec3 from;
    std::function<dvec3(double, double, double)> at;  // of three numbers in [0, 1]
  };
  const dvec3 tip(0, kHalfSolid, 0);
  const std::array<Under, 5> places{{
      {"a point under a box's corner",
       box_solid().surface,
       0,
       {kHalfSolid - 0.004, 0.005, kHalfSolid - 0.004},
       [](double a, double b, double c) {
         return dvec3(kHalfSolid, 0, kHalfSolid) - dvec3(0.001) - 0.006 * dvec3(a, b, c);
       }},
      {"a point under an octahedron's corner", octahedron_solid().surface, 0, tip + dvec3(0.001, 0.005, 0.0005),
       [=](double a, double b, double c) {
         const double y = 0.002 + 0.006 * a;
         return tip + y * dvec3(0.45 * (2 * b - 1), -1, 0.45 * (2 * c - 1));
       }},
      // Deeper than the radius of curvature, the nearest side switches at once.
      {"a point under a cone's tip",
       cone(24, 0.04, 0.04),
       0,
       {0.001, 0.005, 0.0005},
       [](double a, double b, double c) {
         const double y = 0.002 + 0.004 * a;
         return y * dvec3(0.5 * std::sqrt(b) * std::cos(6.28 * c), -1, 0.5 * std::sqrt(b) * std::sin(6.28 * c));
       }},
      {"a point under a ridge",
       scenes::valley(10, 0.1, -0.7),
       0,
       {0.0005, 0.005, 0.003},
       [](double a, double b, double c) {
         const double y = 0.001 + 0.006 * a;
         return dvec3(0.9 * y * (2 * b - 1), -y - 0.8 * std::abs(0.9 * y * (2 * b - 1)), 0.02 * (c - 0.5));
       }},
      {"a sphere over a cone's tip",
       cone(24, 0.04, 0.04),
       0.008,
       {0, 0.02, 0},
       [](double a, double b, double c) {
         const double lean = 1.3 * b;
         return (0.004 + 0.003 * a) *
                dvec3(std::sin(lean) * std::cos(6.28 * c), std::cos(lean), std::sin(lean) * std::sin(6.28 * c));
       }},
  }};
  for (const Under& place : places) {
    Stage stage;
    const Deformable d = frictionless();
    stage.add(place.surface, d);
    const Entity probe = stage.add_probe(place.from, place.radius);
    stage.prepare();
    stage.move(probe, place.at(0.5, 0.5, 0.5), 0.05);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    double least = 1e9;
    for (int i = 0; i < 200; ++i) {
      const double a = unit(random), b = unit(random), c = unit(random);
      const dvec3 x = place.at(a, b, c);
      stage.move(probe, x, 0.01);
      const dvec3 f = raw_force(stage, probe);
      least = std::min(least, length(f));
      worst.add(length(outside_gradients(stage, probe, x, f)) / law(d, kPress), place.name);
    }
    worst.need(least > 0.01, fmt::format("{}: not pressed", place.name));
  }
  return worst;
}

// 3 mm under a ridge line, both sides are nearest and share the reaction.
HardFigure under_a_ridge(const HardSetting&) {
  HardFigure worst;
  constexpr double kSlope = 0.7;  // [rad]
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::valley(10, 0.1, -kSlope), d);
  const dvec3 at(0, -kPress, 0.003);
  const Entity probe = stage.add_probe(at + dvec3(0, 0.008, 0));
  stage.prepare();
  stage.move(probe, at, 0.2);
  const dvec3 held = raw_force(stage, probe);
  const double side = law(d, kPress * std::cos(kSlope));  // of one side alone
  worst.need(held.y > 0.2 * side && held.y < side, fmt::format("the force, {:.3g} of one side's", held.y / side));
  worst.add(std::hypot(held.x, held.z) / side, "sideways");
  for (int i = 0; i < 200; ++i) {
    stage.place(probe, at + 1e-5 * dvec3(std::sin(2.0 * i), std::sin(3.1 * i), std::cos(1.7 * i)));
    stage.tick();
    worst.add(length(raw_force(stage, probe) - held) / side, "trembling");
  }
  return worst;
}

constexpr double kBorder = 0.05;  // [m] half of a sheet

// A sphere moves over the border or a corner of an open sheet, with tremor: the closest point is on the sheet.
HardFigure sphere_over_a_border(const HardSetting&) {
  HardFigure worst;
  constexpr double kRadius = 0.008;
  for (const dvec3 out : {dvec3(1, 0, 0), dvec3(0, 0, -1), dvec3(1, 0, 1)}) {
    const char* where = out.x * out.z != 0.0 ? "corner" : "border";
    Stage stage;
    const Deformable d = frictionless();
    stage.add(scenes::sheet(10, 2 * kBorder), d);
    const dvec3 rim = kBorder * out, middle = rim + dvec3(0, kRadius - kPress, 0);
    const Entity probe = stage.add_probe(middle - 0.02 * out + dvec3(0, 0.01, 0), kRadius);
    stage.prepare();
    const auto look = [&](const char* what) {
      const dvec3 x = stage.read(probe).position,
                  p = glm::clamp(x, dvec3(-kBorder, 0, -kBorder), dvec3(kBorder, 0, kBorder)), n = normalize(x - p);
      const double depth = std::max(0.0, kRadius - length(x - p));
      worst.add(length(raw_force(stage, probe) - law(d, depth) * n) / law(d, kPress), fmt::format("{}{}", where, what));
    };
    const auto go = [&](dvec3 to) { stage.move(probe, to, 0.3, [&](const ProbeReading&) { look(""); }); };
    go(middle - 0.02 * out);
    go(middle);
    for (int i = 0; i < 400; ++i) {
      stage.place(probe, middle + 2e-5 * std::sin(2.0 * i) * out + 1e-5 * dvec3(0, std::sin(3.1 * i), 0));
      stage.tick();
      look(", trembling");
    }
    go(middle + 0.004 * out);
    go(rim + 0.006 * out);
    go(middle + 0.004 * out);
    go(middle - 0.02 * out);
  }
  return worst;
}

// A point behind an open sheet is in contact up to the border. Beyond it there is no force, and a hand that trembles
// over the border is released once.
HardFigure point_over_a_border(const HardSetting&) {
  HardFigure worst;
  for (const dvec3 out : {dvec3(1, 0, 0), dvec3(0, 0, -1), dvec3(1, 0, 1)})
    for (const bool trembles : {false, true}) {
      const std::string where =
          fmt::format("{}{}", out.x * out.z != 0.0 ? "corner" : "border", trembles ? ", trembling" : "");
      Stage stage;
      const Deformable d = frictionless();
      stage.add(scenes::sheet(10, 2 * kBorder), d);
      const dvec3 rim = kBorder * out, down(0, -kPress, 0);
      const Entity probe = stage.add_probe(rim - 0.01 * out + dvec3(0, 0.002, 0));
      stage.prepare();
      RawMeter meter;
      bool held = true;
      int let_go = 0;
      const auto look = [&] {
        const dvec3 x = stage.read(probe).position, f = raw_force(stage, probe);
        meter.add(stage, probe, x);
        const bool beyond = std::max(std::abs(x.x), std::abs(x.z)) > kBorder;
        if (held && beyond && x.y < 0) held = false, ++let_go;
        if (!held && x.y > 0) held = true;  // it may enter again from above
        const double want = held && x.y < 0 ? law(d, -x.y) : 0.0;
        worst.add(length(f - dvec3(0, want, 0)) / law(d, kPress), where);
      };
      const auto go = [&](dvec3 to) { stage.move(probe, to, 0.2, [&](const ProbeReading&) { look(); }); };
      go(rim - 0.01 * out + down);
      go(rim - 1e-5 * out + down);
      if (trembles)
        for (int i = 0; i < 400; ++i) {
          stage.place(probe, rim + down + 2e-5 * std::sin(2.0 * i) * out);
          stage.tick();
          look();
        }
      go(rim + 0.005 * out + down);
      go(rim + 0.005 * out - down);
      go(rim - 0.01 * out - down);
      worst.need(let_go == 1, where + ": it was not let go once");
      worst.need(meter.most > 1e-4 && meter.work < 0, where + ": it gave out energy");
    }
  return worst;
}

HardFigure in_a_crease(const HardSetting&) {
  HardFigure worst;
  // The line of the crease is nearest to all of these places.
  press(worst, "valley", scenes::valley(10, 0.1, 0.7), {0, -kPress, 0.003});
  return worst;
}

}  // namespace

std::vector<HardCase> hard_places() {
  constexpr const char* kVertexOrEdge = "methods.md 3.9: probe on a vertex or edge";
  constexpr const char* kForce =
      "pressed 3 mm and held by a trembling hand: the law's force, no step over 0.05 N a tick";
  return {
      {"OnVerticesAndEdgesOfASheetTheForceIsThatOfTheLaw", kVertexOrEdge, kForce, "of the law [1]", 0.01, in_a_sheet},
      {"AProbeLedFromVertexToVertexFeelsTheSphere", kVertexOrEdge,
       "400 lines between neighbours of 866 vertices, 3 mm deep: the force of the sphere", "of it [1]", 0.02,
       from_vertex_to_vertex},
      {"ASphereOverCornersOfABoxAndAnOctahedronFeelsItsDistance", kVertexOrEdge,
       "led over corner, edges and sides, 3 mm deep: the law of its distance, along it", "of the law [1]", 1e-3,
       over_corners},
      {"UnderCornersTipsAndRidgesTheForceIsTheGradientOfTheEnergy", kVertexOrEdge,
       "points under a box's and an octahedron's corner, a cone's tip, a ridge, spheres over the tip: against one-sided "
       "differences of the stored energy",
       "of the law at 3 mm [1]", 1e-3, by_energy},
      {"HeldUnderARidgeTheForceIsSteadyAndLessThanOneSides", kVertexOrEdge,
       "3 mm under the line, trembling by 0.01 mm: straight up, 0.2 to 1 of the law of one side; sideways and change",
       "of one side's [1]", 0.01, under_a_ridge},
      {"ASphereLedOverTheBorderOfASheetFeelsItsDistance", "methods.md 3.9: border",
       "over borders and a corner and back, trembling across: the law of its distance to the sheet, along it",
       "of the law [1]", 1e-3, sphere_over_a_border},
      {"APointIsFeltUpToTheBorderOfASheetAndLetGoOnce", "methods.md 3.9: border",
       "3 mm deep, over borders and a corner, trembling across: the law up to it, nothing beyond; no energy given out",
       "of the law [1]", 0.01, point_over_a_border},
      {"InAConcaveCreaseTheForceIsThatOfTheLaw", "methods.md 3.9: concave crease", kForce, "of the law [1]", 0.01,
       in_a_crease},
  };
}

}  // namespace pliant
