#include "lab/study/collision/upward_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace pliant {
namespace {

constexpr int kDeepest = 24;

// [m2] From a point to a cell.
double outside2(dvec3 x, dvec3 center, double half) {
  const dvec3 d = glm::max(glm::abs(x - center) - half, dvec3(0));
  return dot(d, d);
}

}  // namespace

UpwardTree::UpwardTree(const Mesh& mesh) : mesh_(mesh), leaf_(mesh.vertex_count) {
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) order_.push_back(v);
  const dvec3 low(mesh.box.min), high(mesh.box.max), size = high - low;
  nodes_.push_back({0.5 * (low + high), 0.5001 * std::max({size.x, size.y, size.z}), 0, 0, 0, 0});
  split(0, 0, mesh.vertex_count, 0);
}

void UpwardTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end, int depth) {
  if (end - begin == 1 || depth == kDeepest) {
    nodes_[node].first = begin;
    nodes_[node].vertices = end - begin;
    for (std::uint32_t i = begin; i < end; ++i) leaf_[order_[i]] = node;
    return;
  }
  const dvec3 center = nodes_[node].center;
  const auto octant = [&](std::uint32_t v) {
    const dvec3 x = at(v);
    return (x.x > center.x ? 1 : 0) | (x.y > center.y ? 2 : 0) | (x.z > center.z ? 4 : 0);
  };
  std::array<std::uint32_t, 9> bound;
  bound[0] = begin;
  for (int o = 0; o < 8; ++o) {
    const auto middle = std::partition(order_.begin() + bound[static_cast<std::size_t>(o)], order_.begin() + end,
                                       [&](std::uint32_t v) { return octant(v) == o; });
    bound[static_cast<std::size_t>(o) + 1] = static_cast<std::uint32_t>(middle - order_.begin());
  }
  const double half = 0.5 * nodes_[node].half;
  nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
  for (std::size_t o = 0; o < 8; ++o)
    if (bound[o] < bound[o + 1])
      nodes_.push_back({center + half * dvec3(o & 1 ? 1 : -1, o & 2 ? 1 : -1, o & 4 ? 1 : -1), half, node, 0, 0, 0});
  nodes_[node].last = static_cast<std::uint32_t>(nodes_.size());
  std::uint32_t child = nodes_[node].first;
  for (std::size_t o = 0; o < 8; ++o)
    if (bound[o] < bound[o + 1]) split(child++, bound[o], bound[o + 1], depth + 1);
}

// Nearer cells first.
void UpwardTree::down(std::uint32_t node, dvec3 x, Answer& best) const {
  const Node& n = nodes_[node];
  for (std::uint32_t i = n.first; n.last == 0 && i < n.first + n.vertices; ++i) {
    const dvec3 d = at(order_[i]) - x;
    if (dot(d, d) < best.distance2) best = {order_[i], dot(d, d)};
  }
  std::array<std::pair<double, std::uint32_t>, 8> children;
  std::size_t count = 0;
  for (std::uint32_t child = n.first; child < n.last; ++child) {
    const double apart = outside2(x, nodes_[child].center, nodes_[child].half);
    if (apart >= best.distance2) continue;
    std::size_t place = count++;
    for (; place > 0 && children[place - 1].first > apart; --place) children[place] = children[place - 1];
    children[place] = {apart, child};
  }
  for (std::size_t i = 0; i < count && children[i].first < best.distance2; ++i) down(children[i].second, x, best);
}

UpwardTree::Answer UpwardTree::as_printed(dvec3 x, std::uint32_t last) const {
  std::uint32_t node = leaf_[last];
  while (nodes_[node].parent != node && outside2(x, nodes_[node].center, nodes_[node].half) > 0)
    node = nodes_[node].parent;
  Answer best{last, 1e300};
  down(node, x, best);
  return best;
}

UpwardTree::Answer UpwardTree::repaired(dvec3 x, std::uint32_t last) const {
  const dvec3 d = at(last) - x;
  Answer best{last, dot(d, d)};
  std::uint32_t node = leaf_[last];
  const auto holds_ball = [&] {
    const dvec3 in = nodes_[node].half - glm::abs(x - nodes_[node].center);
    const double least = std::min({in.x, in.y, in.z});
    return least >= 0 && best.distance2 <= least * least;
  };
  while (nodes_[node].parent != node && !holds_ball()) {
    const std::uint32_t from = node;
    node = nodes_[node].parent;
    for (std::uint32_t child = nodes_[node].first; child < nodes_[node].last; ++child)
      if (child != from && outside2(x, nodes_[child].center, nodes_[child].half) < best.distance2) down(child, x, best);
  }
  return best;
}

}  // namespace pliant
