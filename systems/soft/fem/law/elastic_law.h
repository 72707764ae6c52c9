// An isotropic elastic law by its energy density psi(I, J), of I = |F|^2 and J = det F of the deformation gradient F:
//   P = 2 psi_I F + psi_J cof F,
//   dP = 2 psi_I dF + psi_J dcof F + 2 F dpsi_I + cof F dpsi_J.
// Every law has psi = 0 and P = 0 at rest and, in its one minimum there, Lame's moduli of the material. A law is a file
// of one function, and a line in elastic_law().
#pragma once

#include "pliant/parameters.h"

namespace pliant {

struct LawConstants {
  double mu = 0.0, lambda = 0.0;  // [Pa] Lame's
  double b = 0.0;                 // [1] SoftBodyParameters::stiffening
};

// [Pa] psi and its derivatives.
struct Density {
  double psi = 0.0;
  double I = 0.0, J = 0.0;
  double II = 0.0, IJ = 0.0, JJ = 0.0;
};

using ElasticLaw = Density (*)(const LawConstants& material, double I, double J);

// Null: co-rotational (element.h), which depends on more than F.
ElasticLaw elastic_law(TissueLaw law);

}  // namespace pliant
