// A body's tissue by itself, pressed on patches of its surface: small strains at rest, and pressed and let go in time.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "components/world.h"
#include "content/level/level.h"
#include "runtime/result.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {

// A body's tetrahedra, with the sample points of its surface in them.
struct Lattice {
  double cell = 0.0;  // [m]
  TetMesh tets;
};

// Where it is pressed, the same for every lattice.
struct Patches {
  Mesh surface;       // sample points
  double radius = 0;  // [m]
  std::vector<std::uint32_t> vertices;
};

// `alone`: of level_alone(). The first call fills `patches`. A body that nothing holds is held at its lowest part, so
// that there is an answer to a press.
Result<Lattice> make_lattice(Level& alone, std::size_t node, double cell, Patches& patches);

TissueMaterial material_of(const SoftBody& body, Strain strain);
// [N] on each node: one newton against the surface, spread over a patch.
std::vector<dvec3> patch_load(const Patches& patches, const TetMesh& tets, std::uint32_t vertex);

// Of every press, small strains, the way of each sample point. [m], one newton each. Nothing: it cannot be solved.
using Answers = std::vector<std::vector<dvec3>>;
std::optional<Answers> answers(const Lattice& lattice, const SoftBody& body, const Patches& patches);
// [1] RMS of the difference over the RMS of the truth, over all presses and the whole surface by area.
double difference(const Answers& a, const Answers& truth, const Mesh& surface);
// The most compliant patch of the tissue, and its displacement. [m] for one newton
std::pair<std::uint32_t, double> softest(const Answers& answers, const Patches& patches);

inline constexpr double kShortestStep = 1e-3;  // [s] shorter ones are not measured: 500 of these fill a press

struct StepFigures {
  double step = 0.0;   // [s]
  double error = 0.0;  // [1]
  double ms = 0.0;     // [ms] of a step on this machine
};
// Of each of `steps` [s], on this lattice, pressed and released at its most compliant patch: the RMS difference from
// the midpoint rule in short steps over the RMS of the way, at the same moments whatever the step. Of a step below
// kShortestStep that of kShortestStep, which is larger. Steps that cannot be solved are left out.
std::vector<StepFigures> step_errors(const Lattice& lattice, const SoftBody& body, const Patches& patches,
                                     const Answers& at_rest, const std::vector<double>& steps);

}  // namespace pliant
