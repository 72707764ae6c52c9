// Tissue and technical materials by name. Young's modulus and Poisson's ratio are of small, slow strains; every source
// says where they are from. Density where no source is named: ICRU Report 44 (1989) for tissue, water's for gelatin.
// Friction and damping are typical of wet tissue and of gels under a smooth instrument, and measured for none of them.
#pragma once

#include <span>
#include <string>

#include "content/level/level.h"

namespace pliant {

struct TissuePreset {
  const char* word;    // as it is called in a command
  const char* name;    // as it is shown
  double young;        // [Pa]
  double low, high;    // [Pa] the range that the source gives for it
  double poisson;      // [1]
  double density;      // [kg/m3]
  double alpha, beta;  // [1/s], [s] Rayleigh damping of a soft body
  double settling;     // [s] of a deformable surface
  double friction;     // [1] of rest; that of sliding is kSliding of it
  const char* source;  // of the modulus: author, year, journal, and what was measured
};
inline constexpr double kSliding = 0.75;  // [1]

std::span<const TissuePreset> tissue_presets();
const TissuePreset* find_preset(const std::string& word);

// [N/m] Of a point contact of 4 mm radius on a deep half-space (docs/methods.md).
double surface_stiffness(const TissuePreset& preset);

SoftBodyParameters soft_body_of(const TissuePreset& preset);
DeformableParameters surface_of(const TissuePreset& preset);

}  // namespace pliant
