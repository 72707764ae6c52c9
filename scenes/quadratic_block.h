// The slower twin of tissue: a block of quadratic tetrahedra (ten nodes, four Gauss points) between two bonded plates,
// with the elastic laws and their exact tangent, by Newton in small steps of the load.
#pragma once

#include <Eigen/Sparse>
#include <array>
#include <functional>
#include <map>
#include <optional>

#include "scenes/tet_shapes.h"
#include "systems/soft/fem/law/elastic_law.h"

namespace pliant {

class QuadraticBlock {
 public:
  // A cube of [m] `size` in n^3 cells, its faces x = 0 and x = size bonded to plates.
  QuadraticBlock(int n, double size, ElasticLaw law, const LawConstants& material)
      : QuadraticBlock({n, n, n}, dvec3(size), law, material) {}
  // A bar with so many cells along each axis.
  QuadraticBlock(std::array<int, 3> cells, dvec3 size, ElasticLaw law, const LawConstants& material)
      : law_(law), material_(material), size_(size.x) {
    const TetMesh mesh = tets::box(cells[0], cells[1], cells[2], dvec3(0), size);
    rest_ = mesh.nodes;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    for (const Tet& t : mesh.tets) {
      std::array<std::uint32_t, 10> nodes{t[0], t[1], t[2], t[3]};
      for (std::size_t e = 0; e < 6; ++e) {
        const auto [a, b] = std::minmax(t[kEdge[e][0]], t[kEdge[e][1]]);
        const auto [it, is_new] = middle.try_emplace({a, b}, static_cast<std::uint32_t>(rest_.size()));
        if (is_new) rest_.push_back(0.5 * (rest_[a] + rest_[b]));
        nodes[4 + e] = it->second;
      }
      elements_.push_back(nodes);
    }
    for (const dvec3 p : rest_) row_.push_back(p.x > 1e-9 && p.x < size_ - 1e-9 ? free_++ : -1);
    x_ = rest_;
  }

  struct Load {
    dvec3 force{0}, torque{0};  // [N], [N m] on the far plate, the latter about the origin
  };
  // The far plate is moved by `way` from rest; empty if Newton fails.
  std::optional<dvec3> press(dvec3 way) {
    const std::optional<Load> load = carry([&](dvec3 p, double share) { return p + share * way; });
    if (!load) return std::nullopt;
    return load->force;
  }
  // The same by any motion: place(rest, share) of the plate's points, share [1] from 0 to 1. Steps are halved where
  // Newton fails.
  std::optional<Load> carry(const std::function<dvec3(dvec3, double)>& place, int steps = 4) {
    x_ = rest_;
    double done = 0.0, step = 1.0 / steps;
    while (done < 1.0 - 1e-9) {
      const std::vector<dvec3> before = x_;
      step = std::min(step, 1.0 - done);
      for (std::size_t k = 0; k < x_.size(); ++k)
        x_[k] += rest_[k].x / size_ * (place(rest_[k], done + step) - place(rest_[k], done));
      if (settle()) {
        done += step;
        continue;
      }
      x_ = before, step *= 0.5;
      if (step < 1e-3) return std::nullopt;
    }
    Load on;
    for (std::size_t k = 0; k < x_.size(); ++k)
      if (rest_[k].x > size_ - 1e-9) on.force -= force_[k], on.torque -= cross(x_[k], force_[k]);
    return on;
  }

 private:
  static constexpr std::size_t kEdge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

  bool settle() {
    for (int i = 0; i < 12; ++i) {
      const Eigen::VectorXd f = assemble();
      double size = 0.0;
      for (const dvec3 g : force_) size = std::max(size, length(g));
      if (f.lpNorm<Eigen::Infinity>() < 1e-9 * size) return true;
      if (i == 0) solver_.analyzePattern(K_);
      solver_.factorize(K_);
      if (solver_.info() != Eigen::Success) return false;
      const Eigen::VectorXd u = solver_.solve(f);
      for (std::size_t k = 0; k < x_.size(); ++k)
        if (row_[k] >= 0) x_[k] += dvec3(u[3 * row_[k]], u[3 * row_[k] + 1], u[3 * row_[k] + 2]);
    }
    return false;
  }

