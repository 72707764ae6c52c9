// The analytic part of split contacts on tissue (methods.md 2.10):
//   d = W F,   W = S^T K^-1 S + L,   L_ij = <p_i, G p_j> - <w_i, G w_j>_lattice,
// with p the contact's own pressure and w the load that the lattice carries instead, both as Gaussians.
//
// Legend: a the radius of the flat punch as compliant as p; R that of w; k, k_t the lattice's compliance under w over
// the half-space's (lattice_calibration.h), R_c = R / k; H thickness of a layer bonded to something rigid.
#pragma once

#include "components/math.h"
#include "systems/soft/linear/block_matrix.h"
#include "systems/soft/local/lattice_calibration.h"
#include "systems/soft/local/smeared_kernel.h"

namespace pliant {

// [1] a over the radius of a uniform disc, of an area's circle: pressures of a point of a pressed mesh.
inline constexpr double kFlatOfDisc = 0.9253;

struct LocalElasticity {
  double young = 5e3, poisson = 0.45;                                 // [Pa] [1]
  double reduced() const { return young / (1 - poisson * poisson); }  // [Pa] E*
  double shear() const { return young / (2 + 2 * poisson); }          // [Pa] G
};

// One contact on the surface of tissue.
struct LocalPlace {
  dvec3 at{0};                // [m] on the surface
  dvec3 normal{0, 1, 0};      // [1] outward
  double own = 0.0;           // [m] a > 0
  double smeared = 0.0;       // [m] R
  LatticeCompliance lattice;  // k, k_t
  double thickness = 0.0;     // [m] H; 0: a half-space
};

// [m/N] L_ij: displacement of the surface at i per force at j, in the frame of the places. `layer`: the kernel of the
// material's Poisson's ratio, for places with a thickness. L_ji is its transpose.
Block local_compliance(const LocalPlace& i, const LocalPlace& j, const LocalElasticity& tissue,
                       const LayerKernel* layer);
// [m/N] L_ii along the normal, and along the surface.
double local_normal_compliance(const LocalPlace& at, const LocalElasticity& tissue, const LayerKernel* layer);
double local_tangential_compliance(const LocalPlace& at, const LocalElasticity& tissue);
Block local_self_compliance(const LocalPlace& at, const LocalElasticity& tissue, const LayerKernel* layer);

// [1] of the larger R: contacts farther apart have no pair term.
inline constexpr double kPairReach = 4.0;

}  // namespace pliant
