#include "engine/choice/body_press.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "content/tets/tet_embed.h"
#include "content/tets/tet_order.h"
#include "runtime/clock.h"
#include "systems/soft/body/tissue_material.h"

namespace pliant {
namespace {

constexpr double kTruthStep = 1.0 / 480;                 // [s] of the midpoint rule
constexpr double kRise = 0.2, kHold = 0.1, kLast = 0.5;  // [s] of a press: rise, hold, total with release
constexpr int kLooks = 15;                               // equidistant moments of a press at which motions are compared
constexpr double kHeldShare = 0.15;                      // [1] of the height: pinned if nothing else is
constexpr double kStrain = 0.1;                          // [1] depth of the deepest dent over the patch's radius

// Pins the lowest part of a free body, so that a press has a static solution.
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

// [m] Displacement of each sample point from rest.
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

double pressed(double time) {  // [1] of the load
  const double t = std::clamp(time / kRise, 0.0, 1.0);
  return t * t * (3 - 2 * t) - (time > kRise + kHold ? 1.0 : 0.0);
}

// Node positions at each of kLooks moments while the body is pressed and released in steps of T [s], interpolated
// linearly within a step. Empty if a step cannot be solved. `ms`: per step.
std::vector<std::vector<dvec3>> motion(const Lattice& lattice, const SoftBody& body, const std::vector<dvec3>& load,
                                       Scheme scheme, double T, double* ms = nullptr) {
  Tissue tissue(lattice.tets, material_of(body, Strain::kCorotational), lattice.tets.free_count);
  const auto solver = make_solver(SolverKind::kBlockCholesky, tissue.inner().size);
  solver->analyse(tissue.inner());
  std::vector<dvec3> push = load, before = tissue.position();
  const TissueStep step{.scheme = scheme, .iterations = scheme == Scheme::kEuler ? 1 : 2, .push = &push};
  const double at = scheme == Scheme::kEuler ? 1.0 : 0.5;  // [1] of the step: time at which the load is evaluated
  std::vector<std::vector<dvec3>> out;
  const std::uint64_t begin = now_ns();
  int steps = 0;
  while (out.size() < kLooks) {
    for (std::size_t n = 0; n < push.size(); ++n) push[n] = pressed((steps + at) * T) * load[n];
    if (!step_tissue(tissue, *solver, T, dvec3(0), step).solved) return {};
    ++steps;
    for (; out.size() < kLooks;) {
      // [1] of this step, the next moment; rounding may put one at the step's end beyond it.
      const double share = static_cast<double>(out.size() + 1) * (kLast / kLooks) / T - (steps - 1);
      if (share > 1 + 1e-9) break;
      std::vector<dvec3>& look = out.emplace_back(tissue.position());
      for (std::size_t n = 0; n < look.size(); ++n) look[n] = before[n] + share * (look[n] - before[n]);
    }
    before = tissue.position();
  }
  if (ms) *ms = static_cast<double>(now_ns() - begin) * 1e-6 / steps;
  return out;
}

}  // namespace

Result<Lattice> make_lattice(Level& alone, std::size_t node, double cell, Patches& patches) {
  alone.nodes[node].soft_body->cell = cell;
  auto world = spawn_level(alone);
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
  TissueMaterial material = material_of(body);
  material.strain = strain;
  material.prony = {};
  return material;
}

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

std::optional<Answers> answers(const Lattice& lattice, const SoftBody& body, const Patches& patches) {
  constexpr double kForever = 1e4;  // [s] inertia is negligible against stiffness
  Tissue tissue(lattice.tets, material_of(body, Strain::kLinear), lattice.tets.free_count);
  tissue.assemble(kForever, dvec3(0));
  const auto solver = make_solver(SolverKind::kBlockCholesky, tissue.inner().size);
  solver->analyse(tissue.inner());
  if (!solver->factorise(tissue.inner())) return std::nullopt;
  Answers out;
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

double difference(const Answers& a, const Answers& truth, const Mesh& surface) {
  double off = 0.0, size = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k)
    for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
      const dvec3 d = a[k][v] - truth[k][v];
      off += surface.area[v] * dot(d, d);
      size += surface.area[v] * dot(truth[k][v], truth[k][v]);
    }
  return size > 0.0 ? std::sqrt(off / size) : 0.0;
}

std::pair<std::uint32_t, double> softest(const Answers& answers, const Patches& patches) {
  std::pair<std::uint32_t, double> out{patches.vertices[0], 0.0};
  for (std::size_t k = 0; k < answers.size(); ++k)
    for (const dvec3& u : answers[k])
      if (length(u) > out.second) out = {patches.vertices[k], length(u)};
  return out;
}

std::vector<StepFigures> step_errors(const Lattice& lattice, const SoftBody& body, const Patches& patches,
                                     const Answers& at_rest, const std::vector<double>& steps) {
  const auto [vertex, deepest] = softest(at_rest, patches);
  std::vector<dvec3> load = patch_load(patches, lattice.tets, vertex);
  for (dvec3& f : load) f *= kStrain * patches.radius / deepest;
  const auto truth = motion(lattice, body, load, Scheme::kMidpoint, kTruthStep);
  std::vector<StepFigures> out;
  if (truth.empty()) return out;
  for (const double T : steps) {
    double ms = 0.0, off = 0.0, size = 0.0;
    const auto trace = motion(lattice, body, load, Scheme::kEuler, std::max(T, kShortestStep), &ms);
    for (std::size_t k = 0; k < trace.size(); ++k)
      for (std::uint32_t i = 0; i < lattice.tets.free_count; ++i) {
        const dvec3 d = trace[k][i] - truth[k][i], way = truth[k][i] - lattice.tets.nodes[i];
        off += dot(d, d);
        size += dot(way, way);
      }
    if (size > 0.0 && std::isfinite(off)) out.push_back({T, std::sqrt(off / size), ms});
  }
  return out;
}

}  // namespace pliant
