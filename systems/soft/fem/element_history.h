// The stress of relaxing tissue that a step cannot change (tissue_memory.h), as forces of tetrahedra. Stress is in the
// element's own axes: with F = R U, the elastic law has S = sym(R^T P). The history H has the energy V H : U, whose
// gradient is
//   P = R (H - [w]x),   w = 2 (tr(U) I - U)^-1 axial(skew(H U)).
// The second term is that of R, which depends on F: without it, forces would have a moment.
#pragma once

#include "systems/soft/fem/element.h"
#include "systems/soft/fem/law/elastic_law.h"

namespace pliant {

inline constexpr std::size_t kStresses = 6;                              // xx, yy, zz, xy, xz, yz
inline constexpr std::size_t kPackStresses = kStresses * kElementLanes;  // of a pack: lanes of each

// [Pa] S of a law, or null: co-rotational; F and q of `visit` are the deformation gradient and its rotation.
void find_pack_stress(const ElementPack& pack, ElasticLaw law, const LawConstants& material, const ElementVisit& visit,
                      double* stress);
// f and energy <- share of them, of each lane, with those of the history.
void add_pack_history(const ElementPack& pack, const double* history, const ElementLanes& share, ElementVisit& visit);

}  // namespace pliant
