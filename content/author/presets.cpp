#include "content/author/presets.h"

#include <algorithm>
#include <array>

#include "content/author/object_frame.h"
#include "content/author/touchable.h"
#include "content/keys/extensions.h"

namespace pliant {

namespace {

// Tissue is nearly incompressible (Poisson's ratio 0.49 and more). 0.45 is the largest value that linear tetrahedra
// take without locking (content/level/spawn_soft.h).
constexpr double kPoisson = 0.45;

constexpr std::array<TissuePreset, 7> kPresets{{
    {"liver",
     "Liver, healthy",
     5.6e3,
     3.2e3,
     8.5e3,
     kPoisson,
     1060.0,
     0.5,
     0.01,
     0.08,
     0.2,
     "Das et al. 2012, Hepatology 55:584: transient elastography of 437 healthy subjects, 5.6 kPa, 5th to 95th "
     "percentile 3.2 to 8.5 kPa",
     {0.36f, 0.085f, 0.060f},
     0.45f,
     0.8f,
     0.5f},
    {"fat",
     "Fat",
     3.25e3,
     2.3e3,
     4.2e3,
     kPoisson,
     950.0,
     0.5,
     0.02,
     0.10,
     0.2,
     "Samani, Zubovits and Plewes 2007, Phys. Med. Biol. 52:1565: indentation of excised breast fat, 3.25 +- 0.91 kPa",
     {0.80f, 0.56f, 0.20f},
     0.5f,
     0.5f,
     0.6f},
    {"muscle",
     "Muscle at rest",
     11e3,
     7e3,
     15e3,
     kPoisson,
     1050.0,
     0.5,
     0.01,
     0.06,
     0.3,
     "Arda et al. 2011, Am. J. Roentgenol. 197:532: shear wave elastography of the gastrocnemius at rest, 11.1 +- 4.1 "
     "kPa",
     {0.44f, 0.080f, 0.065f},
     0.5f,
     0.6f,
     0.5f},
    {"skin",
     "Skin over soft tissue",
     6.5e3,
     4.5e3,
     8e3,
     kPoisson,
     1090.0,
     0.5,
     0.01,
     0.06,
     0.5,
     "Pailler-Mattei, Bec and Zahouani 2008, Med. Eng. Phys. 30:599: indentation of the forearm in vivo, 4.5 to 8 kPa "
     "(stretching skin gives megapascals)",
     {0.76f, 0.47f, 0.36f},
     0.5f,
     0.0f,
     0.5f},
    {"gelatin-5",
     "Gelatin 5 %",
     12.5e3,
     10e3,
     15e3,
     kPoisson,
     1010.0,
     0.5,
     0.002,
     0.05,
     0.1,
     "Nguyen et al. 2014, Ultrasound Med. Biol. 40:168: shear wave elastography of 5 % gelatin, shear modulus 4.18 +- "
     "0.84 kPa, times three",
     {0.80f, 0.62f, 0.30f},
     0.35f,
     0.8f,
     0.9f},
    {"gelatin-10",
     "Gelatin 10 %",
     50e3,
     40e3,
     63e3,
     kPoisson,
     1020.0,
     0.5,
     0.002,
     0.05,
     0.1,
     "carried on from 5 to 7 % in Nguyen et al. 2014, Ultrasound Med. Biol. 40:168, by the square of the concentration "
     "(Hall et al. 1997, IEEE Trans. UFFC 44:1355)",
     {0.70f, 0.48f, 0.18f},
     0.35f,
     0.8f,
     0.8f},
    {"silicone",
     "Silicone rubber, very soft",
     69e3,
     55e3,
     125e3,
     kPoisson,
     1070.0,
     0.5,
     0.002,
     0.03,
     0.6,
     "Smooth-On, Ecoflex 00-30 technical bulletin: 10 psi at 100 % strain, specific gravity 1.07",
     {0.80f, 0.77f, 0.72f},
     0.45f,
     0.0f,
     0.6f},
}};

// Whether a preset may replace a material: none, plain grey without pictures, or the look of a preset.
bool is_plain(const Level& level, std::int32_t material) {
  if (material < 0 || static_cast<std::size_t>(material) >= level.materials.size()) return true;
  const Material& m = level.materials[static_cast<std::size_t>(material)];
  if (std::any_of(kPresets.begin(), kPresets.end(), [&](const TissuePreset& preset) { return m.name == preset.name; }))
    return true;
  const bool pictures = m.base_color_texture >= 0 || m.normal_texture >= 0 || m.metallic_roughness_texture >= 0 ||
                        m.occlusion_texture >= 0 || m.emissive_texture >= 0 || m.height_texture >= 0;
  return !pictures && m.base_color.r == m.base_color.g && m.base_color.g == m.base_color.b && m.metallic < 0.5f &&
         m.transmission == 0.0f && m.alpha == Material::Alpha::kOpaque && m.emissive == vec3(0);
}

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

Material look_of(const TissuePreset& preset, float thickness) {
  Material out;
  out.name = preset.name;
  out.base_color = vec4(preset.color, 1.0f);
  out.roughness = preset.roughness;
  out.clearcoat = preset.wet;
  out.clearcoat_roughness = 0.2f;
  out.diffuse_transmission = preset.scatter;
  out.diffuse_transmission_color = preset.color;
  out.thickness = thickness;
  out.attenuation_color = {0.8f, 0.45f, 0.35f};
  out.attenuation_distance = 0.002f;
  return out;
}

void add_look(Level& level, std::int32_t node, const TissuePreset& preset) {
  const std::int32_t mesh = level.nodes[static_cast<std::size_t>(node)].mesh;
  if (mesh < 0) return;
  const auto plain = [&](const Primitive& primitive) { return is_plain(level, primitive.material); };
  const std::vector<Primitive>& parts = level.meshes[static_cast<std::size_t>(mesh)].primitives;
  if (std::none_of(parts.begin(), parts.end(), plain)) return;
  const vec3 extent = world_box(level, node).size();
  const std::int32_t made = static_cast<std::int32_t>(level.materials.size());
  for (Primitive& primitive : own_mesh(level, node).primitives)
    if (plain(primitive)) primitive.material = made;
  level.materials.push_back(look_of(preset, std::min({extent.x, extent.y, extent.z})));
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
