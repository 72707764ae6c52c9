// Random systems with the patterns of tetrahedral meshes.
#pragma once

#include <random>

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

using Groups = std::vector<std::array<std::uint32_t, 4>>;

// A brick of n^3 nodes, a path of tetrahedra through each cell (Kuhn's six).
inline Groups brick(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
  const auto node = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return (i * ny + j) * nz + k; };
  Groups out;
  const std::array<std::array<int, 3>, 6> paths{{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (std::uint32_t i = 0; i + 1 < nx; ++i)
    for (std::uint32_t j = 0; j + 1 < ny; ++j)
      for (std::uint32_t k = 0; k + 1 < nz; ++k)
        for (const auto& path : paths) {
          std::array<std::uint32_t, 3> at{i, j, k};
          std::array<std::uint32_t, 4> tet{node(i, j, k), 0, 0, 0};
          for (std::size_t s = 0; s < 3; ++s) {
            ++at[static_cast<std::size_t>(path[s])];
            tet[s + 1] = node(at[0], at[1], at[2]);
          }
          out.push_back(tet);
        }
  return out;
}

// Adds G^T G for a random G of each group, like a stiff element, and a mass: symmetric positive definite.
inline BlockMatrix random_spd(std::uint32_t size, const Groups& groups, double mass, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  BlockMatrix a = make_pattern(size, groups);
  for (const auto& group : groups) {
    const Eigen::Matrix<double, 6, 12> G = Eigen::Matrix<double, 6, 12>::NullaryExpr([&] { return uniform(random); });
    const Eigen::Matrix<double, 12, 12> K = G.transpose() * G;
    for (std::uint32_t i = 0; i < 4; ++i)
      for (std::uint32_t j = 0; j < 4; ++j)
        if (group[i] < size && group[j] < size) a.value[a.find(group[i], group[j])] += K.block<3, 3>(3 * i, 3 * j);
  }
  for (const std::uint32_t k : a.diagonal) a.value[k] += mass * Block::Identity();
  return a;
}

inline Vector random_right_side(std::uint32_t block_rows, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Vector::NullaryExpr(3 * block_rows, [&] { return uniform(random); });
}

}  // namespace pliant
