// Tissue's material as a soft body states it.
#pragma once

#include "components/soft_body.h"
#include "systems/soft/fem/tissue.h"

namespace pliant {

inline TissueMaterial material_of(const SoftBodyParameters& body) {
  return {.young = body.young,
          .poisson = body.poisson,
          .density = body.density,
          .alpha = body.rayleigh[0],
          .beta = body.rayleigh[1],
          .law = body.law,
          .stiffening = body.stiffening,
          .prony = body.prony,
          .fibres = body.fibres};
}

}  // namespace pliant
