// Pairs of triangles whose swept boxes overlap and whose normals are not all similar. Both trees are descended together
// (Gottschalk, Lin & Manocha 1996), the larger level first, in an order that depends only on the boxes. The test of
// normals keeps a smooth collision mesh from being compared with its neighbourhood.
#pragma once

#include "systems/soft/collide/collision_mesh.h"

namespace pliant {

// Box a, swept by the relative drift of the two bodies, against box b.
struct RelativeSweep {
  vec3 low{0}, high{0};  // [m]
  RelativeSweep() = default;
  explicit RelativeSweep(float reach) : low(-reach), high(reach) {}
  // `reach` [m]: distance up to which boxes overlap.
  RelativeSweep(const CollisionMesh& a, const CollisionMesh& b, float reach = 0.0f) {
    const vec3 d(a.drift() - b.drift());
    low = glm::min(d, vec3(0.0f)) - reach;
    high = glm::max(d, vec3(0.0f)) + reach;
  }
  RelativeSweep reversed() const {
    RelativeSweep r;
    r.low = -high;
    r.high = -low;
    return r;
  }
  bool meet(const Box& a, const Box& b) const {
    return a.min.x + low.x <= b.max.x && a.max.x + high.x >= b.min.x &&  //
           a.min.y + low.y <= b.max.y && a.max.y + high.y >= b.min.y &&  //
           a.min.z + low.z <= b.max.z && a.max.z + high.z >= b.min.z;
  }
};

namespace detail {

// The smallest dot product of a vector in box a with one in box b.
inline float least_dot(const Box& a, const Box& b) {
  const vec3 p = a.min * b.min, q = a.min * b.max, r = a.max * b.min, s = a.max * b.max;
  const vec3 least = glm::min(glm::min(p, q), glm::min(r, s));
  return least.x + least.y + least.z;
}

template <class Use>
struct PairWalk {
  const CollisionMesh& a;
  const CollisionMesh& b;
  const RelativeSweep sweep;
  const float strayed;  // [m] lower bound of the summed deviation of two runs (CollisionMesh::strayed)
  Use& use;

  static std::uint32_t width(std::size_t level) { return level == 0 ? kLeafSize : kTreeWidth; }
  static std::uint32_t size(const CollisionMesh& collision_mesh, std::size_t level) {  // number of children of `level`
    return static_cast<std::uint32_t>(level == 0 ? collision_mesh.mesh().triangles.size()
                                                 : collision_mesh.boxes()[level - 1].size());
  }
  static std::uint32_t end(const CollisionMesh& collision_mesh, std::size_t level, std::uint32_t i) {
    return std::min((i + 1) * width(level), size(collision_mesh, level));
  }
  const Box& box(const CollisionMesh& collision_mesh, std::size_t level, std::uint32_t i) const {
    return collision_mesh.boxes()[level][i];
  }
  bool facing(std::size_t la, std::uint32_t ia, std::size_t lb, std::uint32_t ib) const {
    return least_dot(a.normal_boxes()[la][ia], b.normal_boxes()[lb][ib]) <= static_cast<float>(kFacing) + 1e-5f;
  }

  void across(std::size_t la, std::uint32_t ia, std::size_t lb, std::uint32_t ib) const {
    if (a.strayed(la, ia) + b.strayed(lb, ib) <= strayed) return;
    if (!sweep.meet(box(a, la, ia), box(b, lb, ib)) || !facing(la, ia, lb, ib)) return;
    if (la == 0 && lb == 0) return &a == &b ? own_leaves(ia, ib) : leaves(ia, ib);
    if (la >= lb) {
      for (std::uint32_t k = ia * kTreeWidth; k < end(a, la, ia); ++k) across(la - 1, k, lb, ib);
    } else {
      for (std::uint32_t k = ib * kTreeWidth; k < end(b, lb, ib); ++k) across(la, ia, lb - 1, k);
    }
  }
  void leaves(std::uint32_t ia, std::uint32_t ib) const {
    for (std::uint32_t s = ia * kLeafSize; s < end(a, 0, ia); ++s)
      for (std::uint32_t t = ib * kLeafSize; t < end(b, 0, ib); ++t)
        if (a.strayed(s) + b.strayed(t) > strayed && sweep.meet(a.box(s), b.box(t))) use(s, t);
  }
  // Within one collision mesh, without the pairs settled by its neighbours.
  void own_leaves(std::uint32_t ia, std::uint32_t ib) const {
    const unsigned settled = a.neighbours().settled(ia, ib);
    if (settled == (1u << kLeafSize * kLeafSize) - 1u) return;
    for (std::uint32_t s = ia * kLeafSize; s < end(a, 0, ia); ++s)
      for (std::uint32_t t = ia == ib ? s + 1 : ib * kLeafSize; t < end(a, 0, ib); ++t) {
        if (settled >> (kLeafSize * (s % kLeafSize) + t % kLeafSize) & 1u) continue;
        if (a.strayed(s) + a.strayed(t) > strayed && sweep.meet(a.box(s), a.box(t))) use(s, t);
      }
  }
  // Every unordered pair of different triangles once.
  void within(std::size_t level, std::uint32_t i) const {
    if (2.0f * a.strayed(level, i) <= strayed || !facing(level, i, level, i)) return;
    if (level == 0) {
      return own_leaves(i, i);
    }
    for (std::uint32_t k = i * kTreeWidth; k < end(a, level, i); ++k) {
      within(level - 1, k);
      for (std::uint32_t m = k + 1; m < end(a, level, i); ++m) across(level - 1, k, level - 1, m);
    }
  }
};

}  // namespace detail

// use(triangle of a, triangle of b). Boxes overlap up to a distance of `reach` [m], in addition to their growth. Pairs
// of triangles whose summed deviation is at most `strayed` [m] are skipped.
template <class Use>
void for_each_pair(const CollisionMesh& a, const CollisionMesh& b, Use use, float reach = 0.0f, float strayed = -1.0f) {
  if (a.boxes().empty() || b.boxes().empty()) return;
  const detail::PairWalk<Use> walk{a, b, RelativeSweep(a, b, reach), strayed, use};
  walk.across(a.boxes().size() - 1, 0, b.boxes().size() - 1, 0);
}
// use(triangle, other triangle), each unordered pair once
template <class Use>
void for_each_pair_within(const CollisionMesh& collision_mesh, Use use, float reach = 0.0f, float strayed = -1.0f) {
  if (collision_mesh.boxes().empty()) return;
  const detail::PairWalk<Use> walk{collision_mesh, collision_mesh, RelativeSweep(reach), strayed, use};
  walk.within(collision_mesh.boxes().size() - 1, 0);
}

}  // namespace pliant
