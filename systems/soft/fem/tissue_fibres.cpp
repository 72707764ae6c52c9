// Tissue's fibres: their forces and stiffness beside those of the law.
#include "systems/soft/fem/fibres.h"
#include "systems/soft/fem/tissue.h"

namespace pliant {

FibreStep Tissue::fibre_step(double T) const {
  const Fibres& all = material_.fibres;
  return {all.young, normalize(all.direction), rest_length(all, time_ + (relaxed_ ? 0.0 : T)), all.only_tension};
}

void Tissue::add_fibre_forces(Vector& to) const {
  if (!has_fibres()) return;
  const FibreStep step = fibre_step(step_);
  ElementVisit now;
  for (const ElementPack& pack : packs_) {
    take_edges(pack, x_, now);
    for (std::size_t lane = 0; lane < pack.count; ++lane) {
      const FibrePull pull = pull_of(step, pack, lane, now);
      for (std::size_t i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k)
          to[3 * static_cast<Eigen::Index>(pack.node[lane][i]) + k] -= pull.share[i] * pull.pull[k];
    }
  }
}

double Tissue::fibre_energy(const std::vector<dvec3>& x) const {
  if (!has_fibres()) return 0.0;
  const FibreStep step = fibre_step(step_);
  double energy = 0.0;
  ElementVisit now;
  for (const ElementPack& pack : packs_) {
    take_edges(pack, x, now);
    for (std::size_t lane = 0; lane < pack.count; ++lane) energy += pull_of(step, pack, lane, now).energy;
  }
  return energy;
}

// As assemble_law(), with T^2 K and without damping.
void Tissue::add_fibres(double T, const std::vector<dvec3>* begin) {
  if (!has_fibres()) return;
  const FibreStep step = fibre_step(T);
  const std::uint32_t end = mesh_.pinned_begin();
  ElementVisit now;
  const Slots* slots = slots_.data();
  for (const ElementPack& pack : packs_) {
    take_edges(pack, x_, now);
    for (std::size_t lane = 0; lane < pack.count; ++lane, ++slots) {
      const Tet& tet = pack.node[lane];
      const FibrePull pull = pull_of(step, pack, lane, now);
      dvec3 shift(0);
      for (std::size_t i = 0; i < 4; ++i) {
        if (begin) shift += pull.share[i] * T * (x_[tet[i]] - (*begin)[tet[i]]);
        if (tet[i] >= end) shift -= pull.share[i] * T * T * v_[tet[i]];
      }
      const dvec3 right = pull.slope * shift - T * pull.pull;
      std::size_t k = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto at = 3 * static_cast<Eigen::Index>(tet[i]);
        for (int d = 0; d < 3; ++d) {
          force_[at + d] -= pull.share[i] * pull.pull[d];
          if (tet[i] < end) right_[at + d] += pull.share[i] * right[d];
        }
        for (std::size_t j = i; j < 4; ++j, ++k)
          if (double* const to = block(tet[i], tet[j], (*slots)[k]))
            for (int r = 0; r < 3; ++r)
              for (int c = 0; c < 3; ++c) to[3 * r + c] += T * T * pull.share[i] * pull.share[j] * pull.slope[c][r];
      }
    }
  }
}

}  // namespace pliant
