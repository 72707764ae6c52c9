#include "lab/fit/tissue_press.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "content/tets/tet_embed.h"
#include "runtime/assert.h"

namespace pliant {
namespace {

constexpr double kForever = 1e6;           // [s] of a step with negligible inertia (systems/soft/fem/tissue_step.cpp)
constexpr int kMostTissueIterations = 80;  // per press
constexpr double kRestTolerance = 1e-4;    // [1] residual at equilibrium, relative to the load
constexpr std::size_t kMemory = 6;         // iterates in Anderson's acceleration
constexpr double kFinest = 6.0;            // samples per indenter radius
constexpr std::size_t kMoments = 6;        // 1, x, y, x^2, xy, y^2
constexpr double kFlattestTissue = 1e-6;   // [1] smallest eigenvalue, relative to the largest
constexpr double kSmallTolerance = 1e-6;   // [1] of the solution: the stiffness error of a small press is its square

std::vector<Embedding> embedding_of(const std::vector<PlacedSample>& samples, const TetMesh& tets) {
  std::vector<dvec3> points, normals;
  for (const PlacedSample& sample : samples) {
    points.push_back(sample.position);
    normals.push_back(sample.normal);
  }
  return embed(points, normals, tets.nodes, tets.tets);
}

}  // namespace

Result<TissuePress> TissuePress::make(TetMesh tets, const TissueMaterial& material, PressKind kind) {
  if (tets.free_count == tets.node_count())
    return Error{"mesh `" + tets.name + "`", "is held nowhere, so that a press would push it away", "say --pin SIDE"};
  TissuePress out;
  out.tets_ = std::make_unique<const TetMesh>(std::move(tets));
  out.tissue_ = std::make_unique<Tissue>(*out.tets_, material, out.tets_->free_count);
  out.tissue_->assemble(kForever, dvec3(0));
  if (!(kind == PressKind::kSmall ? out.take_iterative() : out.take_factor())) return out.unsolved();
  return out;
}

Error TissuePress::unsolved() const {
  return {"mesh `" + tets_->name + "`", "has tetrahedra whose stiffness cannot be solved for", "try another --cell"};
}

bool TissuePress::factorise() {
  solver_->analyse(tissue_->inner());
  solver_->place(tissue_->position());
  return solver_->factorise(tissue_->inner());
}

bool TissuePress::take_iterative() {
  auto solver = std::make_unique<ConjugateGradient>();
  solver->tolerance = kSmallTolerance;
  iterative_ = solver.get();
  solver_ = std::move(solver);
  return factorise();
}

bool TissuePress::take_factor() {
  iterative_ = nullptr;
  solver_ = make_solver(SolverKind::kBlockCholesky, tissue_->inner().size);
  return factorise();
}

Result<TissuePress::Punch> TissuePress::punch(const Mesh& surface, const PressPlace& place, double radius) {
  const dvec3 side = std::abs(place.normal.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 ex = normalize(cross(side, place.normal)), ey = cross(place.normal, ex);
  const std::uint32_t moving = tissue_->moving();
  Punch out{Eigen::MatrixXd::Zero(3 * moving, kMoments), {}, {}, Vector::Zero(kMoments)};
  const std::vector<PlacedSample> under = samples_around(surface, place, radius, radius / kFinest);
  const std::vector<Embedding> held = embedding_of(under, *tets_);
  for (std::size_t i = 0; i < under.size(); ++i) {
    const dvec3 away = (under[i].position - place.position) / radius;
    const double x = dot(away, ex), y = dot(away, ey),
                 carried = under[i].area / (radius * radius) * std::sqrt(std::max(0.0, 1 - dot(away, away)));
    const std::array<double, kMoments> basis{1.0, x, y, x * x, x * y, y * y};
    for (std::size_t m = 0; m < kMoments; ++m) out.whole[static_cast<Eigen::Index>(m)] += carried * basis[m];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t node = tets_->tets[held[i].tet][k];
      if (node >= moving) continue;
      for (int axis = 0; axis < 3; ++axis)
        for (std::size_t m = 0; m < kMoments; ++m)
          out.loads(3 * node + static_cast<std::uint32_t>(axis), static_cast<Eigen::Index>(m)) -=
              held[i].weight[k] * carried * basis[m] * place.normal[axis];
    }
  }
  const double scale = kForever * kForever;  // the matrix is T^2 K
  Rows columns = out.loads * scale;
  solver_->solve_many(columns);
  if (iterative_ && !iterative_->converged()) {
    if (!take_factor()) return unsolved();
    columns = out.loads * scale;
    solver_->solve_many(columns);
  }
  out.yields = columns;
  Eigen::MatrixXd gram = out.loads.transpose() * out.yields;
  if (iterative_) {
    // X^T W + W^T X - X^T K X: its error is quadratic in that of X.
    Eigen::MatrixXd product(out.yields.rows(), out.yields.cols());
    Vector x, y;
    for (Eigen::Index m = 0; m < product.cols(); ++m) {
      x = out.yields.col(m);
      tissue_->inner().multiply(x, y);
      product.col(m) = y / scale;
    }
    gram = (gram + gram.transpose() - out.yields.transpose() * product).eval();
  }
  // A patch of few elements cannot distinguish all moments: singular directions are left out.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (gram + gram.transpose()));
  const Vector& values = eigen.eigenvalues();
  Vector over = Vector::Zero(values.size());
  for (Eigen::Index m = 0; m < values.size(); ++m)
    if (values[m] > kFlattestTissue * values.maxCoeff()) over[m] = 1 / values[m];
  out.inverse = eigen.eigenvectors() * over.asDiagonal() * eigen.eigenvectors().transpose();
  return out;
}

double TissuePress::settle(const Punch& punch, double depth, Vector& u) {
  std::deque<Vector> iterates, steps;
  Vector step = Vector::Zero(u.size()), rest(u.size());
  for (int k = 0; k < kMostTissueIterations; ++k) {
    ++iterations_;
    for (std::uint32_t i = 0; i < tissue_->moving(); ++i)
      tissue_->position()[i] = tets_->nodes[i] + dvec3(u[3 * i], u[3 * i + 1], u[3 * i + 2]);
    tissue_->find_forces();
    rest = tissue_->elastic_force().head(u.size());
    solver_->solve(kForever * kForever * rest, step);
    const Vector pressure = punch.inverse * (depth * punch.whole - punch.loads.transpose() * (u + step));
    const Vector push = punch.loads * pressure;
    rest += push;
    if (!std::isfinite(pressure.norm())) return 0.0;
    const double force = punch.whole.dot(pressure);
    if (force > 0 && rest.norm() <= kRestTolerance * push.norm()) return force;
    step += punch.yields * pressure;
    iterates.push_back(u);
    steps.push_back(step);
    if (iterates.size() > kMemory) iterates.pop_front(), steps.pop_front();
    const auto count = static_cast<Eigen::Index>(iterates.size()) - 1;
    Vector next = u + step;
    if (count > 0) {
      Eigen::MatrixXd of_steps(u.size(), count);
      for (Eigen::Index j = 0; j < count; ++j)
        of_steps.col(j) = steps[static_cast<std::size_t>(j) + 1] - steps[static_cast<std::size_t>(j)];
      const Eigen::MatrixXd normal = of_steps.transpose() * of_steps;
      const Vector mix = normal.colPivHouseholderQr().solve(of_steps.transpose() * step);
      for (Eigen::Index j = 0; j < count; ++j)
        next -= mix[j] *
                (iterates[static_cast<std::size_t>(j) + 1] - iterates[static_cast<std::size_t>(j)] + of_steps.col(j));
    }
    u = next;
  }
  return 0.0;
}

std::vector<PressedTissue> TissuePress::press_to(const Punch& it, const std::vector<PlacedSample>& seen, double depth,
                                                 int steps) {
  ASSERT(!iterative_);
  const std::vector<Embedding> held = embedding_of(seen, *tets_);
  std::vector<PressedTissue> out;
  const Vector one = it.yields * (it.inverse * it.whole);  // displacement of a small press over its depth
  Vector u = Vector::Zero(one.size()), before = u;
  for (int i = 1; i <= steps; ++i) {
    const double wanted = depth * i / steps;
    Vector guess = out.empty() ? Vector(wanted * one) : Vector(2.0 * u - before);
    before = u;
    const double force = settle(it, wanted, guess);
    if (!(force > 0)) break;
    u = guess;
    PressedTissue& pressed = out.emplace_back(PressedTissue{force, wanted, {}});
    for (std::size_t k = 0; k < seen.size(); ++k) {
      double height = 0.0;
      for (std::size_t c = 0; c < 4; ++c) {
        const std::uint32_t node = tets_->tets[held[k].tet][c];
        if (node < tissue_->moving())
          height += held[k].weight[c] * dot(dvec3(u[3 * node], u[3 * node + 1], u[3 * node + 2]), seen[k].normal);
      }
      pressed.height.push_back(height);
    }
  }
  return out;
}

}  // namespace pliant
