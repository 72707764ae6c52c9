#include "systems/soft/body/equilibrium.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/soft/body/tissue_material.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

constexpr double kFirstStep = 0.05, kLongestStep = 1e4;  // [s]
constexpr double kShortestStep = 1e-5;                   // [s] shorter: the energy cannot be reduced any more
constexpr double kNewtonStep = 10.0;                     // [s] from here on inertia is negligible
constexpr int kMostSteps = 200, kMostInverse = 60;
constexpr double kAtRest = 1e-5;               // [1] of the size: convergence criterion on motion in a long step
constexpr double kStays = 5e-3;                // [1] of the size: largest motion of a valid shape when it is released
constexpr double kLeastVolume = 0.05;          // [1] of an element's: flatter elements have no unloaded shape
constexpr double kLeastCorrection = 1.0 / 64;  // [1] of a correction
constexpr double kEnergyRounding = 1e-12;      // [1] of energies

TissueMaterial static_tissue(const SoftBody& body) {
  TissueMaterial material = material_of(body);
  material.alpha = material.beta = 0.0;
  return material;
}

bool any_free(const TetMesh& tets) {
  return tets.free_count > 0 && tets.free_count < tets.node_count();
}

// [J] elastic energy and potential.
double energy_of(const Tissue& tissue, dvec3 gravity) {
  double potential = 0.0;
  for (std::size_t i = 0; i < tissue.moving(); ++i) potential -= tissue.mass()[i] * dot(gravity, tissue.position()[i]);
  return tissue.elastic_energy() + potential;
}

double farthest_apart(const std::vector<dvec3>& a, const std::vector<dvec3>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, length(a[i] - b[i]));
  return most;
}

double volume_of(const std::vector<dvec3>& x, const Tet& t) {
  return dot(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]);
}

std::unique_ptr<LinearSolver> solver_for(const Tissue& tissue, std::uint32_t moving) {
  std::unique_ptr<LinearSolver> solver = solver_of(tissue, make_solver(SolverKind::kAuto, moving));
  solver->analyse(tissue.inner());
  return solver;
}

// Result of one step of T from rest; empty if it has no solution.
std::vector<dvec3> step_from_rest(Tissue& tissue, LinearSolver& solver, double T, dvec3 gravity) {
  const std::vector<dvec3> begin = tissue.position();
  std::fill(tissue.velocity().begin(), tissue.velocity().end(), dvec3(0));
  const bool solved = step_tissue(tissue, solver, T, gravity).solved;
  std::vector<dvec3> end = tissue.position();
  tissue.position() = begin;
  std::fill(tissue.velocity().begin(), tissue.velocity().end(), dvec3(0));
  const bool finite = std::all_of(end.begin(), end.end(), [](dvec3 x) { return std::isfinite(dot(x, x)); });
  if (!solved || !finite) end.clear();
  return end;
}

std::string millimetres(double metres) {
  return fmt::format("{:.3g} mm", metres * 1e3);
}

}  // namespace

double size_of(const std::vector<dvec3>& nodes) {
  dvec3 least(std::numeric_limits<double>::max()), most(std::numeric_limits<double>::lowest());
  for (const dvec3 x : nodes) least = glm::min(least, x), most = glm::max(most, x);
  return nodes.empty() ? 0.0 : length(most - least);
}

double turn_between(const std::vector<dvec3>& from, const std::vector<dvec3>& to) {
  dvec3 a(0), b(0);
  for (std::size_t i = 0; i < from.size(); ++i) a += from[i], b += to[i];
  a /= std::max<double>(1.0, static_cast<double>(from.size()));
  b /= std::max<double>(1.0, static_cast<double>(from.size()));
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const dvec3 p = from[i] - a, q = to[i] - b;
    sum += Eigen::Vector3d(q.x, q.y, q.z) * Eigen::Vector3d(p.x, p.y, p.z).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * flip * svd.matrixV().transpose();
  return std::acos(std::clamp(0.5 * (rotation.trace() - 1.0), -1.0, 1.0));
}

Equilibrium find_equilibrium(const TetMesh& tets, const SoftBody& body, dvec3 gravity, const std::vector<dvec3>* begin,
                             const std::stop_token& stop) {
  Equilibrium out;
  out.size = size_of(tets.nodes);
  out.held = any_free(tets);
  if (!out.held) return out;
  Tissue tissue(tets, static_tissue(body), tets.free_count);
  tissue.keep_relaxed(true);
  tissue.position() = begin ? *begin : tets.nodes;
  const std::vector<dvec3> from = tissue.position();
  const auto solver = solver_for(tissue, tets.free_count);
  double T = kFirstStep, energy = energy_of(tissue, gravity);
  for (int i = 0; i < kMostSteps && T > kShortestStep && !stop.stop_requested(); ++i) {
    std::vector<dvec3> next = step_from_rest(tissue, *solver, T, gravity);
    if (next.empty()) {
      T /= 4.0;
      continue;
    }
    const double moved = farthest_apart(tissue.position(), next);
    std::swap(tissue.position(), next);
    const double now = energy_of(tissue, gravity);
    if (now > energy + kEnergyRounding * std::abs(energy) && moved > kAtRest * out.size) {
      std::swap(tissue.position(), next);
      T /= 4.0;
      continue;
    }
    energy = now;
    if (T >= kNewtonStep && moved < kAtRest * out.size) {
      out.converged = true;
      break;
    }
    T = std::min(2.0 * T, kLongestStep);
  }
  out.nodes = tissue.position();
  out.most = farthest_apart(from, out.nodes);
  out.turned = turn_between(from, out.nodes);
  return out;
}

