#include "content/author/presets.h"

#include <array>

#include "content/keys/extensions.h"

namespace pliant {

namespace {

// Tissue is nearly incompressible (Poisson's ratio 0.49 and more). 0.45 is the largest value that linear tetrahedra
// take without locking (content/level/spawn_soft.h).
constexpr double kPoisson = 0.45;

constexpr std::array<TissuePreset, 7> kPresets{{
    {"liver", "Liver, healthy", 5.6e3, 3.2e3, 8.5e3, kPoisson, 1060.0, 0.5, 0.01, 0.08, 0.2,
     "Das et al. 2012, Hepatology 55:584: transient elastography of 437 healthy subjects, 5.6 kPa, 5th to 95th "
     "percentile 3.2 to 8.5 kPa"},
    {"fat", "Fat", 3.25e3, 2.3e3, 4.2e3, kPoisson, 950.0, 0.5, 0.02, 0.10, 0.2,
     "Samani, Zubovits and Plewes 2007, Phys. Med. Biol. 52:1565: indentation of excised breast fat, 3.25 +- 0.91 kPa"},
    {"muscle", "Muscle at rest", 11e3, 7e3, 15e3, kPoisson, 1050.0, 0.5, 0.01, 0.06, 0.3,
     "Arda et al. 2011, Am. J. Roentgenol. 197:532: shear wave elastography of the gastrocnemius at rest, 11.1 +- 4.1 "
     "kPa"},
    {"skin", "Skin over soft tissue", 6.5e3, 4.5e3, 8e3, kPoisson, 1090.0, 0.5, 0.01, 0.06, 0.5,
     "Pailler-Mattei, Bec and Zahouani 2008, Med. Eng. Phys. 30:599: indentation of the forearm in vivo, 4.5 to 8 kPa "
     "(stretching skin gives megapascals)"},
    {"gelatin-5", "Gelatin 5 %", 12.5e3, 10e3, 15e3, kPoisson, 1010.0, 0.5, 0.002, 0.05, 0.1,
     "Nguyen et al. 2014, Ultrasound Med. Biol. 40:168: shear wave elastography of 5 % gelatin, shear modulus 4.18 +- "
     "0.84 kPa, times three"},
    {"gelatin-10", "Gelatin 10 %", 50e3, 40e3, 63e3, kPoisson, 1020.0, 0.5, 0.002, 0.05, 0.1,
     "carried on from 5 to 7 % in Nguyen et al. 2014, Ultrasound Med. Biol. 40:168, by the square of the concentration "
     "(Hall et al. 1997, IEEE Trans. UFFC 44:1355)"},
    {"silicone", "Silicone rubber, very soft", 69e3, 55e3, 125e3, kPoisson, 1070.0, 0.5, 0.002, 0.03, 0.6,
     "Smooth-On, Ecoflex 00-30 technical bulletin: 10 psi at 100 % strain, specific gravity 1.07"},
}};

}  // namespace

std::span<const TissuePreset> tissue_presets() {
  return kPresets;
}

const TissuePreset* find_preset(const std::string& word) {
  for (const TissuePreset& preset : kPresets)
    if (word == preset.word) return &preset;
  return nullptr;
}

double surface_stiffness(const TissuePreset& preset) {
  return calibrated_stiffness(preset.young, preset.poisson, 0.0);
}

SoftBodyParameters soft_body_of(const TissuePreset& preset) {
  SoftBodyParameters out;
  out.young = preset.young;
  out.poisson = preset.poisson;
  out.density = preset.density;
  out.rayleigh = {preset.alpha, preset.beta};
  out.friction_static = preset.friction;
  out.friction_sliding = kSliding * preset.friction;
  return out;
}

DeformableParameters surface_of(const TissuePreset& preset) {
  DeformableParameters out;
  out.young = preset.young;
  out.poisson = preset.poisson;
  out.stiffness = surface_stiffness(preset);
  out.settling_time = preset.settling;
  out.friction_static = preset.friction;
  out.friction_sliding = kSliding * preset.friction;
  return out;
}

}  // namespace pliant
