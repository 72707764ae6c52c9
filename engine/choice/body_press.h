// A body's tissue in isolation, pressed on patches of its surface: static small strains, and pressing and release over
// time.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "components/world.h"
#include "content/level/level.h"
#include "runtime/result.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {

// A body's tetrahedra with the embedded sample points of its surface.
struct Lattice {
  double cell = 0.0;  // [m]
  TetMesh tets;
};

// Places of the presses, the same for every lattice.
struct Patches {
  Mesh surface;       // sample points
  double radius = 0;  // [m]
  std::vector<std::uint32_t> vertices;
};

// `alone`: of level_alone(). The first call fills `patches`. A free body is pinned at its lowest part, so that a press
// has a static solution.
Result<Lattice> make_lattice(Level& alone, std::size_t node, double cell, Patches& patches);

TissueMaterial material_of(const SoftBody& body, Strain strain);
// [N] on each node: one newton against the surface, spread over a patch.
std::vector<dvec3> patch_load(const Patches& patches, const TetMesh& tets, std::uint32_t vertex);

// [m] Displacement of each sample point for every press of one newton, with small strains. Empty if the system cannot
// be solved.
using Answers = std::vector<std::vector<dvec3>>;
std::optional<Answers> answers(const Lattice& lattice, const SoftBody& body, const Patches& patches);
// [1] RMS difference over the RMS of the truth, over all presses and the whole surface, area-weighted.
double difference(const Answers& a, const Answers& truth, const Mesh& surface);
// The most compliant patch of the tissue, and its displacement for one newton [m].
std::pair<std::uint32_t, double> softest(const Answers& answers, const Patches& patches);

inline constexpr double kShortestStep = 1e-3;  // [s] shortest step that is measured: 500 of these fill a press

struct StepFigures {
  double step = 0.0;   // [s]
  double error = 0.0;  // [1]
  double ms = 0.0;     // [ms] per step on this machine
};
// Error of each of `steps` [s] on this lattice, pressed and released at its most compliant patch: RMS difference from
// the midpoint rule with short steps, over the RMS displacement, at the same moments for all steps. A step below
// kShortestStep gets the error of kShortestStep, which is larger. Steps that cannot be solved are left out.
std::vector<StepFigures> step_errors(const Lattice& lattice, const SoftBody& body, const Patches& patches,
                                     const Answers& at_rest, const std::vector<double>& steps);

}  // namespace pliant
