// The rotation nearest to a deformation gradient F: R maximises tr(R^T F) over SO(3). For det F > 0 it is the polar
// factor. For an inverted F it is the result of a singular value decomposition with the sign of the smallest singular
// value flipped (Irving, Teran, Fedkiw 2004). An inverted element therefore recovers through its thinnest direction.
//
// Method: Newton on the rotation, started from the last one (after Kugelstadt, Koschier, Bender 2018; Mueller et al.
// 2016 maximise the same function with a first-order step). With B = R^T F, a = axial(B - B^T), H = tr(B) I - sym(B):
//   H w = a,  R <- R exp[w].
// H has the eigenvalues s1+s2, s1+s3, s2+s3 of the signed singular values at a stationary point, and only the global
// maximum has them all positive. So "a = 0 and H positive definite" certifies the result. Where the certificate fails
// (first call, large rotation, inversion, collapse) the largest eigenvector of Horn's 4x4 matrix decides (Horn 1987).
// Rejected, for steps of a simulation (10 % strain, 0.02 rad since the guess; one at a time on a 2020s Xeon): Mueller's
// step converges linearly, 17 iterations to 1e-9, 840 ns. A Jacobi singular value decomposition takes 580 ns, and its
// signs jump from step to step. Horn's matrix alone takes 2,100 ns. This method takes 100 ns, and less eight at a time
// (element.h).
#pragma once

#include "components/math.h"

namespace pliant {

// `q` is the guess on entry (unit) and the result on return (unit). Where F does not determine the rotation (collapsed
// to a line or a point, or inverted without a unique thinnest direction) the result is the one closest to the guess. F
// must be finite.
void extract_rotation(const dmat3& F, dquat& q);

// The same only from F and Horn's matrix; `q` only breaks ties.
void extract_rotation_globally(const dmat3& F, dquat& q);

}  // namespace pliant
