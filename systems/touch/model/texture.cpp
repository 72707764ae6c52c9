#include "systems/touch/model/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace pliant {
namespace {

// Vigna's splitmix64: [0, 1).
double next_random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

double finest_felt(double last, double speed, double dt) {
  return std::max(speed * dt / kDetailGone, last * std::max(0.0, 1 - dt / kDetailReturns));
}

double detail_share(double wavelength, double finest) {
  const double u = std::clamp(2 - 2 * finest / wavelength, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

Raised Texture::at(dvec3 place, double share) const {
  Raised out;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = dot(wave[i], place) + phase[i];
    out.height += amplitude * (share * std::sin(angle) - 1.0);
    out.gradient += amplitude * share * std::cos(angle) * wave[i];
  }
  return out;
}

Texture texture_of(const DeformableParameters& d) {
  Texture out;
  if (!(d.texture_amplitude > 0.0)) return out;
  out.count = Texture::kWaves;
  out.wavelength = d.texture_wavelength;
  out.amplitude = d.texture_amplitude * std::sqrt(2.0 / static_cast<double>(Texture::kWaves));
  std::uint64_t random = std::bit_cast<std::uint64_t>(d.texture_seed);
  // Directions evenly over the half sphere (a Fibonacci spiral), turned at random: Shoemake 1992.
  const double u = next_random(random), v = 2 * std::numbers::pi * next_random(random),
               w = 2 * std::numbers::pi * next_random(random);
  const dquat turn(std::sqrt(u) * std::cos(w), std::sqrt(1 - u) * std::sin(v), std::sqrt(1 - u) * std::cos(v),
                   std::sqrt(u) * std::sin(w));
  const double k = 2 * std::numbers::pi / d.texture_wavelength;
  for (std::size_t i = 0; i < out.count; ++i) {
    const double z = (static_cast<double>(i) + 0.5) / static_cast<double>(out.count);
    const double round = 2 * std::numbers::pi * std::numbers::phi * static_cast<double>(i), r = std::sqrt(1 - z * z);
    out.wave[i] = k * (turn * dvec3(r * std::cos(round), r * std::sin(round), z));
    out.phase[i] = 2 * std::numbers::pi * next_random(random);
  }
  return out;
}

double riding_share(double amplitude, double wavelength, double radius) {
  const double sinks = wavelength * wavelength / (8 * radius), whole = 2 * amplitude;  // [m] crest to trough
  if (!(radius > 0) || !(whole > 0)) return 1.0;
  const double ratio = whole / sinks;
  return std::pow(1 + ratio * ratio * ratio * ratio, -0.25);
}

}  // namespace pliant
