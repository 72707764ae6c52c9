// Tissue and technical materials by name. Young's modulus and Poisson's ratio hold for small, slow strains; each entry
// cites its source. Density without a cited source: ICRU Report 44 (1989) for tissue, that of water for gelatin.
// Friction and damping are typical of wet tissue and gels under a smooth instrument; they were not measured.
#pragma once

#include <span>
#include <string>

#include "content/level/level.h"

namespace pliant {

struct TissuePreset {
  const char* word;               // name in commands
  const char* name;               // name in the editor
  double young;                   // [Pa]
  double low, high;               // [Pa] range given by the source
  double poisson;                 // [1]
  double density;                 // [kg/m3]
  double alpha, beta;             // [1/s], [s] Rayleigh damping of a soft body
  double settling;                // [s] settling time of a deformable surface
  double friction;                // static friction; dynamic friction is kSliding times this
  const char* source;             // of the modulus: author, year, journal, and the measurement
  vec3 color;                     // [1] linear
  float roughness, wet, scatter;  // [1] of the surface; clear coat; share of light that scatters below the surface
};
inline constexpr double kSliding = 0.75;  // [1]

std::span<const TissuePreset> tissue_presets();
const TissuePreset* find_preset(const std::string& word);

// [N/m] Stiffness of a point contact of 4 mm radius on a half-space (docs/methods.md).
double surface_stiffness(const TissuePreset& preset);

// Its look on an object of this thickness [m]. Light enters tissue by some millimetres, red light deeper (Jacques 2013,
// Phys. Med. Biol. 58:R37).
Material look_of(const TissuePreset& preset, float thickness);
// Gives that look to the parts of the node's mesh that have none of their own: no material, plain grey without
// pictures, or a preset's look.
void add_look(Level& level, std::int32_t node, const TissuePreset& preset);

SoftBodyParameters soft_body_of(const TissuePreset& preset);
DeformableParameters surface_of(const TissuePreset& preset);

}  // namespace pliant
