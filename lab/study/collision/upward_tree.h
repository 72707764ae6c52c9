// P1's search for the nearest vertex: an octree whose leaves are the vertices, searched upwards from the leaf of the
// last answer, because a probe moves little in a tick.
#pragma once

#include <cstdint>
#include <vector>

#include "components/mesh.h"

namespace pliant {

class UpwardTree {
 public:
  explicit UpwardTree(const Mesh& mesh);
  struct Answer {
    std::uint32_t vertex = 0;
    double distance2 = 0;  // [m2]
  };
  // From the leaf of vertex `last`. As printed: the least distance below the first cell that contains x. A nearer
  // vertex beyond that cell is missed.
  Answer as_printed(dvec3 x, std::uint32_t last) const;
  // Upwards until the ball of the least distance so far is inside the cell.
  Answer repaired(dvec3 x, std::uint32_t last) const;

 private:
  struct Node {
    dvec3 center{0};
    double half = 0;             // [m] of the cell's edge
    std::uint32_t parent = 0;    // the root's is itself
    std::uint32_t first = 0;     // child, or vertex of a leaf
    std::uint32_t last = 0;      // one past its children; 0: a leaf
    std::uint32_t vertices = 0;  // of a leaf: in order_ from `first` on; more than one only where they coincide
  };
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end, int depth);
  void down(std::uint32_t node, dvec3 x, Answer& best) const;
  dvec3 at(std::uint32_t v) const { return dvec3(mesh_.position(v)); }

  const Mesh& mesh_;
  std::vector<Node> nodes_;  // children of a node are adjacent
  std::vector<std::uint32_t> order_, leaf_;
};

}  // namespace pliant
