// The force of a sphere of radius R on tissue of known modulus against its depth d, where it is not Hertz's:
//   F = 4/3 E* sqrt(R) unit^1.5 phi(d / unit),   phi(x) = s^3 g(s),   s = sqrt(x);   Hertz: g = 1.
// Sneddon's exact sphere on a half-space (Int. J. Engng Sci. 3, 1965; contact radius a), unit = R:
//   d = a/2 ln((R + a) / (R - a)),   F = E* ((R^2 + a^2)/2 ln((R + a) / (R - a)) - a R)
// Hertz's paraboloid on a layer of thickness h that is bonded to something rigid (bonded_layer.h), unit = h^2 / R.
//
// g is a cubic between the solutions at some contact radii, with their slopes: dF/dd = 2 E* a kappa(a), kappa = 1 on a
// half-space. Beyond the last, d = 9 R or a = 20 h, the force goes on with its slope.
#pragma once

#include "components/cubic_pieces.h"

namespace pliant {

struct SphereCurve : CubicPieces<37> {  // g over s; the integral is that of phi over x
  struct Value {
    double value, slope, integral;  // phi, its derivative, and its integral from 0
  };
  Value at(double x) const;
};

const SphereCurve& sneddon_sphere();
// The last result is kept: an editor asks for the same one in every frame.
const SphereCurve& layer_sphere(double poisson);

}  // namespace pliant
