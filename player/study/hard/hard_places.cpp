// Geometry: probes on vertices, edges, borders and creases, through thin walls, and on meshes that are not sound.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "player/study/hard/hard_case.h"
#include "tests/scenes/touch_laws.h"
#include "tests/scenes/touch_raw.h"

namespace pliant {
namespace {

// Pressed 3 mm deep, held there, and held by a hand that trembles: how far the force is off, of the law's.
// `shift`: keeps the trembling inside the border. `jump` [N]: most between two ticks of the press.
void press(HardFigure& worst, const char* name, const Primitive& surface, dvec3 at, double want,
           dvec3 shift = dvec3(0)) {
  Stage stage;
  const Deformable d = frictionless();
  const Entity sheet = stage.add(surface, d);
  const Entity probe = stage.add_probe(at + dvec3(0, 0.008, 0));
  stage.prepare();
  double before = 0;
  const double force = want * law(d, 0.003);
  stage.move(probe, at, 0.2, [&](const ProbeReading& r) {
    worst.need(std::abs(r.normal_force - before) < 0.05, fmt::format("{}: a step of the force", name));
    before = r.normal_force;
  });
  worst.add(std::abs(before - force) / force, name);
  stage.wait(0.2);
  for (int i = 0; i < 200; ++i) {
    stage.place(probe, at + 1e-5 * dvec3(std::sin(2.0 * i), std::sin(3.1 * i), std::cos(1.7 * i)) + shift);
    stage.tick();
    worst.need(stage.read(probe).in_contact, fmt::format("{}: it let go", name));
    worst.add(std::abs(stage.read(probe).normal_force - before) / force, fmt::format("{}, trembling", name));
  }
  for (const vec4& s : stage.field(sheet).stream)
    worst.need(std::isfinite(s.x + s.y + s.z + s.w), fmt::format("{}: the surface", name));
}

HardFigure on_a_vertex(const HardSetting&) {
  HardFigure worst;
  press(worst, "vertex of a sheet", scenes::sheet(10, 0.1), {0.01, -0.003, 0.01}, 1);
  return worst;
}

// Along lines from vertex to vertex of a coarse sphere, 3 mm deep: the foot meets vertices and edges exactly.
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

HardFigure on_an_edge(const HardSetting&) {
  HardFigure worst;
  press(worst, "edge", scenes::sheet(10, 0.1), {0.015, -0.003, 0.01}, 1);
  press(worst, "diagonal", scenes::sheet(10, 0.1), {0.015, -0.003, 0.015}, 1);
  // Under a ridge both sides are nearer than its line, and share the push: s = 1.5^(-1/4) cos(0.7) of the depth.
  press(worst, "ridge", scenes::valley(10, 0.1, -0.7), {0, -0.003, 0.003},
        std::pow(std::pow(1.5, -0.25) * std::cos(0.7), 2));
  return worst;
}

HardFigure on_a_border(const HardSetting&) {
  HardFigure worst;
  press(worst, "border", scenes::sheet(10, 0.1), {0.05, -0.003, 0}, 1, {-2e-5, 0, 0});
  press(worst, "corner", scenes::sheet(10, 0.1), {0.05, -0.003, 0.05}, 1, {-2e-5, 0, -2e-5});
  return worst;
}

HardFigure in_a_crease(const HardSetting&) {
  HardFigure worst;
  // Of all places the line of the crease is the nearest.
  press(worst, "valley", scenes::valley(10, 0.1, 0.7), {0, -0.003, 0.003}, 1);
  return worst;
}

HardFigure pass_through(const HardSetting&) {
  HardFigure worst;
  for (const double thickness : {0.0, 0.001})
    for (const double radius : {0.0, 0.002}) {
      const std::string where = fmt::format("wall {:g} mm, radius {:g} mm", 1e3 * thickness, 1e3 * radius);
      Stage stage;
      stage.add(thickness > 0 ? scenes::slab(20, 0.2, thickness) : scenes::sheet(20, 0.2), frictionless());
      const Entity probe = stage.add_probe({0.003, 0.05, 0.002}, radius);
      stage.prepare();
      stage.tick();
      for (int i = 1; i <= 4; ++i) {
        const double y = 0.05 - 0.02 * i;
        stage.place(probe, {0.003, y, 0.002});
        stage.tick();
        if (y >= 0) continue;
        worst.need(stage.read(probe).in_contact, where + ": it went through");
        worst.need(stage.read(probe).force.y > 0, where + ": nothing pushes");
        worst.add(std::abs(stage.read(probe).depth + y - radius), where);
      }
    }
  return worst;
}

// The forces of one press, slide and lift on two surfaces that should feel the same.
double difference(const Primitive& one, const Primitive& other) {
  std::vector<dvec3> first;
  double most = 0;
  for (const Primitive* surface : {&one, &other}) {
    Stage stage;
    stage.add(*surface, frictionless());
    const Entity probe = stage.add_probe({-0.021, 0.001, 0.0137});
    stage.prepare();
    std::size_t i = 0;
    for (const dvec3 to : {dvec3(-0.021, -0.003, 0.0137), dvec3(0.03, -0.004, -0.02), dvec3(0.03, 0.002, -0.02)})
      stage.move(probe, to, 0.2, [&](const ProbeReading&) {
        const dvec3 f = raw_force(stage, probe);
        if (surface == &one) {
          first.push_back(f);
        } else {
          most = std::max(most, length(f - first[i++]));
        }
        if (!std::isfinite(length(f))) most = INFINITY;
      });
  }
  for (const dvec3& f : first)
    if (f.y > 1.0) return most;
  return INFINITY;  // it was not pressed
}

HardFigure duplicate_vertices(const HardSetting&) {
  HardFigure worst;
  const Primitive welded = scenes::sheet(10, 0.1);
  Primitive soup;  // every triangle has corners of its own
  for (const std::uint32_t i : welded.index) {
    soup.index.push_back(static_cast<std::uint32_t>(soup.position.size()));
    soup.position.push_back(welded.position[i]);
  }
  worst.add(difference(welded, soup));
  return worst;
}

HardFigure zero_area(const HardSetting&) {
  HardFigure worst;
  const Primitive sound = scenes::sheet(10, 0.1);
  Primitive broken = sound;
  const std::uint32_t across = 11;  // vertices in a row
  for (const std::uint32_t v : {24u, 60u, 71u}) {
    const std::uint32_t flat[] = {v, v, v + 1, v, v, v, v, v + 1, v + 2, v, v + across, v + 2 * across};
    broken.index.insert(broken.index.begin() + 30, std::begin(flat), std::end(flat));
  }
  worst.add(difference(sound, broken));
  return worst;
}

// A fin hangs under the middle line of a sheet: three triangles an edge.
HardFigure non_manifold(const HardSetting&) {
  HardFigure worst;
  Primitive p = scenes::sheet(10, 0.1);
  const auto first = static_cast<std::uint32_t>(p.position.size());
  for (int j = 0; j <= 10; ++j) {
    p.position.push_back(vec3(0, 0, 0.05 - 0.01 * j));
    p.position.push_back(vec3(0, -0.03, 0.05 - 0.01 * j));
  }
  for (std::uint32_t j = 0; j < 10; ++j) {
    const std::uint32_t a = first + 2 * j;
    for (const std::uint32_t v : {a, a + 1, a + 3, a, a + 3, a + 2}) p.index.push_back(v);
  }
  for (const bool back : {false, true}) {
    Stage stage;
    const Deformable d = frictionless();
    stage.add(p, d);
    const Entity probe = stage.add_probe({back ? 0.02 : -0.02, 0.002, 0.003});
    stage.prepare();
    RawMeter meter;
    const auto go = [&](dvec3 to, double seconds) {
      stage.move(probe, back ? dvec3(-to.x, to.y, to.z) : to, seconds, [&](const ProbeReading& r) {
        meter.add(stage, probe, r.position);
        worst.need(std::isfinite(length(raw_force(stage, probe))), "the force");
      });
    };
    go({-0.02, -0.003, 0.003}, 0.2);
    worst.need(std::abs(raw_force(stage, probe).y - law(d, 0.003)) < 0.01 * law(d, 0.003), "beside it, the law");
    go({0.02, -0.003, 0.003}, 0.8);
    go({0.02, 0.002, 0.003}, 0.2);
    go({-0.02, 0.002, 0.003}, 0.2);
    worst.add(meter.work / meter.most, back ? "from the right" : "from the left");
  }
  return worst;
}

}  // namespace

std::vector<HardCase> hard_places() {
  constexpr const char* kForce =
      "pressed 3 mm and held by a trembling hand: the law's force, no step over 0.05 N a tick";
  return {
      {"OnAVertexTheForceIsThatOfTheLaw", "methods.md 3.9: probe on a vertex or edge", kForce, "of the law [1]", 0.01,
       on_a_vertex},
      {"AProbeLedFromVertexToVertexFeelsTheSphere", "methods.md 3.9: probe on a vertex or edge",
       "400 lines between neighbours of 866 vertices, 3 mm deep: the force of the sphere", "of it [1]", 0.02,
       from_vertex_to_vertex},
      {"OnAnEdgeTheForceIsThatOfTheLaw", "methods.md 3.9: probe on a vertex or edge", kForce, "of the law [1]", 0.01,
       on_an_edge},
      {"NothingIsTunnelledThroughAtTwentyMetresPerSecond", "methods.md 3.9: 20 m/s pass-through",
       "sheets and walls of 1 mm are felt, at their depth", "m", 1e-6, pass_through},
      {"AThreeTriangleEdgeGivesOutNoEnergy", "methods.md 3.9: non-manifold",
       "a sheet with a fin under it: finite force, the law 20 mm beside it, work over a closed path",
       "of the stored energy [1]", 1e-3, non_manifold},
      {"OnABorderAndACornerTheForceIsThatOfTheLaw", "methods.md 3.9: border", kForce, "of the law [1]", 0.01,
       on_a_border},
      {"DuplicateVerticesChangeNothing", "methods.md 3.9: duplicate vertices",
       "every triangle with corners of its own feels as the welded sheet", "N", 1e-9, duplicate_vertices},
      {"TrianglesWithoutAreaChangeNothing", "methods.md 3.9: zero-area triangles",
       "a sheet with twelve of them feels as without", "N", 1e-9, zero_area},
      {"InAConcaveCreaseTheForceIsThatOfTheLaw", "methods.md 3.9: concave crease", kForce, "of the law [1]", 0.01,
       in_a_crease},
  };
}

}  // namespace pliant
