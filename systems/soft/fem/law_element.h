// Tetrahedra with an elastic law for large strain (law/elastic_law.h), eight at a time as in element.h:
//   f_i = -V P b_i,   K'_ij = V b_i . (dP/dF) . b_j.
// K' is projected to positive semidefinite by the principal stretches F = U s V^T (Smith et al. 2018, section 4, here
// for any psi(I, J)). dP/dF has
//   in the plane of two axes i, j, with the third k:  2 psi_I -+ s_k psi_J   (dF_ij = +-dF_ji),
//   among the stretches:  A_ij = 2 psi_I d_ij + s_k psi_J [i /= j]
//                                + 4 s_i s_j psi_II + 2 (s_i c_j + c_i s_j) psi_IJ + c_i c_j psi_JJ,   c_i = J / s_i.
// Negative eigenvalues become zero.
#pragma once

#include "systems/soft/fem/element.h"
#include "systems/soft/fem/law/elastic_law.h"

namespace pliant {

// Blocks K'_kl [N/m], k <= l, of nodes 1, 2, 3: (1,1) (1,2) (1,3) (2,2) (2,3) (3,3). Those of node 0 follow from the
// sums over each row and column, which are zero.
struct alignas(64) LawBlocks {
  ElementLanes of[6][3][3];
};

// f and energy from the edges.
void take_law_forces(const ElementPack& pack, ElasticLaw law, const LawConstants& material, ElementVisit& visit);
// The blocks from the edges and the rotations q of take_rotations().
void take_law_blocks(const ElementPack& pack, ElasticLaw law, const LawConstants& material, const ElementVisit& visit,
                     LawBlocks& blocks);

}  // namespace pliant
