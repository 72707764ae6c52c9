// A bounding volume tree over triangles with moving vertices: built once, refitted to every new set of positions. For a
// program's queries of a session (pliant/query.h): in double, with the same answer as brute force. Owner's thread;
// nothing here runs in a tick.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "components/math.h"

namespace pliant {

struct TrianglePlace {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t triangle = kNone;
  dvec3 weights{1, 0, 0};                                     // [1] barycentric
  double distance = std::numeric_limits<double>::infinity();  // [m]
  bool found() const { return triangle != kNone; }
};

class TriangleBoxes {
 public:
  // `members`: per triangle, whether it counts. All arguments are copied.
  TriangleBoxes(std::vector<dvec3> positions, std::vector<uvec3> triangles, const std::vector<std::uint8_t>& members);
  // Refits the tree to other positions of the same triangles.
  void fit(std::vector<dvec3> positions);

  // The nearest point within `within` [m].
  TrianglePlace closest(dvec3 x, double within) const;
  // The first triangle along the ray from `from` in the unit direction `way`, from either side; degenerate ones are
  // ignored.
  TrianglePlace first_along(dvec3 from, dvec3 way, double within) const;

  bool empty() const { return members_.empty(); }
  dvec3 low() const { return nodes_.front().low; }  // of all members; invalid if empty
  dvec3 high() const { return nodes_.front().high; }
  dvec3 corner(std::uint32_t triangle, int i) const { return positions_[triangles_[triangle][i]]; }
  const std::vector<uvec3>& triangles() const { return triangles_; }

 private:
  struct Node {
    dvec3 low{0}, high{0};
    std::uint32_t first = 0, count = 0;  // of members_; an inner node has count 0 and its children at first, first + 1
  };
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t count, const std::vector<dvec3>& middle);

  std::vector<dvec3> positions_;
  std::vector<uvec3> triangles_;
  std::vector<std::uint32_t> members_;
  std::vector<Node> nodes_;  // children after their parents
};

}  // namespace pliant
