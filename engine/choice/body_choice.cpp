// The lattice and the soft step of a body, by presses on patches of its surface.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "components/deformable.h"
#include "content/level/progress.h"
#include "content/tets/step_cost.h"
#include "content/tets/tet_embed.h"
#include "content/tets/tet_order.h"
#include "engine/choice/choice_parts.h"
#include "runtime/clock.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

constexpr std::uint32_t kPresses = 6;                   // places, along the surface's own order
constexpr std::array kCells{2.0, 1.6, 1.25, 1.0, 0.8};  // [1] of the usual cell
constexpr double kFinest = 0.6;                         // [1] the truth's
constexpr std::array<double, 5> kSteps{1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480};  // [s]
constexpr double kTruthStep = 1.0 / 960, kEvery = 1.0 / 30;  // [s] the midpoint rule's, and when it is looked at
constexpr double kRise = 0.2, kHold = 0.1, kLast = 0.5;      // [s] of a press: it comes, holds, is let go
constexpr double kHeldShare = 0.15;                          // [1] of the height, where nothing is pinned
constexpr double kStrain = 0.1;                              // [1] deepest dent over the patch's radius

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

// A body that nothing holds is held at its lowest part, so that there is an answer to a press.
void hold(TetMesh& tets) {
  if (tets.free_count < tets.node_count()) return;
  double low = 1e300, high = -1e300;
  for (const dvec3& p : tets.nodes) low = std::min(low, p.y), high = std::max(high, p.y);
  std::vector<NodeGroup> group;
  for (const dvec3& p : tets.nodes)
    group.push_back(p.y <= low + kHeldShare * (high - low) ? NodeGroup::kPinned : NodeGroup::kFree);
  put_in_order(tets, group);
  tets.free_count = static_cast<std::uint32_t>(std::count(group.begin(), group.end(), NodeGroup::kFree));
  tets.handle_count = 0;
}

Result<Lattice> lattice(const Level& level, std::size_t node, double cell, Patches& patches) {
  auto world = spawn_alone(level, node, cell);
  if (!world) return world.error();
  Lattice out;
  for (auto [entity, body] : world->registry.view<const SoftBody>()) {
    out.tets = world->tet_meshes[body.tets];
    if (patches.surface.vertex_count == 0) patches.surface = world->meshes[body.collision_mesh];
  }
  out.cell = out.tets.report.cell;
  hold(out.tets);
  out.tets.embedding = embed(patches.surface, out.tets.nodes, out.tets.tets);
  return out;
}

TissueMaterial material_of(const SoftBody& body, Strain strain) {
  return {.young = body.young,
          .poisson = body.poisson,
          .density = body.density,
          .alpha = body.rayleigh[0],
          .beta = body.rayleigh[1],
          .strain = strain};
}

// [N] on each node: one newton against the surface, spread over a patch.
std::vector<dvec3> patch_load(const Patches& patches, const TetMesh& tets, std::uint32_t vertex) {
  const Mesh& surface = patches.surface;
  const dvec3 middle(surface.position(vertex)), inward = -dvec3(surface.normal(vertex));
  std::vector<dvec3> load(tets.node_count(), dvec3(0));
  double sum = 0.0;
  for (const bool measured : {false, true})
    for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
      const double u = length(dvec3(surface.position(v)) - middle) / patches.radius;
      if (u >= 1.0 || dot(dvec3(surface.normal(v)), inward) > 0.0) continue;
      const double weight = surface.area[v] * (1 - u * u) * (1 - u * u);
      if (!measured) {
        sum += weight;
        continue;
      }
      const Embedding& at = tets.embedding[v];
      for (std::size_t i = 0; i < 4; ++i) load[tets.tets[at.tet][i]] += weight / sum * at.weight[i] * inward;
    }
  return load;
}

// [m] of each sample point, where nodes have moved from rest.
std::vector<dvec3> moved(const TetMesh& tets, const std::vector<dvec3>& nodes) {
  std::vector<dvec3> out;
  for (const Embedding& at : tets.embedding) {
    dvec3 u(0);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t node = tets.tets[at.tet][i];
      u += at.weight[i] * (nodes[node] - tets.nodes[node]);
    }
    out.push_back(u);
  }
  return out;
}

