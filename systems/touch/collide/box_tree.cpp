#include "systems/touch/collide/box_tree.h"

#include <algorithm>

namespace pliant {
namespace {

// Margin of a leaf's box on every side, as a share of its diagonal. More: fewer reinsertions, more boxes visited.
constexpr float kRoom = 0.1f;

Box roomy(const Box& box) {
  if (box.empty()) return box;
  const vec3 room(kRoom * box.diagonal());
  return {box.min - room, box.max + room};
}

bool holds(const Box& outer, const Box& inner) {
  return glm::all(glm::lessThanEqual(outer.min, inner.min)) && glm::all(glm::lessThanEqual(inner.max, outer.max));
}

float half_area(const Box& box) {
  if (box.empty()) return 0.0f;
  const vec3 s = box.size();
  return s.x * s.y + s.y * s.z + s.z * s.x;
}

float half_area(Box a, const Box& b) {
  a.add(b);
  return half_area(a);
}

}  // namespace

void BoxTree::build(std::span<const Box> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  nodes_.assign(boxes.empty() ? 0 : 2 * boxes.size() - 1, {});
  root_ = kNone;
  if (boxes.empty()) return;
  std::vector<std::uint32_t> ids(boxes.size());
  for (std::uint32_t i = 0; i < size(); ++i) {
    ids[i] = i;
    nodes_[i].box = roomy(boxes[i]);
  }
  std::uint32_t next = size();
  root_ = build_over(ids, next);
}

// Splits the boxes into halves by their centres along the axis of largest spread.
std::uint32_t BoxTree::build_over(std::span<std::uint32_t> ids, std::uint32_t& next) {
  if (ids.size() == 1) return ids[0];
  Box centers;
  for (const std::uint32_t id : ids) centers.add(boxes_[id].center());
  const vec3 spread = centers.size();
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
  const std::size_t half = ids.size() / 2;
  std::nth_element(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(half), ids.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float ca = boxes_[a].center()[axis], cb = boxes_[b].center()[axis];
                     return ca < cb || (ca == cb && a < b);
                   });
  const std::uint32_t inner = next++;
  const std::uint32_t left = build_over(ids.first(half), next), right = build_over(ids.subspan(half), next);
  nodes_[inner].child[0] = left;
  nodes_[inner].child[1] = right;
  nodes_[left].parent = nodes_[right].parent = inner;
  refit(inner);
  return inner;
}

void BoxTree::refit(std::uint32_t inner) {
  Node& node = nodes_[inner];
  const Node &a = nodes_[node.child[0]], &b = nodes_[node.child[1]];
  node.box = a.box;
  node.box.add(b.box);
  node.height = 1 + std::max(a.height, b.height);
}

void BoxTree::replace(std::uint32_t parent, std::uint32_t child, std::uint32_t by) {
  nodes_[by].parent = parent;
  if (parent == kNone)
    root_ = by;
  else
    nodes_[parent].child[nodes_[parent].child[1] == child] = by;
}

// AVL rotation: a child that is higher by two or more takes the place of its parent, which gets the child's lower
// child. Repeated until the heights are balanced here and below. Returns the node that is here afterwards.
std::uint32_t BoxTree::balance(std::uint32_t inner) {
  for (;;) {
    refit(inner);
    const std::uint32_t heights[2] = {nodes_[nodes_[inner].child[0]].height, nodes_[nodes_[inner].child[1]].height};
    const int side = heights[1] > heights[0];
    if (heights[side] <= heights[1 - side] + 1) return inner;
    const std::uint32_t up = nodes_[inner].child[side];
    const int lower = nodes_[nodes_[up].child[1]].height < nodes_[nodes_[up].child[0]].height;
    const std::uint32_t given = nodes_[up].child[lower];
    replace(nodes_[inner].parent, inner, up);
    nodes_[up].child[lower] = inner;
    nodes_[inner].parent = up;
    nodes_[inner].child[side] = given;
    nodes_[given].parent = inner;
    balance(inner);  // a leaf that joined a high tree is passed down
    inner = up;
  }
}

void BoxTree::climb(std::uint32_t inner) {
  while (inner != kNone) inner = nodes_[balance(inner)].parent;
}

// Removes a leaf and its parent; returns the parent, which is then unused.
std::uint32_t BoxTree::take_out(std::uint32_t leaf) {
  const std::uint32_t parent = nodes_[leaf].parent;
  const std::uint32_t sibling = nodes_[parent].child[nodes_[parent].child[0] == leaf];
  const std::uint32_t above = nodes_[parent].parent;
  replace(above, parent, sibling);
  climb(above);
  return parent;
}

// Descends to the node where the leaf adds the least area, ancestors included, and joins it there with `spare` as
// parent.
void BoxTree::put_in(std::uint32_t leaf, std::uint32_t spare) {
  const Box& box = nodes_[leaf].box;
  std::uint32_t at = root_;
  while (at >= size()) {
    const Node& node = nodes_[at];
    const float joined = half_area(node.box, box), here = 2 * joined, above = 2 * (joined - half_area(node.box));
    float cost[2];
    for (int i = 0; i < 2; ++i) {
      const Node& child = nodes_[node.child[i]];
      cost[i] = above + half_area(child.box, box) - (child.height > 0 ? half_area(child.box) : 0.0f);
    }
    if (here < cost[0] && here < cost[1]) break;
    at = node.child[cost[1] < cost[0]];
  }
  replace(nodes_[at].parent, at, spare);
  nodes_[spare].child[0] = at;
  nodes_[spare].child[1] = leaf;
  nodes_[at].parent = nodes_[leaf].parent = spare;
  climb(spare);
}

void BoxTree::move(std::uint32_t id, const Box& box) {
  boxes_[id] = box;
  Node& leaf = nodes_[id];
  const Box wanted = roomy(box);
  // A box that shrinks a lot is also reinserted: its margin would cause needless visits.
  if (holds(leaf.box, box) && half_area(leaf.box) <= 4 * half_area(wanted)) return;
  if (id == root_) {
    leaf.box = wanted;
    return;
  }
  const std::uint32_t spare = take_out(id);
  leaf.box = wanted;
  put_in(id, spare);
}

}  // namespace pliant
