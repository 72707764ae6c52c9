// Chooses the lattice, the soft step and the solver of a body, by presses on patches of its surface.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "content/keys/enum_words.h"
#include "content/tets/lattice.h"
#include "content/tets/step_cost.h"
#include "engine/choice/choice_parts.h"
#include "engine/choice/solver_choice.h"

namespace pliant {
namespace {

constexpr std::uint32_t kPresses = 6;                   // places, in the order of the surface's vertices
constexpr std::array kCells{2.0, 1.6, 1.25, 1.0, 0.8};  // [1] of the usual cell
constexpr double kFinest = 0.6;                         // [1] cell of the reference, in usual cells
constexpr std::array<double, 5> kStepsTried{1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480};  // [s]

// Limits of what is measured, whatever the level sets: seconds each, as with the usual cell, which never makes more
// than kMostUsualTets. An answer costs a factorisation and six solutions; a press takes some 500 steps.
constexpr std::size_t kMostAnswerTets = 5 * kMostUsualTets, kMostPressTets = kMostUsualTets;
constexpr int kCoarsenings = 4;  // attempts to find a cell within the limit

// The difference of two lattices underestimates the error: the finer one has an error itself, a quarter of one of twice
// the cell (order 2). The difference is extrapolated to vanishing cell size.
double to_truth(double difference, double cell, double finest) {
  const double ratio = finest / cell;
  return difference / std::max(0.05, 1 - ratio * ratio);
}

struct TriedLattice {
  double error;  // [1] discretisation error
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
  return {node.name, "could not be pressed to measure an error", "leave out `error`"};
}

// State of one body's choice.
class BodyChooser {
 public:
  BodyChooser(const Level& level, std::size_t index, ModelChoice& choice, ChoiceProgress& progress)
      : alone_(level_alone(level, index)),
        index_(index),
        node_(level.nodes[index]),
        choice_(choice),
        progress_(progress) {}

  // Lattices with their errors; for tetrahedra from a file, only that one.
  Status try_lattices();
  // The lattice for measuring soft steps: coarse even if the level sets a finer cell, because opening would otherwise
  // take minutes.
  Status find_press_lattice();
  std::vector<TriedLattice> lattices;
  Patches patches;
  const Answers& at_rest() const { return *at_rest_; }  // of pressed(), once it was found
  const Lattice& pressed() const { return coarse_ ? *coarse_ : lattices.front().its; }
  bool from_file() const { return !node_.soft_body->mesh.empty(); }

 private:
  Result<Lattice> lattice(double cell) { return make_lattice(alone_, index_, cell, patches); }
  // A lattice of this cell, or of a larger one with at most `most` tetrahedra. Empty if thin parts do not allow so
  // coarse a lattice.
  std::optional<Lattice> lattice_within(double cell, std::size_t most);
  Error too_large() const;
  void say(const std::string& doing) { progress_.say(doing + " for `" + node_.name + "`"); }

