// The rotation nearest to a deformation gradient F: R maximises tr(R^T F) over SO(3). For det F > 0 it is the polar
// factor; for an inverted F it is what a singular value decomposition gives with the sign of the smallest singular
// value flipped (Irving, Teran, Fedkiw 2004), so an inverted element is pushed out through its thinnest direction.
//
// Method: Newton on the rotation, started from the last one (after Kugelstadt, Koschier, Bender 2018; Mueller et al.
// 2016 climb the same function with a first-order step). With B = R^T F, a = axial(B - B^T), H = tr(B) I - sym(B):
//   H w = a,  R <- R exp[w].
// H has the eigenvalues s1+s2, s1+s3, s2+s3 of the signed singular values at a stationary point, and only the global
// maximum has them all positive: "a = 0 and H positive definite" certifies the answer. Where the certificate fails
// (first call, large rotation, inversion, collapse) the largest eigenvector of Horn's 4x4 matrix decides (Horn 1987).
// What lost, for steps of a simulation (10 % strain, 0.02 rad since the guess; one at a time on a 2020s Xeon):
// Mueller's step converges linearly, 17 iterations to 1e-9, 840 ns; a Jacobi singular value decomposition 580 ns, and
// its signs jump from step to step; Horn's matrix alone 2,100 ns; this 100 ns, and less eight at a time (element.h).
#pragma once

#include "components/math.h"

namespace pliant {

// `q` comes in as a guess (unit) and leaves as the answer (unit). Where F leaves the answer open (collapsed to a line
// or a point, or inverted without a thinnest direction) the answer is the one closest to the guess. F must be finite.
void extract_rotation(const dmat3& F, dquat& q);

// The same from nothing but F and Horn's matrix; `q` only breaks ties.
void extract_rotation_globally(const dmat3& F, dquat& q);

}  // namespace pliant