  Eigen::VectorXd assemble() {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * free_);
    force_.assign(x_.size(), dvec3(0));
    for (const auto& nodes : elements_) {
      tangent_.fill(dmat3(0));
      const dvec3 u = rest_[nodes[1]] - rest_[nodes[0]], v = rest_[nodes[2]] - rest_[nodes[0]],
                  w = rest_[nodes[3]] - rest_[nodes[0]];
      const double six = dot(cross(u, v), w);
      dvec3 b[4] = {dvec3(0), cross(v, w) / six, cross(w, u) / six, cross(u, v) / six};
      b[0] = -(b[1] + b[2] + b[3]);
      for (std::size_t q = 0; q < 4; ++q) {
        double l[4];
        for (std::size_t i = 0; i < 4; ++i) l[i] = i == q ? 0.5854101966249685 : 0.1381966011250105;
        dvec3 g[10];
        for (std::size_t i = 0; i < 4; ++i) g[i] = (4 * l[i] - 1) * b[i];
        for (std::size_t e = 0; e < 6; ++e)
          g[4 + e] = 4.0 * (l[kEdge[e][0]] * b[kEdge[e][1]] + l[kEdge[e][1]] * b[kEdge[e][0]]);
        add(nodes, g, std::abs(six) / 24, right);
      }
      add_tangent(nodes, entries);
    }
    K_.resize(3 * free_, 3 * free_);
    K_.setFromTriplets(entries.begin(), entries.end());
    return right;
  }

  void add(const std::array<std::uint32_t, 10>& nodes, const dvec3 (&g)[10], double volume, Eigen::VectorXd& right) {
    dmat3 F(0);
    for (std::size_t i = 0; i < 10; ++i) F += outerProduct(x_[nodes[i]], g[i]);
    const dmat3 C(cross(F[1], F[2]), cross(F[2], F[0]), cross(F[0], F[1]));
    const Density psi = law_(material_, dot(F[0], F[0]) + dot(F[1], F[1]) + dot(F[2], F[2]), dot(F[0], C[0]));
    for (std::size_t i = 0; i < 10; ++i) {
      const dvec3 Fi = F * g[i], Ci = C * g[i], f = -volume * (2 * psi.I * Fi + psi.J * Ci);
      force_[nodes[i]] += f;
      const int row = row_[nodes[i]];
      if (row < 0) continue;
      for (int k = 0; k < 3; ++k) right[3 * row + k] += f[k];
      for (std::size_t j = 0; j < 10; ++j) {
        if (row_[nodes[j]] > row) continue;  // the lower half, which the solver reads
        const dvec3 Fj = F * g[j], Cj = C * g[j], c = -psi.J * (F * cross(g[i], g[j]));
        dmat3 K = dmat3(2 * psi.I * dot(g[i], g[j])) + 4 * psi.II * outerProduct(Fi, Fj) +
                  2 * psi.IJ * (outerProduct(Fi, Cj) + outerProduct(Ci, Fj)) + psi.JJ * outerProduct(Ci, Cj);
        K += dmat3(0, c.z, -c.y, -c.z, 0, c.x, c.y, -c.x, 0);  // [c]x, by columns
        tangent_[10 * i + j] += volume * K;
      }
    }
  }
  void add_tangent(const std::array<std::uint32_t, 10>& nodes, std::vector<Eigen::Triplet<double>>& entries) const {
    for (std::size_t i = 0; i < 10; ++i)
      for (std::size_t j = 0; j < 10; ++j) {
        const int row = row_[nodes[i]], column = row_[nodes[j]];
        if (column < 0 || column > row) continue;
        for (int r = 0; r < 3; ++r)
          for (int s = 0; s < 3; ++s) entries.emplace_back(3 * row + r, 3 * column + s, tangent_[10 * i + j][s][r]);
      }
  }

  ElasticLaw law_;
  LawConstants material_;
  double size_;
  std::vector<dvec3> rest_, x_, force_;
  std::vector<std::array<std::uint32_t, 10>> elements_;
  std::vector<int> row_;
  int free_ = 0;
  std::array<dmat3, 100> tangent_;  // of an element, by pairs of its nodes
  Eigen::SparseMatrix<double> K_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace pliant
