#include "player/fit/tissue_press.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "content/tets/tet_embed.h"

namespace pliant {
namespace {

constexpr double kForever = 1e6;  // [s] of a step in which inertia is nothing (systems/soft/fem/tissue_step.cpp)
constexpr int kMostTissueIterations = 80;  // of one press
constexpr double kRestTolerance = 1e-4;    // [1] of the load that may be left over
constexpr std::size_t kMemory = 6;         // iterates that Anderson's acceleration mixes
constexpr double kFinest = 6.0;            // samples over the indenter's radius
constexpr int kMostParts = 8;              // of a triangle's edge
constexpr std::size_t kMoments = 6;        // 1, x, y, x^2, xy, y^2
constexpr double kFlattestTissue = 1e-6;   // [1] of the largest eigenvalue
constexpr double kFacingShare = 0.3;       // [1] cosine: what is turned away is another side of the object

}  // namespace

PressPlace place_at(const Mesh& mesh, std::uint32_t triangle, dvec3 b) {
  const uvec3 t = mesh.triangles[triangle];
  PressPlace out{triangle, b, dvec3(0), dvec3(0)};
  for (int i = 0; i < 3; ++i) {
    out.position += b[i] * dvec3(mesh.position(t[i]));
    out.normal += b[i] * dvec3(mesh.normal(triangle, i));
  }
  out.normal = normalize(out.normal);
  return out;
}

Result<TissuePress> TissuePress::make(const TetMesh& tets, const Mesh& surface, const TissueMaterial& material) {
  if (tets.free_count == tets.node_count())
    return Error{"mesh `" + tets.name + "`", "is held nowhere, so that a press would push it away; say --pin SIDE"};
  TissuePress out;
  out.tets_ = &tets;
  out.embed_in(surface);
  out.tissue_ = std::make_unique<Tissue>(tets, material, tets.free_count);
  out.tissue_->assemble(kForever, dvec3(0));
  out.solver_ = make_solver(SolverKind::kBlockCholesky, out.tissue_->inner().size);
  out.solver_->analyse(out.tissue_->inner());
  out.solver_->place(out.tissue_->position());
  if (!out.solver_->factorise(out.tissue_->inner()))
    return Error{"mesh `" + tets.name + "`", "has tetrahedra whose stiffness cannot be solved for; try another --cell"};
  return out;
}

void TissuePress::embed_in(const Mesh& surface) {
  surface_ = &surface;
  embedding_ = embed(surface, tets_->nodes, tets_->tets);
}

TissuePress::Punch TissuePress::punch(const PressPlace& place, double radius) const {
  const Mesh& mesh = *surface_;
  const dvec3 side = std::abs(place.normal.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 ex = normalize(cross(side, place.normal)), ey = cross(place.normal, ex);
  const std::uint32_t moving = tissue_->moving();
  Punch out{Eigen::MatrixXd::Zero(3 * moving, kMoments), {}, {}, Vector::Zero(kMoments)};
  const auto put = [&](std::uint32_t vertex, const std::array<double, kMoments>& carried) {
    const Embedding& at = embedding_[vertex];
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t node = tets_->tets[at.tet][i];
      if (node >= moving) continue;
      for (int axis = 0; axis < 3; ++axis)
        for (std::size_t m = 0; m < kMoments; ++m)
          out.loads(3 * node + static_cast<std::uint32_t>(axis), static_cast<Eigen::Index>(m)) -=
              at.weight[i] * carried[m] * place.normal[axis];
    }
    for (std::size_t m = 0; m < kMoments; ++m) out.whole[static_cast<Eigen::Index>(m)] += carried[m];
  };
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const uvec3 t = mesh.triangles[k];
    const dvec3 p[3] = {dvec3(mesh.position(t[0])), dvec3(mesh.position(t[1])), dvec3(mesh.position(t[2]))};
    const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    if (k != place.triangle && length(p[0] - place.position) > radius + longest) continue;
    const dvec3 twice = cross(p[1] - p[0], p[2] - p[0]);
    if (k != place.triangle && dot(twice, place.normal) < kFacingShare * length(twice)) continue;
    const int parts = std::clamp(static_cast<int>(std::ceil(longest * kFinest / radius)), 1, kMostParts);
    const double area = length(twice) / (parts * parts * radius * radius);
    std::array<double, kMoments> share[3]{};
    for (int i = 0; i < parts; ++i)
      for (int j = 0; j < 2 * (parts - i) - 1; ++j) {  // the middles of the parts, upright and turned
        const double b1 = (i + (j % 2 ? 2.0 / 3.0 : 1.0 / 3.0)) / parts,
                     b2 = (j / 2 + (j % 2 ? 2.0 / 3.0 : 1.0 / 3.0)) / parts;
        const double b[3] = {1 - b1 - b2, b1, b2};
        const dvec3 away = (b[0] * p[0] + b[1] * p[1] + b[2] * p[2] - place.position) / radius;
        const double left = 1 - dot(away, away);
        if (!(left > 0)) continue;
        const double x = dot(away, ex), y = dot(away, ey), carried = area * std::sqrt(left);
        const std::array<double, kMoments> basis{1.0, x, y, x * x, x * y, y * y};
        for (int c = 0; c < 3; ++c)
          for (std::size_t m = 0; m < kMoments; ++m) share[c][m] += carried * b[c] * basis[m];
      }
    for (int c = 0; c < 3; ++c)
      if (share[c][0] > 0) put(t[c], share[c]);
  }
  Rows columns = out.loads * (kForever * kForever);  // the matrix is T^2 K
  solver_->solve_many(columns);
  out.yields = columns;
  const Eigen::MatrixXd gram = out.loads.transpose() * out.yields;
  // A patch of few elements does not tell all moments apart: those it cannot are left out.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (gram + gram.transpose()));
  const Vector& values = eigen.eigenvalues();
  Vector over = Vector::Zero(values.size());
  for (Eigen::Index m = 0; m < values.size(); ++m)
    if (values[m] > kFlattestTissue * values.maxCoeff()) over[m] = 1 / values[m];
  out.inverse = eigen.eigenvectors() * over.asDiagonal() * eigen.eigenvectors().transpose();
  return out;
}