  Level alone_;
  std::size_t index_;
  const LevelNode& node_;
  ModelChoice& choice_;
  ChoiceProgress& progress_;
  std::optional<Lattice> coarse_;
  std::optional<Answers> at_rest_;
};

std::optional<Lattice> BodyChooser::lattice_within(double cell, std::size_t most) {
  for (int i = 0; i < kCoarsenings; ++i) {
    say("choosing a model");
    auto made = lattice(cell);
    if (!made) return std::nullopt;
    const std::size_t count = made->tets.tets.size();
    if (count <= most) return std::move(made).value();
    cell = 1.02 * made->cell * std::cbrt(static_cast<double>(count) / static_cast<double>(most));
  }
  return std::nullopt;
}

Error BodyChooser::too_large() const {
  return {node_.name,
          fmt::format("has {} tetrahedra, more than can be pressed in seconds to measure an error, and a coarser "
                      "lattice cannot be made of it",
                      lattices.front().its.tets.tets.size()),
          fmt::format("leave out `error`, or {}", from_file() ? "take a file with fewer" : "name a larger `cell`")};
}

Status BodyChooser::try_lattices() {
  auto usual = lattice(node_.soft_body->cell);
  if (!usual) return usual.error();
  const Mesh& surface = patches.surface;
  patches.radius = kDefaultReach * static_cast<double>(surface.box.diagonal());
  for (std::uint32_t k = 0; k < kPresses; ++k)
    patches.vertices.push_back(
        static_cast<std::uint32_t>((2 * std::uint64_t{k} + 1) * surface.vertex_count / (2 * kPresses)));
  if (from_file()) {
    lattices.push_back({0.0, std::move(*usual)});
    return Done{};
  }
  const bool cell_said = states(node_, "soft_body", "cell");
  const double cell = usual->cell;
  const std::size_t count = usual->tets.tets.size();
  // The finest cell whose refinement is affordable.
  const double share = std::cbrt(static_cast<double>(count) / static_cast<double>(kMostAnswerTets)) / kFinest;
  if (cell_said && share > 1.0) {
    lattices.push_back({0.0, std::move(*usual)});
    const auto tried = lattice_within(share * cell, kMostAnswerTets);
    const auto finest = tried ? lattice_within(kFinest * tried->cell, kMostAnswerTets) : std::nullopt;
    const auto truth = finest ? answers(*finest, *node_.soft_body, patches) : std::nullopt;
    const auto answer = truth ? answers(*tried, *node_.soft_body, patches) : std::nullopt;
    if (!answer || !(finest->cell < tried->cell)) return too_large();
    const double error = to_truth(difference(*answer, *truth, surface), tried->cell, finest->cell);
    const double finer = cell / tried->cell;
    lattices.front().error = error * finer * finer;
    choice_.presses.push_back(
        fmt::format("its {} tetrahedra are too many to be refined in seconds: the error of its lattice is that of {} "
                    "({:.2g}), scaled as of order 2; name a larger `cell` for a measured one",
                    count, tried->tets.tets.size(), error));
    return Done{};
  }
  const auto finest = lattice(kFinest * cell);
  if (!finest) return finest.error();
  say("choosing a model");
  const auto truth = answers(*finest, *node_.soft_body, patches);
  if (!truth) return unpressed(node_);
  for (const double each : kCells) {
    say("choosing a model");
    if (each != 1.0 && cell_said) continue;
    auto tried = each == 1.0 ? std::move(usual) : lattice(each * cell);
    if (!tried) continue;  // too coarse for thin parts
    const auto answer = answers(*tried, *node_.soft_body, patches);
    if (!answer) continue;
    const double error = to_truth(difference(*answer, *truth, surface), tried->cell, finest->cell);
    lattices.push_back({error, std::move(*tried)});
  }
  if (lattices.empty()) return Error{node_.name, "has no lattice whose error could be measured", "leave out `error`"};
  return Done{};
}

Status BodyChooser::find_press_lattice() {
  say("choosing a soft step");
  const std::size_t count = lattices.front().its.tets.tets.size();
  if (from_file() && count > kMostPressTets) {
    alone_.nodes[index_].soft_body->mesh.clear();
    coarse_ = lattice_within(0.0, kMostPressTets);
    if (!coarse_) return too_large();
    choice_.presses.push_back(
        fmt::format("its {} tetrahedra are too many to be pressed in seconds: soft steps were measured on a lattice "
                    "of {} in the same surface; take a file with fewer for measured ones",
                    count, coarse_->tets.tets.size()));
  }
  if (!from_file() && states(node_, "soft_body", "cell")) {
    coarse_ = lattice_within(kCells[0] * lattices.front().its.cell, kMostPressTets);
    if (!coarse_ && count > kMostPressTets) return too_large();
  }
  at_rest_ = answers(pressed(), *node_.soft_body, patches);
  return at_rest_ ? Status(Done{}) : Status(unpressed(node_));
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
  std::vector<double> wanted(kStepsTried.begin(), kStepsTried.end());
  if (states_step(level)) wanted = {level.simulation.soft_step}, choice.kept.emplace_back("soft_step");
  if (!make_solver(body.solver, 1))
    return Error{node.name, "its solver is not in this build, or its factory makes none", "use `auto`"};

  BodyChooser chooser(level, index, choice, progress);
  if (const Status tried = chooser.try_lattices(); !tried) return tried.error();
  if (const Status found = chooser.find_press_lattice(); !found) return found.error();
  const std::vector<TriedLattice>& lattices = chooser.lattices;
  const Patches& patches = chooser.patches;
  const Answers& at_rest = chooser.at_rest();
  const std::vector<StepFigures> steps = step_errors(chooser.pressed(), body, patches, at_rest, wanted);
  if (wanted.front() < kShortestStep)
    choice.presses.push_back(
        fmt::format("a soft step of {:.3g} ms is too short to be measured in seconds: the error of "
                    "{:.3g} ms, which is larger, stands for it; name a longer one",
                    1e3 * wanted.front(), 1e3 * kShortestStep));
  const std::uint32_t vertex = softest(at_rest, patches).first;
  const auto solvers = [&](const Lattice& its, double T, const std::vector<SolverKind>& kinds) {
    return measure_solvers(its.tets, material_of(body, Strain::kCorotational), patch_load(patches, its.tets, vertex), T,
                           kinds);
  };
  // Among several lattices none is too large (try_lattices).
  const bool solvable = lattices.front().its.tets.tets.size() <= kMostAnswerTets;
  if (!solvable)
    choice.presses.push_back(fmt::format("with so many tetrahedra no solver was measured; {}",
                                         from_file ? "take a file with fewer" : "name a larger `cell`"));

  std::vector<std::pair<ModelCandidate, BodyModel>> tried;
  const auto add = [&](std::size_t l, std::size_t s, const SolverFigures& solver) {
    const Lattice& its = lattices[l].its;
    ModelCandidate candidate;
    candidate.label = label_of(its, from_file, steps[s].step, solver.kind);
    candidate.error = lattices[l].error + steps[s].error + solver.error;
    candidate.cost = (step_ms(its.tets.tets.size(), 1.0) + solver.more_ms) / steps[s].step;
    candidate.ms = &its == &chooser.pressed() && solver.kind == SolverKind::kAuto ? steps[s].ms : 0.0;
    tried.push_back({candidate, {l, s, solver.kind}});
  };
  // First with the level's solver, or `auto`. If the solver is open, the others follow with the chosen lattice and
  // step: no solver is cheaper than `auto`, and none is more accurate by an amount that matters to a budget.
  for (std::size_t l = 0; l < lattices.size(); ++l)
    for (std::size_t s = 0; s < steps.size(); ++s)
      for (const SolverFigures& figures :
           solvable ? solvers(lattices[l].its, steps[s].step, {body.solver}) : std::vector{SolverFigures{body.solver}})
        add(l, s, figures);
  if (tried.empty()) return unpressed(node);
  if (!solver_said && solvable) {
    ModelChoice before = choice;
    auto sorted = tried;
    const BodyModel taken = take_cheapest(before, sorted);
    std::vector<SolverKind> others = solvers_to_choose();
    std::erase(others, body.solver);
    for (const SolverFigures& figures : solvers(lattices[taken.lattice].its, steps[taken.step].step, others)) {
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
  if (!from_file && !states(node, "soft_body", "cell")) node.soft_body->cell = lattices[taken.lattice].its.cell;
  if (!solver_said) node.soft_body->solver = taken.solver;
  step = std::min(step, steps[taken.step].step);
  return choice;
}

}  // namespace pliant
