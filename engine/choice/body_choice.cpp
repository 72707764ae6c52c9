// The lattice, the soft step and the solver of a body, by presses on patches of its surface.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "content/keys/enum_words.h"
#include "content/tets/step_cost.h"
#include "engine/choice/choice_parts.h"
#include "engine/choice/solver_choice.h"

namespace pliant {
namespace {

constexpr std::uint32_t kPresses = 6;                   // places, along the surface's own order
constexpr std::array kCells{2.0, 1.6, 1.25, 1.0, 0.8};  // [1] of the usual cell
constexpr double kFinest = 0.6;                         // [1] the truth's
constexpr std::array<double, 5> kStepsTried{1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480};  // [s]

// How far apart two lattices are is not what either is off by: the finer one has an error of its own, a quarter of one
// of twice the cell (order 2). The difference is scaled to what is left to cells of no size.
double to_truth(double difference, double cell, double finest) {
  const double ratio = finest / cell;
  return difference / std::max(0.05, 1 - ratio * ratio);
}

struct TriedLattice {
  double error;  // [1] of the lattice
  Lattice its;
};

struct BodyModel {
  std::size_t lattice, step;
  SolverKind solver;
};

std::string label_of(const Lattice& its, bool from_file, double step, SolverKind solver) {
  const std::string cell = from_file ? "file" : fmt::format("{:.3g} mm", 1e3 * its.cell);
  return fmt::format("cell {} ({} tetrahedra), step {:.3g} ms, solver {}", cell, its.tets.tets.size(), 1e3 * step,
                     word_of(solver));
}

Error unpressed(const LevelNode& node) {
  return {node.name, "could not be pressed to measure an error; leave out `error`"};
}

// Lattices with their errors; from a file the only one there is.
Result<std::vector<TriedLattice>> try_lattices(Level& alone, std::size_t index, const LevelNode& node, Patches& patches,
                                               ChoiceProgress& progress) {
  std::vector<TriedLattice> out;
  const auto say = [&] { progress.say("choosing a model for `" + node.name + "`"); };
  auto usual = make_lattice(alone, index, node.soft_body->cell, patches);
  if (!usual) return usual.error();
  const Mesh& surface = patches.surface;
  patches.radius = kDefaultReach * static_cast<double>(surface.box.diagonal());
  for (std::uint32_t k = 0; k < kPresses; ++k)
    patches.vertices.push_back(
        static_cast<std::uint32_t>((2 * std::uint64_t{k} + 1) * surface.vertex_count / (2 * kPresses)));
  if (!node.soft_body->mesh.empty()) {
    out.push_back({0.0, std::move(*usual)});
    return out;
  }
  say();
  const double cell = usual->cell;
  const auto finest = make_lattice(alone, index, kFinest * cell, patches);
  if (!finest) return finest.error();
  say();
  const auto truth = answers(*finest, *node.soft_body, patches);
  if (!truth) return unpressed(node);
  for (const double share : kCells) {
    say();
    if (share != 1.0 && states(node, "soft_body", "cell")) continue;
    auto tried = share == 1.0 ? std::move(usual) : make_lattice(alone, index, share * cell, patches);
    if (!tried) continue;  // too coarse for what is thin in it
    const auto answer = answers(*tried, *node.soft_body, patches);
    if (!answer) continue;
    const double error = to_truth(difference(*answer, *truth, surface), tried->cell, finest->cell);
    out.push_back({error, std::move(*tried)});
  }
  if (out.empty()) return Error{node.name, "has no lattice whose error could be measured; leave out `error`"};
  return out;
}

}  // namespace

Result<ModelChoice> choose_body(Level& level, std::size_t index, double& step, ChoiceProgress& progress) {
  LevelNode& node = level.nodes[index];
  ModelChoice choice{node.name, "soft body", node.soft_body->error, {}, 0, false, {}, {}};
  const SoftBody& body = *node.soft_body;
  const bool from_file = !body.mesh.empty(), solver_said = states(node, "soft_body", "solver");
  for (const char* key : {"cell", "mesh", "solver"})
    if (states(node, "soft_body", key)) choice.kept.emplace_back(key);
  if (from_file) choice.presses.emplace_back("its tetrahedra come from a file, whose own error was not measured");
  std::vector<double> steps(kStepsTried.begin(), kStepsTried.end());
  if (states_step(level)) steps = {level.simulation.soft_step}, choice.kept.emplace_back("soft_step");

  Patches patches;
  Level alone = level_alone(level, index);
  auto lattices = try_lattices(alone, index, node, patches, progress);
  if (!lattices) return lattices.error();
  progress.say("choosing a soft step for `" + node.name + "`");
  // Steps are measured on a coarse lattice, also where the level says a finer one: else opening would take minutes.
  std::optional<Lattice> coarse;
  if (!from_file && states(node, "soft_body", "cell")) {
    auto made = make_lattice(alone, index, kCells[0] * lattices->front().its.cell, patches);
    if (made) coarse = std::move(made).value();
  }
  const Lattice& coarsest = coarse ? *coarse : lattices->front().its;
  const auto at_rest = answers(coarsest, body, patches);
  if (!at_rest) return unpressed(node);
  const auto errors = step_errors(coarsest, body, patches, *at_rest, steps);
  const std::uint32_t vertex = softest(*at_rest, patches).first;
  const auto solvers = [&](const Lattice& its, double T, const std::vector<SolverKind>& kinds) {
    return measure_solvers(its.tets, material_of(body, Strain::kCorotational), patch_load(patches, its.tets, vertex), T,
                           kinds);
  };

  std::vector<std::pair<ModelCandidate, BodyModel>> tried;
  const auto add = [&](std::size_t l, std::size_t s, const SolverFigures& solver) {
    const Lattice& its = (*lattices)[l].its;
    ModelCandidate candidate;
    candidate.label = label_of(its, from_file, steps[s], solver.kind);
    candidate.error = (*lattices)[l].error + errors[s].first + solver.error;
    candidate.cost = (step_ms(its.tets.tets.size(), 1.0) + solver.more_ms) / steps[s];
    candidate.ms = &its == &coarsest && solver.kind == SolverKind::kAuto ? errors[s].second : 0.0;
    tried.push_back({candidate, {l, s, solver.kind}});
  };
  // By the solver that the level says, or `auto`; where it is open the others come after, with the lattice and step
  // that are taken: no solver is cheaper than `auto`, and none nearer by what a budget could tell.
  for (std::size_t l = 0; l < lattices->size(); ++l)
    for (std::size_t s = 0; s < steps.size(); ++s)
      for (const SolverFigures& figures : solvers((*lattices)[l].its, steps[s], {body.solver})) add(l, s, figures);
  if (tried.empty()) return unpressed(node);
  if (!solver_said) {
    ModelChoice before = choice;
    auto sorted = tried;
    const BodyModel taken = take_cheapest(before, sorted);
    std::vector<SolverKind> others = solvers_to_choose();
    std::erase(others, body.solver);
    for (const SolverFigures& figures : solvers((*lattices)[taken.lattice].its, steps[taken.step], others)) {
      add(taken.lattice, taken.step, figures);
      choice.remarks.push_back(fmt::format(
          "solver {}: {:.1e} off the direct solution, {:+.3g} ms a step beyond `auto`, with 60 contacts; {:.2g} ms on "
          "this machine to factorise and solve once",
          word_of(figures.kind), figures.error, figures.more_ms, figures.measured));
    }
  }
  const BodyModel taken = take_cheapest(choice, tried);
  for (const ChoosableKey& key : choosable_keys(level, index))
    if (!key.said && key.extension != "handle") choice.keys.push_back(key);
  if (!from_file && !states(node, "soft_body", "cell")) node.soft_body->cell = (*lattices)[taken.lattice].its.cell;
  if (!solver_said) node.soft_body->solver = taken.solver;
  step = std::min(step, steps[taken.step]);
  return choice;
}

}  // namespace pliant
