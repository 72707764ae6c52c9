// Roughness that is felt: a height h(x) of the surface, of plane waves through the object's rest frame (methods.md
// 1.11). It needs no texture coordinates, repeats in every run, and continues over edges and seams of the mesh.
#pragma once

#include <array>
#include <cstdint>

#include "components/deformable.h"
#include "components/math.h"

namespace pliant {

// Height and gradient of what is felt beside the mesh. <= 0: its highest places are on the mesh, so that a contact
// begins where it does on the smooth surface, and begins without energy.
struct Raised {
  double height = 0.0;  // [m]
  dvec3 gradient{0};    // [1] by the tip's centre
};

// Detail that passes a probe at more than this share of the touch rate is not felt (400 Hz of 1 kHz): it would alias.
// [1]
inline constexpr double kDetailGone = 0.4;
// Detail returns with this time constant, so that the fading itself is no vibration. [s]
inline constexpr double kDetailReturns = 0.02;
// The finest wavelength that is felt [m], from the last tick's, at this speed [m/s].
double finest_felt(double last, double speed, double dt);
// [1] Share of a wavelength [m] that is felt: 0 up to the finest, 1 from twice that on; C1.
double detail_share(double wavelength, double finest);

struct Texture {
  static constexpr std::size_t kWaves = 8;  // the highest place is at most sqrt(2 kWaves) = 4 times the r.m.s.
  std::size_t count = 0;                    // waves; 0: smooth
  double wavelength = 0.0;                  // [m]
  double amplitude = 0.0;                   // [m] of each wave
  std::array<dvec3, kWaves> wave{};         // [rad/m]
  std::array<double, kWaves> phase{};       // [rad]

  // At a place of the rest surface; of its waves `share` is left, about the same mean. `gradient` is by the place.
  Raised at(dvec3 place, double share = 1.0) const;
};
Texture texture_of(const DeformableParameters& deformable);

// [1] Share of a wave's height that the centre of a sphere feels. Large spheres ride on the crests: between two of
// them, L apart, they sink by L^2 / 8 r; small ones reach the bottom. The p-norm (p = 4) of both limits.
double riding_share(double amplitude, double wavelength, double radius);

}  // namespace pliant
