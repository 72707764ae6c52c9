// Assembly of co-rotational tetrahedra (tissue.h), shared among threads by the rows to which they add.
#include <algorithm>
#include <cstring>
#include <utility>

#include "runtime/tasks.h"
#include "systems/soft/fem/tissue.h"

namespace pliant {
namespace {

constexpr std::size_t kAssemblyShares = 4,
                      kSharedPacks = 500;  // tasks of an assembly; fewer packs are faster on one thread

// `to` (row major) += p_i c_j^T + q_j c_i^T + d I, with p = V lambda c, q = V mu c, d = V mu b_i . b_j: one K'_ij.
inline void add_elastic_block(double* __restrict to, dvec3 pi, dvec3 cj, dvec3 qj, dvec3 ci, double d) {
  to[0] += pi.x * cj.x + qj.x * ci.x + d;
  to[1] += pi.x * cj.y + qj.x * ci.y;
  to[2] += pi.x * cj.z + qj.x * ci.z;
  to[3] += pi.y * cj.x + qj.y * ci.x;
  to[4] += pi.y * cj.y + qj.y * ci.y + d;
  to[5] += pi.y * cj.z + qj.y * ci.z;
  to[6] += pi.z * cj.x + qj.z * ci.x;
  to[7] += pi.z * cj.y + qj.z * ci.y;
  to[8] += pi.z * cj.z + qj.z * ci.z + d;
}

}  // namespace

void Tissue::share_packs() {
  const std::uint32_t nodes = mesh_.node_count();
  std::vector<std::size_t> corners(nodes + 1, 0);  // of elements, at nodes before this one
  for (const ElementPack& pack : packs_)
    for (std::size_t lane = 0; lane < pack.count; ++lane)
      for (const std::uint32_t node : pack.node[lane]) ++corners[node + 1];
  for (std::uint32_t node = 0; node < nodes; ++node) corners[node + 1] += corners[node];
  const std::size_t count = packs_.size() < kSharedPacks ? 1 : kAssemblyShares;
  for (std::size_t k = 0; k < count; ++k) {
    const auto at = [&](std::size_t share) {
      const auto found = std::lower_bound(corners.begin(), corners.end(), share * corners[nodes] / count);
      return share == count ? nodes : static_cast<std::uint32_t>(found - corners.begin());
    };
    Share share{k == 0 ? 0 : at(k), at(k + 1), {}};
    for (std::uint32_t p = 0; p < packs_.size(); ++p) {
      const auto end = packs_[p].node.begin() + static_cast<std::ptrdiff_t>(packs_[p].count);
      const auto in_share = [&](const Tet& tet) {
        return std::any_of(tet.begin(), tet.end(), [&](std::uint32_t node) { return share.has(node); });
      };
      if (std::any_of(packs_[p].node.begin(), end, in_share)) share.packs.push_back(p);
    }
    shares_.push_back(std::move(share));
  }
}

// Rotations of the elements at the current positions.
void Tissue::turn_packs() {
  if (material_.strain != Strain::kCorotational) return;
  const std::size_t together = (packs_.size() + shares_.size() - 1) / shares_.size();
  run_tasks(shares_.size(), [&](std::size_t task, unsigned) {
    ElementVisit now;
    for (std::size_t p = task * together; p < std::min((task + 1) * together, packs_.size()); ++p) {
      take_edges(packs_[p], x_, now), take_rotations(packs_[p], now);
      std::memcpy(packs_[p].q, now.q, sizeof now.q);
    }
  });
}

void Tissue::assemble_share(const Share& share, const Scale& scale, const std::vector<dvec3>* begin) {
  const std::uint32_t end = mesh_.pinned_begin();
  const auto add_forces = [&](const Tet& tet, std::size_t lane, const ElementVisit& from, double factor,
                              std::uint32_t below, Vector& to) {
    for (int i = 0; i < 4; ++i)
      if (tet[i] < below && share.has(tet[i])) add(to, tet[i], factor * lane_of(from.f[i], lane));
  };
  ElementVisit now;
  for (const std::uint32_t p : share.packs) {
    const ElementPack& pack = packs_[p];
    take_edges(pack, x_, now);
    std::memcpy(now.q, pack.q, sizeof now.q);
    turn_gradients(pack, now);
    take_forces(pack, lambda_, mu_, now);
    if (!memory_.empty()) take_gradients(pack, now), add_history(p, now);
    for (std::size_t lane = 0; lane < pack.count; ++lane) {
      const std::size_t element = p * kElementLanes + lane;
      add_forces(pack.node[lane], lane, now, 1.0, mesh_.node_count(), force_);
      const double stiffness = scale.stiffness(damping_.empty() ? 1.0 : damping_[element], pack_share(p, lane));
      add_blocks(share, pack, lane, slots_[element], stiffness, now);
      if (pack.node[lane][3] >= end) add_prescribed(share, pack, lane, stiffness, now);
    }
    // f_el + K' (x - begin): the stress at the beginning of the step, with the rotations of the guess.
    if (begin) {
      take_edges(pack, *begin, now), take_forces(pack, lambda_, mu_, now);
      if (!memory_.empty()) add_history(p, now);
    }
    for (std::size_t lane = 0; lane < pack.count; ++lane) add_forces(pack.node[lane], lane, now, scale.T, end, right_);
  }
}

void Tissue::add_blocks(const Share& share, const ElementPack& pack, std::size_t lane, const Slots& slots,
                        double stiffness, const ElementVisit& visit) {
  const double l = stiffness * pack.volume[lane] * lambda_, m = stiffness * pack.volume[lane] * mu_;
  const Tet& tet = pack.node[lane];
  std::array<dvec3, 4> c;
  for (int i = 0; i < 4; ++i) c[i] = lane_of(visit.c[i], lane);
  std::size_t k = 0;
  for (int i = 0; i < 4; ++i) {
    if (!share.has(tet[i])) {
      k += static_cast<std::size_t>(4 - i);
      continue;
    }
    const dvec3 p = l * c[i];
    for (int j = i; j < 4; ++j, ++k) {
      double* const to = block(tet[i], tet[j], slots[k]);
      if (to) add_elastic_block(to, p, c[j], m * c[j], c[i], m * dot(c[i], c[j]));
    }
  }
}

// Pinned nodes have no rows: A times their velocities v goes to the right-hand side. sum_p K'_ip v_p is V sigma c_i of
// the strain sym(sum_p v_p c_p^T).
void Tissue::add_prescribed(const Share& share, const ElementPack& pack, std::size_t lane, double stiffness,
                            const ElementVisit& visit) {
  const Tet& tet = pack.node[lane];
  dmat3 L(0);
  for (int i = 0; i < 4; ++i)
    if (tet[i] >= mesh_.pinned_begin()) L += outerProduct(v_[tet[i]], lane_of(visit.c[i], lane));
  const double factor = stiffness * pack.volume[lane], trace = L[0][0] + L[1][1] + L[2][2];
  const dmat3 sigma = factor * (mu_ * (L + transpose(L)) + dmat3(lambda_ * trace));
  for (int i = 0; i < 4; ++i)
    if (tet[i] < mesh_.pinned_begin() && share.has(tet[i])) add(right_, tet[i], -(sigma * lane_of(visit.c[i], lane)));
}

// Fills the lower blocks from the upper ones. Diagonal blocks are symmetric up to rounding; a solver may read either
// half.
void Tissue::mirror() {
  const auto even = [](Block& b) { b(1, 0) = b(0, 1), b(2, 0) = b(0, 2), b(2, 1) = b(1, 2); };
  for (const std::uint32_t k : inner_.diagonal) even(inner_.value[k]);
  for (Entry& entry : corner_)
    if (entry.row == entry.column) even(entry.value);
  const std::size_t together = (inner_mirror_.size() + shares_.size() - 1) / shares_.size();
  run_tasks(shares_.size(), [&](std::size_t task, unsigned) {
    for (std::size_t i = task * together; i < std::min((task + 1) * together, inner_mirror_.size()); ++i)
      inner_.value[inner_mirror_[i][1]] = inner_.value[inner_mirror_[i][0]].transpose();
  });
  for (const auto& [upper, lower] : corner_mirror_) corner_[lower].value = corner_[upper].value.transpose();
}

}  // namespace pliant
