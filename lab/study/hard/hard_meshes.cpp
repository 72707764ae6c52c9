// Defective meshes, and walls that a probe crosses within one tick.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/study/hard/hard_case.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

// The depth 3 mm behind a coarse sphere, or inside a bowl, must equal that of slow steps. The last step begins in front
// of the triangle and the curved surface, between them, or exactly on one of them.
void pass_through_curved(HardFigure& worst) {
  constexpr double kRadius = 0.05;
  for (const bool hollow : {false, true}) {
    const Primitive p = hollow ? scenes::bowl(4, kRadius) : scenes::sphere(4, kRadius);
    const double inward = hollow ? 1.0 : -1.0;  // direction of the press along the radius
    for (const dvec3 towards : {dvec3(0.1, -1, 0.23), dvec3(-0.4, -1, 0.1), dvec3(0.31, -1, -0.37)}) {
      const dvec3 u = normalize(towards);
      std::vector<double> steps{5e-5};
      for (int i = 0; i <= 40; ++i)
        steps.push_back(0.003 + 2.5e-5 * i);  // [m] lengths of the last step, from 3 to 4 mm
      double slow = 0.0;
      for (const double last : steps) {
        Stage stage;
        stage.add(p, frictionless());
        double r = kRadius + inward * 0.003;
        const Entity probe = stage.add_probe((r - inward * 0.01) * u);
        stage.prepare();
        stage.tick();
        if (last < 1e-4)
          stage.move(probe, r * u, 0.2);
        else
          for (const double back : {last, 0.0}) stage.place(probe, (r - inward * back) * u), stage.tick();
        const ProbeReading felt = stage.read(probe);
        const std::string where =
            fmt::format("{} of triangles, a last step of {:g} mm", hollow ? "bowl" : "sphere", 1e3 * last);
        worst.need(felt.in_contact, where + ": it went through");
        if (last < 1e-4)
          slow = felt.depth;
        else
          worst.add(std::abs(felt.depth - slow), where);
      }
    }
  }
}

HardFigure pass_through(const HardSetting&) {
  HardFigure worst;
  pass_through_curved(worst);
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

// Compares the forces of one press, slide and lift on two surfaces that should feel the same.
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
  return INFINITY;  // the surface was not pressed
}

HardFigure duplicate_vertices(const HardSetting&) {
  HardFigure worst;
  const Primitive welded = scenes::sheet(10, 0.1);
  Primitive soup;  // triangles share no vertices
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
  const std::uint32_t across = 11;  // vertices per row
  for (const std::uint32_t v : {24u, 60u, 71u}) {
    const std::uint32_t flat[] = {v, v, v + 1, v, v, v, v, v + 1, v + 2, v, v + across, v + 2 * across};
    broken.index.insert(broken.index.begin() + 30, std::begin(flat), std::end(flat));
  }
  worst.add(difference(sound, broken));
  return worst;
}

// A fin under the centre line of a sheet: three triangles share each edge.
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

std::vector<HardCase> hard_meshes() {
  return {
      {"NothingIsTunnelledThroughAtTwentyMetresPerSecond", "methods.md 3.9: 20 m/s pass-through",
       "sheets, walls of 1 mm, hollows and spheres of few triangles are felt, at their depth", "m", 1e-6, pass_through},
      {"AThreeTriangleEdgeGivesOutNoEnergy", "methods.md 3.9: non-manifold",
       "a sheet with a fin under it: finite force, the law 20 mm beside it, work over a closed path",
       "of the stored energy [1]", 1e-3, non_manifold},
      {"DuplicateVerticesChangeNothing", "methods.md 3.9: duplicate vertices",
       "every triangle with corners of its own feels as the welded sheet", "N", 1e-9, duplicate_vertices},
      {"TrianglesWithoutAreaChangeNothing", "methods.md 3.9: zero-area triangles",
       "a sheet with twelve of them feels as without", "N", 1e-9, zero_area},
  };
}

}  // namespace pliant