// x: the given shape. With X a guess of the unloaded shape, a Newton step at x gives the sag from X; X is moved back by
// the excess.
Unloaded find_unloaded(const TetMesh& tets, const SoftBody& body, dvec3 gravity, const std::stop_token& stop) {
  Unloaded out;
  if (!any_free(tets)) return out;
  const double size = size_of(tets.nodes);
  TetMesh guess;
  guess.nodes = tets.nodes;
  guess.tets = tets.tets;
  guess.cells = tets.cells;
  guess.volume = tets.volume;
  guess.factors = tets.factors;
  guess.cavities = tets.cavities;
  guess.free_count = tets.free_count;
  guess.handle_count = tets.handle_count;
  std::vector<dvec3> way(tets.nodes.size(), dvec3(0));
  double share = 1.0, before = std::numeric_limits<double>::max();
  std::vector<dvec3> last = guess.nodes;
  bool there = false;
  for (int i = 0; i < kMostInverse && !there && share >= kLeastCorrection && !stop.stop_requested(); ++i) {
    bool shaped = true;
    for (const Tet& tet : guess.tets)
      shaped = shaped && volume_of(guess.nodes, tet) > kLeastVolume * volume_of(tets.nodes, tet);
    double off = std::numeric_limits<double>::max();
    std::vector<dvec3> sagged;
    if (shaped) {
      Tissue tissue(guess, static_tissue(body), guess.free_count);
      tissue.keep_relaxed(true);
      tissue.position() = tets.nodes;
      const auto solver = solver_for(tissue, guess.free_count);
      sagged = step_from_rest(tissue, *solver, kLongestStep, gravity);
      if (!sagged.empty()) off = farthest_apart(tets.nodes, sagged);
    }
    there = off < kAtRest * size;
    if (there) break;
    if (!(off < 1.5 * before)) {  // too far: half of the last correction
      share *= 0.5;
      for (std::size_t n = 0; n < way.size(); ++n) guess.nodes[n] = last[n] - share * way[n];
      continue;
    }
    before = off;
    share = std::min(1.0, 1.5 * share);
    last = guess.nodes;
    for (std::size_t n = 0; n < way.size(); ++n) {
      way[n] = sagged[n] - tets.nodes[n];
      guess.nodes[n] = last[n] - share * way[n];
    }
  }
  if (!there) return out;
  const Equilibrium rest = find_equilibrium(guess, body, gravity, &tets.nodes, stop);
  if (!rest.converged || rest.most > kStays * size) return out;
  out.found = true;
  out.most = farthest_apart(tets.nodes, guess.nodes);
  out.nodes = std::move(guess.nodes);
  return out;
}

std::optional<Note> sag_doubt(const SoftBody& body, const Equilibrium& now, const Unloaded* unloaded) {
  if (!now.held) return {};
  const std::string cure = "pin more of it, where it hangs or stands, or give it a higher `young`";
  const auto doubt = [](std::string what, std::string how) {
    return Note{std::move(what), std::move(how), "tissue.gravity", {}};
  };
  if (body.under_gravity == UnderGravity::kModelled) {
    if (!unloaded || unloaded->found) return {};
    return doubt(
        "cannot keep its shape under gravity (`under_gravity` `modelled`): tissue so soft does not hold it on what is "
        "pinned",
        cure);
  }
  if (now.turned > kMuchTurn)
    return doubt(fmt::format("turns over under gravity, by {:.0f} degrees: what is pinned does not hold it",
                             now.turned * 180.0 / 3.14159265358979),
                 cure);
  if (!now.converged)
    return doubt(fmt::format("finds no rest under gravity, and has sagged {} when it is looked for no longer",
                             millimetres(now.most)),
                 cure);
  if (now.most > kMuchSag * now.size)
    return doubt(fmt::format("sags {} under gravity, {:.0f} % of its size: what is pinned holds too little of it",
                             millimetres(now.most), 100.0 * now.most / now.size),
                 cure + ", or let it keep its shape (`under_gravity` `modelled`)");
  return {};
}

}  // namespace pliant
