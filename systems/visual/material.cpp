#include "systems/visual/material.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include "systems/visual/frame.h"

namespace pliant {
namespace {

// Block MaterialOf of shaders/material.glsl.
struct MaterialConstants {
  vec4 base_color, emissive, numbers, coat, volume, absorption, specular, scatter, behind;
};

// Light that enters a body leaves it again within its mean free path. Round a body of this thickness it wraps by the
// ratio of the two (docs/reference.md). A thin sheet (no thickness) returns less and lets the rest through.
void scatter_of(const Material& m, vec3 absorption, MaterialConstants& out) {
  const float through = m.diffuse_transmission;
  if (through <= 0) return;
  if (m.thickness <= 0) {
    out.specular.w = through;
    out.behind = vec4(through * m.diffuse_transmission_color, 0);
    return;
  }
  const vec3 free_path = 1.0f / glm::max(absorption, vec3(1e-3f));  // [m]
  out.scatter = vec4(through * free_path / (free_path + m.thickness), 1);
  out.behind = vec4(through * m.diffuse_transmission_color * glm::exp(-absorption * m.thickness), 0);
}

MaterialConstants constants_of(const Material& m) {
  const float straight_on = (m.ior - 1) / (m.ior + 1);
  const bool absorbs = m.attenuation_distance > 0;
  const vec3 absorption =
      absorbs ? -glm::log(glm::max(m.attenuation_color, vec3(1e-4f))) / m.attenuation_distance : vec3(0);
  const bool relief = m.height_texture >= 0;
  MaterialConstants out{
      .base_color = m.base_color,
      .emissive = vec4(m.emissive, m.alpha == Material::Alpha::kMask ? m.alpha_cutoff : 0.0f),
      .numbers = {m.metallic, m.roughness, m.normal_scale, m.occlusion_strength},
      .coat = {m.alpha == Material::Alpha::kBlend ? 1.0f : 0.0f, m.clearcoat, relief ? m.height_scale : 0.0f,
               m.clearcoat_roughness},
      .volume = {m.transmission, std::max(m.ior, 1.0f), m.thickness, 0},
      .absorption = vec4(absorption, 0),
      .specular = vec4(m.specular * glm::min(straight_on * straight_on * m.specular_color, vec3(1)), 0),
      .scatter = vec4(0),
      .behind = vec4(0)};
  scatter_of(m, absorption, out);
  return out;
}

// A mostly transparent material casts no shadow worth drawing.
bool leaves_shadow(const Material& m) {
  return m.transmission < 0.5f && (m.alpha != Material::Alpha::kBlend || m.base_color.a >= 0.5f);
}

// The default material: tissue-like, slightly wet, so that dents are visible.
Material default_material() {
  Material m;
  m.base_color = {0.60f, 0.20f, 0.16f, 1.0f};
  m.roughness = 0.38f;
  m.double_sided = true;
  return m;
}

}  // namespace

Result<Materials> Materials::make(const World& world) {
  Materials made;
  made.textures_.push_back(gpu::Texture::constant(255, 255, 255));  // a factor of one
  made.textures_.push_back(gpu::Texture::constant(128, 128, 255));  // a flat normal map
  constexpr int kOne = 0, kFlat = 1;

  // An image may serve as colour and as data: then it is uploaded as both.
  std::map<std::pair<std::int32_t, gpu::Meaning>, int> known;
  Status uploaded = Done{};
  auto texture = [&](std::int32_t image, gpu::Meaning meaning, int otherwise) {
    if (image < 0 || static_cast<std::size_t>(image) >= world.images.size()) return otherwise;
    const auto key = std::make_pair(image, meaning);
    if (const auto found = known.find(key); found != known.end()) return found->second;
    Result<gpu::Texture> made_texture =
        gpu::Texture::from_image(world.images[static_cast<std::size_t>(image)], meaning);
    if (!made_texture) {
      uploaded = made_texture.error();
      return otherwise;
    }
    made.textures_.push_back(*std::move(made_texture));
    return known[key] = static_cast<int>(made.textures_.size() - 1);
  };

  GLint alignment = 1;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  const std::size_t step = static_cast<std::size_t>(alignment);
  made.stride_ = (sizeof(MaterialConstants) + step - 1) / step * step;
  std::vector<std::byte> bytes((world.materials.size() + 1) * made.stride_);
  for (std::size_t i = 0; i <= world.materials.size(); ++i) {
    const Material m = i < world.materials.size() ? world.materials[i] : default_material();
    const MaterialConstants constants = constants_of(m);
    std::memcpy(&bytes[i * made.stride_], &constants, sizeof constants);
    made.entries_.push_back({.base_color = texture(m.base_color_texture, gpu::Meaning::kColor, kOne),
                             .roughness = texture(m.metallic_roughness_texture, gpu::Meaning::kData, kOne),
                             .normal = texture(m.normal_texture, gpu::Meaning::kData, kFlat),
                             .occlusion = texture(m.occlusion_texture, gpu::Meaning::kData, kOne),
                             .emissive = texture(m.emissive_texture, gpu::Meaning::kColor, kOne),
                             .height = texture(m.height_texture, gpu::Meaning::kData, kOne),
                             .transmission = texture(m.transmission_texture, gpu::Meaning::kData, kOne),
                             .thickness = texture(m.thickness_texture, gpu::Meaning::kData, kOne),
                             .casts = leaves_shadow(m),
                             .blends = m.alpha == Material::Alpha::kBlend,
                             .double_sided = m.double_sided,
                             .transmits = m.transmission > 0.0f && m.alpha != Material::Alpha::kBlend});
  }
  if (!uploaded) return uploaded.error();
  made.constants_ = gpu::Buffer::fixed(bytes.data(), bytes.size());
  return made;
}

std::size_t Materials::row(std::int32_t index) const {
  const std::size_t last = entries_.size() - 1;
  return index < 0 ? last : std::min(static_cast<std::size_t>(index), last);
}

const Materials::Entry& Materials::entry(std::int32_t index) const {
  return entries_[row(index)];
}

void Materials::bind(std::int32_t index) const {
  const Entry& e = entry(index);
  glBindBufferRange(GL_UNIFORM_BUFFER, kMaterialBinding, constants_.id(), static_cast<GLintptr>(row(index) * stride_),
                    sizeof(MaterialConstants));
  textures_[static_cast<std::size_t>(e.base_color)].bind(kBaseColorUnit);
  textures_[static_cast<std::size_t>(e.roughness)].bind(kRoughnessUnit);
  textures_[static_cast<std::size_t>(e.normal)].bind(kNormalUnit);
  textures_[static_cast<std::size_t>(e.occlusion)].bind(kOcclusionUnit);
  textures_[static_cast<std::size_t>(e.emissive)].bind(kEmissiveUnit);
  textures_[static_cast<std::size_t>(e.height)].bind(kHeightUnit);
  textures_[static_cast<std::size_t>(e.transmission)].bind(kTransmissionUnit);
  textures_[static_cast<std::size_t>(e.thickness)].bind(kThicknessUnit);
}

}  // namespace pliant
