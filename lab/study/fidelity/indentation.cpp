// Presses the models of study_fidelity.h in sessions.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/soft_body.h"
#include "components/tet_mesh.h"
#include "engine/session/session_world.h"
#include "lab/study/fidelity/study_fidelity.h"
#include "lab/study/pareto.h"
#include "lab/study/processor_time.h"
#include "pliant/session.h"

namespace pliant {
namespace {

constexpr double kBeginsAbove = 0.001;    // [m] start height of a press above the surface
constexpr double kSoftStep = 1.0 / 60.0;  // [s]
constexpr double kFocus = 1.2;            // [1] of the punch's radius: half width of the lattice's fine box
constexpr double kEdges = 4.0;  // [1] surface edges per lattice cell, so that the punch's rim also rests on edges
constexpr double kTop = 0.98;   // [1] of the half width: vertices beyond belong to the sides
const dvec3 kDown(0, -1, 0);

// The block's surface: squares of `edge` on the top. If `below` is false, only the top.
MeshData slab(const Indented& what, double edge, bool below) {
  MeshData mesh;
  const int n = std::max(2, static_cast<int>(std::lround(2 * what.half_width / edge)));
  const auto at = [&](int i) { return static_cast<float>(-what.half_width + 2 * what.half_width * i / n); };
  const auto corner = [&](int side, int i, int j) {
    return static_cast<std::uint32_t>(side * (n + 1) * (n + 1) + i * (n + 1) + j);
  };
  for (int side = 0; side < (below ? 2 : 1); ++side)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        mesh.position.emplace_back(at(i), side == 0 ? 0.0f : static_cast<float>(-what.thickness), at(j));
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    for (const std::uint32_t v : {a, b, c, a, c, d}) mesh.index.push_back(v);
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      quad(corner(0, i, j), corner(0, i, j + 1), corner(0, i + 1, j + 1), corner(0, i + 1, j));
      if (below) quad(corner(1, i, j), corner(1, i + 1, j), corner(1, i + 1, j + 1), corner(1, i, j + 1));
    }
  for (int i = 0; below && i < n; ++i) {
    quad(corner(0, i, 0), corner(0, i + 1, 0), corner(1, i + 1, 0), corner(1, i, 0));
    quad(corner(0, i + 1, n), corner(0, i, n), corner(1, i, n), corner(1, i + 1, n));
    quad(corner(0, 0, i + 1), corner(0, 0, i), corner(1, 0, i), corner(1, 0, i + 1));
    quad(corner(0, n, i), corner(0, n, i + 1), corner(1, n, i + 1), corner(1, n, i));
  }
  return mesh;
}

// A cylinder about the y axis with its lower face at y = 0.
MeshData punch(double radius) {
  constexpr int kSides = 32;
  MeshData mesh;
  const auto ring = [&](float y) {
    for (int i = 0; i < kSides; ++i) {
      const double turn = 2 * std::numbers::pi * i / kSides;
      mesh.position.emplace_back(radius * std::cos(turn), y, radius * std::sin(turn));
    }
  };
  ring(0.0f);
  ring(static_cast<float>(2 * radius));
  mesh.position.emplace_back(0.0f, 0.0f, 0.0f);
  mesh.position.emplace_back(0.0f, static_cast<float>(2 * radius), 0.0f);
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t j = (i + 1) % kSides, up = kSides;
    for (const std::uint32_t v : {2 * up, i, j, 2 * up + 1, j + up, i + up, i, i + up, j, j, i + up, j + up})
      mesh.index.push_back(v);
  }
  return mesh;
}

DeviceParameters any_force() {
  DeviceParameters device;
  device.max_force = 1000;
  device.max_slew = 1e7;
  return device;
}

