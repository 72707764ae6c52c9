// A body-centred cubic lattice over a box: the corners and the centres of cubes of side `cell`. Places are in doubled
// coordinates, half a cell apart: corners have three even ones, centres three odd ones. Its tetrahedra are all alike:
// around each face of a cube, the two centres beside it and one of its four edges; dihedral angles of 60 and 90
// degrees.
#pragma once

#include <array>
#include <cstdint>

#include "components/math.h"

namespace pliant {

using Place = glm::ivec3;  // half cells from the lattice's origin

// Steps from a node to the nodes it shares an edge with: six long ones of a cell, eight short ones of sqrt(3)/2 cells.
// Step i and step 13 - i are opposite.
inline constexpr std::size_t kSteps = 14;
inline const std::array<Place, kSteps> kStep{{{-2, 0, 0},
                                              {0, -2, 0},
                                              {0, 0, -2},
                                              {-1, -1, -1},
                                              {-1, -1, 1},
                                              {-1, 1, -1},
                                              {-1, 1, 1},
                                              {1, -1, -1},
                                              {1, -1, 1},
                                              {1, 1, -1},
                                              {1, 1, 1},
                                              {0, 0, 2},
                                              {0, 2, 0},
                                              {2, 0, 0}}};
inline constexpr std::size_t opposite(std::size_t step) {
  return kSteps - 1 - step;
}
inline bool is_long(std::size_t step) {
  return step < 3 || step >= kSteps - 3;
}

class LatticeGrid {
 public:
  // Covers the box, centred on it, with at least two cells to spare on every side: neighbours of neighbours exist.
  LatticeGrid(const Box& box, double cell) : cell_(cell) {
    for (int i = 0; i < 3; ++i) {
      cubes_[i] = static_cast<int>(std::ceil(static_cast<double>(box.size()[i]) / cell)) + 4;
      origin_[i] = static_cast<double>(box.center()[i]) - 0.5 * cell * cubes_[i];
    }
  }
  // [1] for a box and a cell, before anything is built; a double, since it may be beyond any integer.
  static double node_count(const Box& box, double cell) {
    double count = 2.0;
    for (int i = 0; i < 3; ++i) count *= std::ceil(static_cast<double>(box.size()[i]) / cell) + 5.0;
    return count;
  }

  double cell() const { return cell_; }
  Place cubes() const { return cubes_; }
  std::uint32_t size() const { return 2u * static_cast<std::uint32_t>(rows() * (cubes_.z + 1)); }
  // Nodes of a layer of corners and the centres above it lie together.
  std::uint32_t layer_size() const { return 2u * static_cast<std::uint32_t>(rows()); }

  std::uint32_t index(Place p) const {
    const std::int32_t cube = ((p.z >> 1) * (cubes_.y + 1) + (p.y >> 1)) * (cubes_.x + 1) + (p.x >> 1);
    return 2u * static_cast<std::uint32_t>(cube) + static_cast<std::uint32_t>(p.x & 1);
  }
  Place place(std::uint32_t index) const {
    const auto cube = static_cast<int>(index / 2), centre = static_cast<int>(index % 2);
    const int row = cube / (cubes_.x + 1);
    return 2 * Place(cube % (cubes_.x + 1), row % (cubes_.y + 1), row / (cubes_.y + 1)) + centre;
  }
  dvec3 position(Place p) const { return origin_ + 0.5 * cell_ * dvec3(p); }

 private:
  int rows() const { return (cubes_.x + 1) * (cubes_.y + 1); }

  double cell_;      // [m]
  dvec3 origin_{0};  // [m]
  Place cubes_{0};
};

}  // namespace pliant
