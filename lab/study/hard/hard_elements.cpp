// Elements: inverted tissue, and files with degenerate tetrahedra.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>

#include "lab/study/hard/hard_case.h"
#include "scenes/tet_shapes.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

const TissueMaterial kTissue{.young = 1e4, .poisson = 0.3, .density = 1000};
constexpr double kHardStep = 5e-3;  // [s]

std::unique_ptr<LinearSolver> solver_for(const Tissue& tissue) {
  auto solver = make_solver(SolverKind::kEigenCholesky, tissue.moving());
  solver->analyse(tissue.inner());
  return solver;
}

double energy(const Tissue& tissue) {
  return kinetic_energy(tissue) + tissue.elastic_energy();
}

struct Wreck {
  const char* name;
  std::function<dvec3(std::uint32_t, dvec3)> place;
};

HardFigure inverted(const HardSetting&) {
  HardFigure worst;
  TetMesh mesh = tets::box(3, 2, 2, dvec3(0), dvec3(0.15, 0.1, 0.1));
  tets::hold(mesh, [](dvec3 p) { return p.x < 1e-9; });
  const std::array<Wreck, 6> wrecks{
      {{"one node through the other side",
        [](std::uint32_t n, dvec3 p) { return n == 5 ? p + dvec3(-0.12, 0.02, 0.01) : p; }},
       {"flat", [](std::uint32_t, dvec3 p) { return dvec3(p.x, 0.05, p.z); }},
       {"a line", [](std::uint32_t, dvec3 p) { return dvec3(p.x, 0.05, 0.05); }},
       {"a point", [](std::uint32_t, dvec3) { return dvec3(0.0, 0.05, 0.05); }},
       {"inside out", [](std::uint32_t, dvec3 p) { return dvec3(-p.x, p.y, p.z); }},
       {"anything", [](std::uint32_t n, dvec3) { return 0.2 * tets::scatter(n); }}}};
  for (const Wreck& wreck : wrecks) {
    Tissue tissue(mesh, kTissue, mesh.free_count);
    auto solver = solver_for(tissue);
    for (std::uint32_t i = 0; i < mesh.free_count; ++i) tissue.position()[i] = wreck.place(i, mesh.nodes[i]);
    const double start = energy(tissue);
    for (int i = 0; i < 1000; ++i) {
      worst.need(step_tissue(tissue, *solver, kHardStep, dvec3(0)).solved, std::string("not solved: ") + wreck.name);
      worst.add(energy(tissue) / start, wreck.name);
    }
    for (const Tet& t : mesh.tets) {
      const auto& x = tissue.position();
      worst.need(dot(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]) > 0,
                 std::string("still inverted: ") + wreck.name);
    }
  }
  return worst;
}

// A sound block, and the same block with a defect added by `spoil`, must move alike under gravity. `twin`: a node
// beside node 0; if a sliver connects it to node 0, it stays there.
HardFigure beside_a_sound_one(const std::function<void(TetMesh&, std::uint32_t loose, std::uint32_t twin)>& spoil,
                              bool twin_hangs) {
  HardFigure worst;
  TetMesh sound = tets::box(2, 2, 2, dvec3(0), dvec3(0.1));
  tets::hold(sound, [](dvec3 p) { return p.y < 1e-9; });
  TetMesh broken = sound;
  const std::uint32_t loose = sound.free_count, twin = loose + 1;  // new nodes; pinned node indices shift by two
  for (Tet& t : broken.tets)
    for (std::uint32_t& n : t) n += n >= loose ? 2 : 0;
  broken.nodes.insert(broken.nodes.begin() + loose, {dvec3(0.05, 0.2, 0.05), sound.nodes[0] + 1e-7 * dvec3(1, 1, 1)});
  broken.free_count += 2;
  spoil(broken, loose, twin);
  Tissue tissue(broken, kTissue, broken.free_count), truth(sound, kTissue, sound.free_count);
  auto solver = solver_for(tissue), true_solver = solver_for(truth);
  for (int i = 0; i < 1000; ++i) {
    worst.need(step_tissue(tissue, *solver, kHardStep, {0, -9.81, 0}).solved, "not solved");
    worst.need(step_tissue(truth, *true_solver, kHardStep, {0, -9.81, 0}).solved, "not solved");
    worst.need(std::isfinite(energy(tissue)), "the energy");
    for (std::uint32_t n = 0; n < loose; ++n)
      worst.add(length(tissue.position()[n] - truth.position()[n]), fmt::format("node {}, step {}", n, i));
  }
  worst.need(!twin_hangs || length(tissue.position()[twin] - tissue.position()[0]) < 1e-3, "the sliver came off");
  return worst;
}

HardFigure sliver(const HardSetting&) {
  return beside_a_sound_one(
      [](TetMesh& mesh, std::uint32_t, std::uint32_t twin) {
        mesh.tets.push_back({0, 1, 4, twin});
        std::swap(mesh.tets[3][0], mesh.tets[3][1]);  // one tetrahedron with the wrong orientation
      },
      true);
}

HardFigure zero_volume(const HardSetting&) {
  return beside_a_sound_one(
      [](TetMesh& mesh, std::uint32_t loose, std::uint32_t twin) {
        mesh.tets.push_back({0, 1, 2, 2});  // a triangle
        mesh.tets.push_back({3, 3, 3, 3});  // a point
        mesh.tets.push_back({loose, 0, 1, 1});
        mesh.tets.push_back({0, 1, twin, twin});
      },
      false);
}

}  // namespace

std::vector<HardCase> hard_elements() {
  return {
      {"InvertedFlatAndCollapsedTissueGainsNothingAndUninverts", "methods.md 3.9: inverted",
       "six wrecks, 1,000 steps of 5 ms: all elements upright, energy over that at first", "of it [1]", 1.0, inverted},
      {"ASliverDisturbsNobody", "methods.md 3.9: sliver",
       "the sound part moves as without it for 1,000 steps, one element listed inside out", "m", 1e-5, sliver},
      {"ElementsWithoutVolumeDisturbNobody", "methods.md 3.9: zero volume", "the sound part moves as without them", "m",
       1e-5, zero_volume},
  };
}

}  // namespace pliant
