// Finds the boxes that overlap a given box: a balanced binary tree of boxes that may move (a probe among thousands of
// objects). The scheme is that of Box2D's dynamic tree (E. Catto). A leaf has a margin, so small moves cost nothing.
// Larger moves remove the leaf and reinsert it where it adds the least area, O(log N). Rejected: a sweep along one
// axis, since objects side by side on a table all overlap on two axes.
//
// Only build() allocates. The same calls in the same order give the same tree and the same order of visits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"

namespace pliant {

class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Box> boxes) { build(boxes); }

  // Rebuilds the tree; box i has id i from then on. An empty box overlaps nothing. O(N log N).
  void build(std::span<const Box> boxes);
  void move(std::uint32_t id, const Box& box);

  std::uint32_t size() const { return static_cast<std::uint32_t>(boxes_.size()); }
  const Box& box(std::uint32_t id) const { return boxes_[id]; }
  std::uint32_t height() const { return root_ == kNone ? 0 : nodes_[root_].height; }

  // Calls visit(id) once for every box that overlaps or touches `box`.
  template <class Visit>
  void visit(const Box& box, Visit visit) const {
    if (root_ == kNone) return;
    std::array<std::uint32_t, kStack> stack;
    std::uint32_t top = 0;
    stack[top++] = root_;
    while (top > 0) {
      const std::uint32_t at = stack[--top];
      const Node& node = nodes_[at];
      if (!meet(node.box, box)) continue;
      if (at < size()) {
        if (meet(boxes_[at], box)) visit(at);
        continue;
      }
      stack[top++] = node.child[1];
      stack[top++] = node.child[0];
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kStack = 64;  // the tree is balanced: height <= 1.44 log2 N

  // Nodes [0, N) are the leaves, indexed by id; the N - 1 inner nodes follow.
  struct Node {
    Box box;
    std::uint32_t parent = kNone;
    std::uint32_t child[2] = {kNone, kNone};
    std::uint32_t height = 0;  // 0: leaf
  };

  static bool meet(const Box& a, const Box& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y && a.min.z <= b.max.z &&
           b.min.z <= a.max.z;
  }
  std::uint32_t build_over(std::span<std::uint32_t> ids, std::uint32_t& next);
  void refit(std::uint32_t inner);
  void replace(std::uint32_t parent, std::uint32_t child, std::uint32_t by);
  std::uint32_t balance(std::uint32_t inner);
  void climb(std::uint32_t inner);
  std::uint32_t take_out(std::uint32_t leaf);
  void put_in(std::uint32_t leaf, std::uint32_t spare);

  std::vector<Box> boxes_;  // as given
  std::vector<Node> nodes_;
  std::uint32_t root_ = kNone;
};

}  // namespace pliant