dvec3 TissuePress::moved(std::uint32_t vertex, const Vector& u) const {
  dvec3 out(0);
  const Embedding& at = embedding_[vertex];
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t node = tets_->tets[at.tet][i];
    if (node < tissue_->moving()) out += at.weight[i] * dvec3(u[3 * node], u[3 * node + 1], u[3 * node + 2]);
  }
  return out;
}

std::vector<float> TissuePress::heights_of(const Vector& u) const {
  std::vector<float> out(surface_->vertex_count);
  for (std::uint32_t v = 0; v < surface_->vertex_count; ++v)
    out[v] = static_cast<float>(dot(moved(v, u), dvec3(surface_->normal(v))));
  return out;
}

double TissuePress::stiffness(const PressPlace& place, double radius) const {
  const Punch it = punch(place, radius);
  return it.whole.dot(it.inverse * it.whole);
}

double TissuePress::settle(const Punch& punch, double depth, Vector& u) {
  std::deque<Vector> iterates, steps;
  Vector step = Vector::Zero(u.size()), rest(u.size());
  for (int k = 0; k < kMostTissueIterations; ++k) {
    ++iterations_;
    for (std::uint32_t i = 0; i < tissue_->moving(); ++i)
      tissue_->position()[i] = tets_->nodes[i] + dvec3(u[3 * i], u[3 * i + 1], u[3 * i + 2]);
    tissue_->assemble(kForever, dvec3(0));
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

std::vector<PressedTissue> TissuePress::press_to(const PressPlace& place, double radius, double depth, int steps) {
  const Punch it = punch(place, radius);
  std::vector<PressedTissue> out;
  const Vector one = it.yields * (it.inverse * it.whole);  // moved by a small press, over its depth
  Vector u = Vector::Zero(one.size()), before = u;
  for (int i = 1; i <= steps; ++i) {
    const double wanted = depth * i / steps;
    Vector guess = out.empty() ? Vector(wanted * one) : Vector(2.0 * u - before);
    before = u;
    const double force = settle(it, wanted, guess);
    if (!(force > 0)) break;
    u = guess;
    out.push_back({force, wanted, heights_of(u)});
  }
  return out;
}

}  // namespace pliant
