// Tissue's part in its relaxation: from its elements to tissue_memory.h, and back.
#include <cstring>

#include "systems/soft/fem/element_history.h"
#include "systems/soft/fem/tissue.h"

namespace pliant {

void Tissue::take_memory() {
  const std::size_t entries = packs_.size() * kPackStresses + hexahedra_.size() * kCellStresses;
  std::vector<double> factor;
  if (!relaxation_.empty()) factor.assign(entries, 1.0);
  for (std::size_t e = 0; e < relaxation_.size(); ++e) {
    const bool cells = !hexahedra_.empty();
    const std::size_t first = cells ? e * kCellStresses : e / kElementLanes * kPackStresses + e % kElementLanes;
    for (std::size_t k = 0; k < (cells ? kCellStresses : kStresses); ++k)
      factor[first + (cells ? k : k * kElementLanes)] = relaxation_[e];
  }
  memory_.set(material_.prony, entries, std::move(factor));
  rest_here();
}

void Tissue::find_stress(std::vector<double>& stress) const {
  stress.assign(packs_.size() * kPackStresses + hexahedra_.size() * kCellStresses, 0.0);
  ElementVisit now;
  for (std::size_t p = 0; p < packs_.size(); ++p) {
    take_edges(packs_[p], x_, now);
    if (law_ || material_.strain == Strain::kCorotational) {
      take_rotations(packs_[p], now);
    } else {
      take_gradients(packs_[p], now);
      std::memcpy(now.q, packs_[p].q, sizeof now.q);
    }
    find_pack_stress(packs_[p], law_, {mu_, lambda_, material_.stiffening}, now, &stress[p * kPackStresses]);
  }
  HexVisit of_cell;
  for (std::size_t e = 0; e < hexahedra_.size(); ++e) {
    turn_cell(hexahedra_[e], turned(hexahedra_[e], x_), of_cell);
    find_cell_stress(hexahedra_[e], x_, lambda_, mu_, of_cell, &stress[e * kCellStresses]);
  }
}

double Tissue::pack_share(std::size_t pack, std::size_t lane) const {
  return memory_.empty() ? 1.0 : memory_.share(pack * kPackStresses + lane);
}

double Tissue::cell_share(std::size_t cell) const {
  return memory_.empty() ? 1.0 : memory_.share(cell * kCellStresses);
}

void Tissue::add_history(std::size_t pack, ElementVisit& visit) const {
  if (material_.strain == Strain::kLinear) take_gradients(packs_[pack], visit);
  ElementLanes share;
  for (std::size_t lane = 0; lane < kElementLanes; ++lane) share[lane] = pack_share(pack, lane);
  add_pack_history(packs_[pack], memory_.history(pack * kPackStresses), share, visit);
}

void Tissue::add_cell_memory(std::size_t cell, const std::vector<dvec3>& x, HexVisit& visit) const {
  if (!memory_.empty())
    add_cell_history(hexahedra_[cell], x, memory_.history(cell * kCellStresses), cell_share(cell), visit);
}

void Tissue::end_step(double T) {
  if (relaxed_) return;
  time_ += T, step_ = 0.0;
  if (memory_.empty()) return;
  std::vector<double> stress;
  find_stress(stress);
  memory_.end(stress, T);
}

void Tissue::rest_here() {
  if (memory_.empty()) return;
  std::vector<double> stress;
  find_stress(stress);
  memory_.rest(stress);
  if (relaxed_) memory_.begin_relaxed();
}

void Tissue::keep_relaxed(bool relaxed) {
  relaxed_ = relaxed;
  if (relaxed)
    memory_.begin_relaxed();
  else
    rest_here();
}

}  // namespace pliant
