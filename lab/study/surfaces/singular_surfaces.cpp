#include "lab/study/surfaces/singular_surfaces.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "content/mesh/mesh_build.h"
#include "lab/study/processor_time.h"
#include "runtime/assert.h"
#include "scenes/scenes.h"
#include "systems/touch/collide/surface_query.h"

namespace pliant {
namespace {

constexpr double kBoxWidth = 0.1, kBoxHeight = 0.04;      // [m]
constexpr double kBehind = 0.003, kBehindWobble = 0.002;  // [m]
constexpr double kBoxStiffness = 300.0;                   // [N/m]

// Around an inner rectangle whose sides move in and out.
dvec3 on_loop(double s) {
  const double depth = kBehind + kBehindWobble * std::sin(10 * M_PI * s);
  const double a = 0.5 * kBoxWidth, b = 0.5 * kBoxHeight, way = std::fmod(s + 0.05, 1.0) * 4 * (a + b);
  dvec3 side(0, 0, 0.0013);  // on the square from -1 to 1
  if (way < 2 * a)
    side.x = way / a - 1, side.y = 1;
  else if (way < 2 * (a + b))
    side.x = 1, side.y = 1 - (way - 2 * a) / b;
  else if (way < 4 * a + 2 * b)
    side.x = 1 - (way - 2 * (a + b)) / a, side.y = -1;
  else
    side.x = -1, side.y = (way - 4 * a - 2 * b) / b - 1;
  return {(a - depth) * side.x, (b - depth) * side.y - b, side.z};
}

CreaseErrors crease_errors(const std::vector<dvec3>& places, const std::vector<dvec3>& forces) {
  CreaseErrors out;
  double squares = 0.0, count = 0.0, work = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const dvec3 x = places[i];
    const double depths[4] = {0.5 * kBoxWidth - x.x, 0.5 * kBoxWidth + x.x, -x.y, x.y + kBoxHeight};
    const dvec3 normals[4] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    const auto nearest = std::min_element(depths, depths + 4) - depths;
    double second = 1e30;
    for (int k = 0; k < 4; ++k)
      if (k != nearest) second = std::min(second, depths[k]);
    if (second > 3 * depths[nearest]) {
      const dvec3 n = normals[nearest];
      const double angle = std::atan2(length(cross(forces[i], n)), dot(forces[i], n)) * 180 / M_PI;
      squares += angle * angle, count += 1;
    }
    if (i == 0) continue;
    const dvec3 step = places[i] - places[i - 1];
    work += 0.5 * dot(forces[i] + forces[i - 1], step);
    if (length(step) > 0) out.steepest = std::max(out.steepest, length(forces[i] - forces[i - 1]) / length(step));
  }
  const double deepest = kBehind + kBehindWobble;
  out.work = std::abs(work) / (0.5 * deepest * deepest);
  out.direction = std::sqrt(squares / std::max(count, 1.0));
  return out;
}

CreaseErrors with_drifting_normals(int cells, const std::vector<dvec3>& places) {
  const Primitive p = scenes::slab(cells, kBoxWidth, kBoxHeight);
  auto built = build_mesh("box", std::span(&p, 1), mat4(1));
  ASSERT(built.ok());
  const Mesh& mesh = built->mesh;
  std::vector<dvec3> forces;
  const std::uint64_t begin = processor_ns();
  for (const dvec3& x : places) {
    const SurfaceFoot foot = nearest(mesh, x, 1.0);
    forces.push_back(-foot.height * foot.normal);
  }
  const double us = static_cast<double>(processor_ns() - begin) * 1e-3 / static_cast<double>(places.size());
  CreaseErrors out = crease_errors(places, forces);
  out.us = us;
  return out;
}

CreaseErrors with_feet(int cells, const std::vector<dvec3>& places) {
  scenes::Stage stage;
  Deformable d;
  d.stiffness = kBoxStiffness;
  d.contact_damping = 0.0;
  d.friction_static = d.friction_sliding = 0.0;
  d.settling_time = DeformableRange::kSettlingTime.min;
  d.reach = 0.01;
  stage.add(scenes::slab(cells, kBoxWidth, kBoxHeight), d);
  const dvec3 above(places[0].x, 0.002, places[0].z);
  const Entity probe = stage.add_probe(above);
  stage.prepare();
  stage.tick();
  stage.move(probe, places[0], 0.05);
  std::vector<dvec3> forces;
  for (const dvec3& x : places) {
    stage.place(probe, x);
    stage.tick();
    forces.push_back(stage.read(probe).force / kBoxStiffness);
  }
  CreaseErrors out = crease_errors(places, forces);
  for (std::size_t i = 0; i < stage.schedule().systems().size(); ++i)
    if (std::string(stage.schedule().systems()[i].name) == "collision")
      out.us = stage.schedule().cost(i).percentile_us(0.5);
  return out;
}

}  // namespace

const char* name_of(CreaseFelt felt) {
  return felt == CreaseFelt::kFeet ? "feet on both faces" : "drifting normals (P1)";
}

CreaseErrors feel_creases(int cells, CreaseFelt felt, int samples) {
  std::vector<dvec3> places;
  for (int i = 0; i <= samples; ++i) places.push_back(on_loop(static_cast<double>(i % samples) / samples));
  return felt == CreaseFelt::kFeet ? with_feet(cells, places) : with_drifting_normals(cells, places);
}

}  // namespace pliant