// The answer to every press, small strains. [m], one newton each.
std::optional<std::vector<std::vector<dvec3>>> answers(const Lattice& lattice, const SoftBody& body,
                                                       const Patches& patches) {
  constexpr double kForever = 1e4;  // [s] inertia is nothing against stiffness
  Tissue tissue(lattice.tets, material_of(body, Strain::kLinear), lattice.tets.free_count);
  tissue.assemble(kForever, dvec3(0));
  const auto solver = make_solver(SolverKind::kBlockCholesky, tissue.inner().size);
  solver->analyse(tissue.inner());
  if (!solver->factorise(tissue.inner())) return std::nullopt;
  std::vector<std::vector<dvec3>> out;
  for (const std::uint32_t vertex : patches.vertices) {
    const std::vector<dvec3> load = patch_load(patches, lattice.tets, vertex);
    Vector right = Vector::Zero(3 * tissue.moving()), u = right;
    for (std::uint32_t i = 0; i < tissue.moving(); ++i)
      right.segment<3>(3 * i) = kForever * Eigen::Vector3d(load[i].x, load[i].y, load[i].z);
    solver->solve(right, u);
    std::vector<dvec3> nodes = lattice.tets.nodes;
    for (std::uint32_t i = 0; i < tissue.moving(); ++i)
      nodes[i] += kForever * dvec3(u[3 * i], u[3 * i + 1], u[3 * i + 2]);
    out.push_back(moved(lattice.tets, nodes));
  }
  return out;
}

// [1] RMS of the difference over the RMS of the truth, over all presses and the whole surface by area.
double difference(const std::vector<std::vector<dvec3>>& a, const std::vector<std::vector<dvec3>>& truth,
                  const Mesh& surface) {
  double off = 0.0, size = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k)
    for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
      const dvec3 d = a[k][v] - truth[k][v];
      off += surface.area[v] * dot(d, d);
      size += surface.area[v] * dot(truth[k][v], truth[k][v]);
    }
  return size > 0.0 ? std::sqrt(off / size) : 0.0;
}

double pressed(double time) {  // [1] of the load
  const double t = std::clamp(time / kRise, 0.0, 1.0);
  return t * t * (3 - 2 * t) - (time > kRise + kHold ? 1.0 : 0.0);
}

// The body pressed and let go in steps of T [s]: where its nodes are at each kEvery. `ms`: of a step.
std::vector<std::vector<dvec3>> motion(const Lattice& lattice, const SoftBody& body, const std::vector<dvec3>& load,
                                       Scheme scheme, double T, double* ms = nullptr) {
  Tissue tissue(lattice.tets, material_of(body, Strain::kCorotational), lattice.tets.free_count);
  const auto solver = make_solver(SolverKind::kBlockCholesky, tissue.inner().size);
  solver->analyse(tissue.inner());
  std::vector<dvec3> push = load;
  const TissueStep step{.scheme = scheme, .iterations = scheme == Scheme::kEuler ? 1 : 2, .push = &push};
  const double at = scheme == Scheme::kEuler ? 1.0 : 0.5;  // [1] of the step: when the load counts
  const auto steps = static_cast<int>(std::lround(kLast / T)), looked = static_cast<int>(std::lround(kEvery / T));
  std::vector<std::vector<dvec3>> out;
  const std::uint64_t begin = now_ns();
  for (int i = 0; i < steps; ++i) {
    for (std::size_t n = 0; n < push.size(); ++n) push[n] = pressed((i + at) * T) * load[n];
    if (!step_tissue(tissue, *solver, T, dvec3(0), step).solved) return {};
    if ((i + 1) % looked == 0) out.push_back(tissue.position());
  }
  if (ms) *ms = static_cast<double>(now_ns() - begin) * 1e-6 / steps;
  return out;
}

// [1] Of each of `steps`, on this lattice, where the tissue gives way most; and [ms] what a step took.
std::vector<std::pair<double, double>> step_errors(const Lattice& lattice, const SoftBody& body, const Patches& patches,
                                                   const std::vector<std::vector<dvec3>>& static_answers,
                                                   const std::vector<double>& steps) {
  double deepest = 0.0;
  std::uint32_t vertex = patches.vertices[0];
  for (std::size_t k = 0; k < static_answers.size(); ++k)
    for (const dvec3& u : static_answers[k])
      if (length(u) > deepest) deepest = length(u), vertex = patches.vertices[k];
  std::vector<dvec3> load = patch_load(patches, lattice.tets, vertex);
  for (dvec3& f : load) f *= kStrain * patches.radius / deepest;
  const auto truth = motion(lattice, body, load, Scheme::kMidpoint, kTruthStep);
  std::vector<std::pair<double, double>> out;
  for (const double T : steps) {
    double ms = 0.0, off = 0.0, size = 0.0;
    const auto trace = motion(lattice, body, load, Scheme::kEuler, T, &ms);
    for (std::size_t k = 0; k < std::min(trace.size(), truth.size()); ++k)
      for (std::uint32_t i = 0; i < lattice.tets.free_count; ++i) {
        const dvec3 d = trace[k][i] - truth[k][i], way = truth[k][i] - lattice.tets.nodes[i];
        off += dot(d, d);
        size += dot(way, way);
      }
    out.emplace_back(trace.size() == truth.size() && size > 0 ? std::sqrt(off / size) : 1e9, ms);
  }
  return out;
}