// Prescribes the probe from above the surface to each depth in turn and keeps it there; measures the cost in contact.
template <class Note>
Status press(Session& session, const std::string& effector, const Indented& what, const PressRun& run, Indentation& out,
             const Note& note) {
  const int half = std::max(1, static_cast<int>(std::lround(run.seconds * 1000 / 2)));
  double from = -kBeginsAbove;
  std::uint64_t spent = 0, ticks = 0;
  for (const double depth : what.depths) {
    for (int i = 1; i <= 2 * half; ++i) {
      if (!run.goes_on()) return interrupted();
      const double share = std::min(1.0, static_cast<double>(i) / half);
      if (const Status moved = session.move(effector, kDown * (from + share * (depth - from))); !moved) return moved;
      const std::uint64_t begin = process_ns();
      if (const Status done = session.step(); !done) return done;
      if (i > half) spent += process_ns() - begin, ++ticks;
    }
    const auto felt = session.reading(effector);
    if (!felt) return felt.error();
    out.force.push_back(std::abs(felt->force.y));
    from = depth;
  }
  out.us = static_cast<double>(spent) * 1e-3 / static_cast<double>(ticks);
  return note();
}

// Reads the surface deflection around the centre.
Status read_surface(Session& session, const std::string& object, const Indented& what, Indentation& out) {
  std::vector<vec3> at;
  if (const Status read = session.vertices(object, at); !read) return read;
  const double size = what.depths.back();
  for (const vec3 p : at)
    if (p.y > -what.thickness / 2 && std::max(std::abs(p.x), std::abs(p.z)) < kTop * what.half_width)
      out.surface.emplace_back(std::hypot(static_cast<double>(p.x), static_cast<double>(p.z)),
                               -static_cast<double>(p.y) / size);
  return Done{};
}

}  // namespace

BlockPress Indented::block(int cells) const {
  return {young, poisson, radius, thickness, half_width, cells, Strain::kCorotational};
}

Result<Indentation> press_surface(const Indented& what, const DeformableParameters& parameters) {
  Scene scene("press");
  scene.simulation().gravity = dvec3(0);
  scene.add_surface("tissue", slab(what, what.radius / 4, false), parameters);
  scene.add_probe("point", {}, any_force(), {.position = -kBeginsAbove * kDown});
  auto session = Session::open(scene);
  if (!session) return session.error();
  Indentation out;
  const Status done = press(*session, "point", what, {.seconds = 0.2}, out,
                            [&] { return read_surface(*session, "tissue", what, out); });
  if (!done) return done.error();
  return out;
}

Result<Indentation> press_tissue(const Indented& what, PressRun& run) {
  Scene scene("press");
  scene.simulation().gravity = dvec3(0);
  scene.simulation().soft_step = kSoftStep;
  SoftBodyParameters body;
  body.young = what.young;
  body.poisson = what.poisson;
  body.rayleigh = {0.0, 0.01};
  body.cell = run.cell;
  body.contact = run.contact;
  if (run.focus) {
    const auto half = static_cast<float>(kFocus * what.radius);
    body.focus.add(vec3(-half, -half, -half));
    body.focus.add(vec3(half, 0, half));
  }
  const auto wide = static_cast<float>(2 * what.half_width), deep = static_cast<float>(what.thickness);
  body.pinned.add(vec3(-wide, -2 * deep, -wide));
  body.pinned.add(vec3(wide, -0.999f * deep, wide));
  scene.add_soft_body("tissue", slab(what, std::min(what.radius / 2, run.cell / kEdges), true), body);
  scene.add_rigid_body("punch", punch(what.radius), {}, {.position = -kBeginsAbove * kDown});
  HandleParameters held;
  held.translation = {1e5, 20.0};
  held.rotation = {100.0, 0.1};
  held.max_force = 1000;
  held.max_torque = 100;
  if (const Status added = scene.add_handle("punch", held, any_force()); !added) return added.error();
  auto session = Session::open(scene);
  if (!session) return session.error();
  const World& world = world_of(*session);
  for (auto [entity, its] : world.registry.view<const SoftBody>()) run.tets = world.tet_meshes[its.tets].tets.size();
  Indentation out;
  const Status done =
      press(*session, "punch", what, run, out, [&] { return read_surface(*session, "tissue", what, out); });
  if (!done) return done.error();
  return out;
}

Indentation as_indentation(const std::vector<PressedBlock>& blocks, const std::vector<double>& depths) {
  Indentation out;
  double ms = 0.0;
  for (const PressedBlock& block : blocks) {
    if (std::find(depths.begin(), depths.end(), block.depth) == depths.end()) continue;
    out.force.push_back(block.force);
    ms += block.ms / block.solves;
  }
  out.us = ms / static_cast<double>(out.force.size()) / kSoftStep;  // ms per step over the 1e3 ticks of a second
  return out;
}

}  // namespace pliant
