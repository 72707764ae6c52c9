// A body-centred cubic lattice over a box: the corners and centres of cubes of side `cell`. Positions are in doubled
// coordinates, half a cell apart: corners have three even ones, centres three odd ones. All tetrahedra are congruent:
// each joins the two centres beside a cube's face with one of its four edges; dihedral angles of 60 and 90 degrees.
//
// A lattice may be refined around a point. Its own coordinates q are uniform; a node at distance q from that point lies
// in space at r = q w, w = 1 + (g - 1) q^2 / (q^2 + a^2). Cells have size `cell` around the point and grow to g times
// that. In between they are at most 1.8 times as long as wide.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "components/math.h"

namespace pliant {

using Place = glm::ivec3;  // half cells from the lattice's origin

// Steps from a node to its edge neighbours: six long ones of a cell, eight short ones of sqrt(3)/2 cells. Step i and
// step 13 - i are opposite.
inline constexpr std::size_t kSteps = 14;
inline const std::array<Place, kSteps> kNeighbours{{{-2, 0, 0},
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

// Where a lattice is refined, and its orientation. The center is a cube corner.
struct LatticeFocus {
  dvec3 center{0};      // [m]
  double radius = 0.0;  // [m] a > 0
  dmat3 axes{1.0};      // [1] a rotation: the lattice's axes

  static constexpr double kGrowth = 6.0;  // [1] g
  // [1] Cell width relative to the middle, at q [m] from it in lattice coordinates.
  double width(double q) const { return 1.0 + (kGrowth - 1.0) * q * q / (q * q + radius * radius); }
  // [m] The distance from the center in lattice coordinates for a distance r [m] in space.
  double inward(double r) const {
    double low = r / kGrowth, high = r;
    for (int n = 0; n < kHalvings; ++n) {
      const double middle = 0.5 * (low + high);
      (middle * width(middle) < r ? low : high) = middle;
    }
    return high;
  }
  // [1] The same at a point in space.
  double width_at(dvec3 place) const { return width(inward(length(place - center))); }
  dvec3 outward(dvec3 q) const { return center + axes * (q * width(length(q))); }

 private:
  static constexpr int kHalvings = 52;
};

class LatticeGrid {
 public:
  // Covers the box with a margin of at least two cells, so that neighbours of neighbours exist. Without a focus it is
  // centred on the box.
  LatticeGrid(const Box& box, double cell, const std::optional<LatticeFocus>& focus = {}) : cell_(cell), focus_(focus) {
    const auto [low, high] = bounds(box, focus);
    for (int i = 0; i < 3; ++i) {
      if (focus) {
        const double first = std::floor(low[i] / cell) - 2;
        cubes_[i] = static_cast<int>(std::ceil(high[i] / cell) + 2 - first);
        origin_[i] = first * cell;
        continue;
      }
      cubes_[i] = static_cast<int>(std::ceil((high[i] - low[i]) / cell)) + 4;
      origin_[i] = 0.5 * (low[i] + high[i]) - 0.5 * cell * cubes_[i];
    }
  }
  // [1] Number of nodes for a box and a cell, before construction; a double because it may exceed any integer.
  static double node_count(const Box& box, double cell, const std::optional<LatticeFocus>& focus = {}) {
    const auto [low, high] = bounds(box, focus);
    double count = 2.0;
    for (int i = 0; i < 3; ++i) count *= std::ceil((high[i] - low[i]) / cell) + (focus ? 6.0 : 5.0);
    return count;
  }

  double cell() const { return cell_; }
  Place cubes() const { return cubes_; }
  std::uint32_t size() const { return 2u * static_cast<std::uint32_t>(rows() * (cubes_.z + 1)); }
  // A layer of corners and the centres above it are contiguous.
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
  dvec3 position(Place p) const {
    const dvec3 y = origin_ + 0.5 * cell_ * dvec3(p);
    return focus_ ? focus_->outward(y) : y;
  }

 private:
  // Bounds of the box in lattice coordinates. Along a face's axis no point of the face is farther away than the one
  // directly above the center.
  static std::array<dvec3, 2> bounds(const Box& box, const std::optional<LatticeFocus>& focus) {
    if (!focus) return {dvec3(box.min), dvec3(box.max)};
    dvec3 low(0), high(0);
    for (int corner = 0; corner < 8; ++corner) {
      const dvec3 at(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                     corner & 4 ? box.max.z : box.min.z);
      const dvec3 away = glm::transpose(focus->axes) * (at - focus->center);
      low = glm::min(low, away);
      high = glm::max(high, away);
    }
    for (int i = 0; i < 3; ++i) {
      low[i] = -focus->inward(-low[i]);
      high[i] = focus->inward(high[i]);
    }
    return {low, high};
  }
  int rows() const { return (cubes_.x + 1) * (cubes_.y + 1); }

  double cell_;  // [m]
  std::optional<LatticeFocus> focus_;
  dvec3 origin_{0};  // [m]
  Place cubes_{0};
};

}  // namespace pliant
