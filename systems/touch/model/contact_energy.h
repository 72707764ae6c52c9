// The elastic force on every probe as minus the gradient of one stored energy (methods.md 1.10). W_i is the stored
// energy of contact i of an object as if it were alone:
//   e_i = sqrt(2 W_i),   U = max over loads l >= 0 of  e.l - 1/2 l.A l,   A_ii = 1,
//   A_ij = phi(|p_i - p_j| / R) max(0, n_i.n_j)
// A lone contact has U = W. Coincident contacts share one W. Distant contacts are not coupled. By the envelope theorem
//   -dU/dx_i = -(l_i / e_i) dW_i/dx_i + l_i sum_j l_j dA_ij/dx_i
// the last term is the slope of the neighbours' dents (P1 3.5, "actual normal").
//
// phi must be positive definite in space, which the drawn shapes with a rim are not. It is a mixture of two Wendland
// functions per shape, fitted to the shape's positive part (share_kernel).
#pragma once

#include <cstdint>
#include <span>

#include "components/deformable.h"
#include "components/math.h"

namespace pliant {

// phi(r) = w c(r / a) + (1 - w) c(r / b), c(q) = (1 - q)^4 (4 q + 1), q < 1.
struct ShareKernel {
  double weight = 1.0;              // [1] w
  double inner = 1.0, outer = 1.0;  // [m] a, b
  double at(double r2) const;       // [1] of the distance squared [m2]
  double slope(double r2) const;    // [1/m2] (d phi / dr) / r
};
// `reach` [m] R; `volume` [1] chi of the shape `volume`; `contact` [1] a / R of the half-space shapes.
ShareKernel share_kernel(Shape shape, double reach, double volume, double contact = 0.2);

// One contact with stored energy. Object frame.
struct LoadedContact {
  double energy = 0.0;    // [J] W > 0, alone
  dvec3 pull{0};          // [N] -dW/dx
  dvec3 p{0}, normal{0};  // [m], [1] of the contact
  dmat3 moves{0.0};       // [1] dp/dx
  dmat3 turns{0.0};       // [1/m] dn/dx
  double load = 0.0;      // [sqrt J] l: in, initial guess (the last tick's); out
  double share = 0.0;     // [1] out: l / e, of its lone force; 1 alone, 0 in another's dent
  dvec3 force{0};         // [N] out: -dU/dx
};

// Two contacts of one tip in one dent: with the depth s at the ridge between them (collide/ridge.h),
//   m = sqrt(W_a(s) W_b(s) / (W_a W_b)),   A_ab = 1 - (1 - m)(1 - q) / (1 - m q),   q = phi n_a.n_b
// Where the ridge is as deep as one of them, m is e of that one over e of the other, and it bears no load: A is at
// least m and q. It is 1 for the same place alone, so that the force turns from one to the other over a way, not in a
// tick.
struct SharedDent {
  std::uint32_t a = 0, b = 0;  // indices of contacts
  double part = 0.0;           // [1] m
  dvec3 slope{0};              // [1/m] dm/dx of the tip
  dvec3 turning{0};            // [1] dm by a turn about the object's origin
  double pull = 0.0;           // [J] out: -dU/dm
};

// Solves for the loads and the forces. Returns U [J]; NaN if a load was not finite and was replaced by 0. At most
// kMaxLoaded contacts.
inline constexpr std::size_t kMaxLoaded = 64;
double share_load(std::span<LoadedContact> contacts, const ShareKernel& kernel, std::span<SharedDent> dents = {});

}  // namespace pliant