// How far apart two lattices are is not what either is off by: the finer one has an error of its own, a quarter of one
// of twice the cell (order 2). The difference is scaled to what is left to cells of no size.
double to_truth(double difference, double cell, double finest) {
  const double ratio = finest / cell;
  return difference / std::max(0.05, 1 - ratio * ratio);
}

std::string length_words(double metres) {
  return fmt::format("{:.3g} mm", 1e3 * metres);
}

}  // namespace

Result<ModelChoice> choose_body(Level& level, std::size_t index, double& step) {
  LevelNode& node = level.nodes[index];
  ModelChoice choice{node.name, "soft body", node.soft_body->error, {}, 0, false, {}, {}};
  Progress progress;
  const auto say = [&] { progress.say("choosing a model for `" + node.name + "`"); };
  Patches patches;
  const double own = node.soft_body->cell;
  auto usual = lattice(level, index, own, patches);
  if (!usual) return usual.error();
  const Mesh& surface = patches.surface;
  patches.radius = kDefaultReach * surface.box.diagonal();
  for (std::uint32_t k = 0; k < kPresses; ++k)
    patches.vertices.push_back(
        static_cast<std::uint32_t>((2 * std::uint64_t{k} + 1) * surface.vertex_count / (2 * kPresses)));

  for (const char* key : {"cell", "mesh", "solver"})
    if (states(node, "soft_body", key)) choice.kept.emplace_back(key);
  const bool from_file = !node.soft_body->mesh.empty(), cell_said = states(node, "soft_body", "cell");
  std::vector<std::pair<double, Lattice>> lattices;  // their error
  if (from_file) {
    lattices.emplace_back(0.0, std::move(*usual));
    choice.presses.push_back("its tetrahedra come from a file, whose own error was not measured");
  } else {
    say();
    const auto finest = lattice(level, index, kFinest * usual->cell, patches);
    if (!finest) return finest.error();
    const auto truth = answers(*finest, *node.soft_body, patches);
    if (!truth) return Error{node.name, "could not be pressed to measure an error; leave out `error`"};
    for (const double share : kCells) {
      say();
      if (cell_said && share != 1.0) continue;
      auto tried = lattice(level, index, share * usual->cell, patches);
      if (!tried) continue;  // too coarse for what is thin in it
      const auto answer = answers(*tried, *node.soft_body, patches);
      if (!answer) continue;
      const double error = to_truth(difference(*answer, *truth, surface), tried->cell, finest->cell);
      lattices.emplace_back(error, std::move(*tried));
    }
    if (lattices.empty()) return Error{node.name, "has no lattice whose error could be measured; leave out `error`"};
  }
  say();
  const Lattice& coarsest = lattices.front().second;
  const auto bent = answers(coarsest, *node.soft_body, patches);
  if (!bent) return Error{node.name, "could not be pressed to measure an error; leave out `error`"};
  std::vector<double> steps(kSteps.begin(), kSteps.end());
  if (states_step(level)) steps = {level.simulation.soft_step}, choice.kept.emplace_back("soft_step");
  const auto errors = step_errors(coarsest, *node.soft_body, patches, *bent, steps);

  struct What {
    double cell, step;
  };
  std::vector<std::pair<ModelCandidate, What>> tried;
  for (const auto& [lattice_error, its] : lattices)
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const std::string cell = from_file ? "file" : length_words(its.cell);
      ModelCandidate candidate;
      candidate.label =
          fmt::format("cell {} ({} tetrahedra), step {:.3g} ms", cell, its.tets.tets.size(), 1e3 * steps[i]);
      candidate.error = lattice_error + errors[i].first;
      candidate.cost = step_ms(its.tets.tets.size(), 1.0) / steps[i];
      candidate.ms = &its == &coarsest ? errors[i].second : 0.0;
      tried.push_back({candidate, {its.cell, steps[i]}});
    }
  std::stable_sort(tried.begin(), tried.end(),
                   [](const auto& a, const auto& b) { return a.first.cost < b.first.cost; });
  for (const auto& [candidate, what] : tried) choice.tried.push_back(candidate);
  choice.chosen = cheapest_within(choice.tried, choice.budget);
  choice.within = choice.tried[choice.chosen].error <= choice.budget;
  const What& taken = tried[choice.chosen].second;
  if (!from_file && !cell_said) node.soft_body->cell = taken.cell;
  step = std::min(step, taken.step);
  return choice;
}

}  // namespace pliant
