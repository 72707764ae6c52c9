// A Material as glTF.
#include <algorithm>

#include "content/gltf/write/gltf_model_writer.h"

namespace pliant {

namespace {

tinygltf::Value value(float number) {
  return tinygltf::Value(static_cast<double>(number));
}
tinygltf::Value value(const vec3& v) {
  return tinygltf::Value(tinygltf::Value::Array{value(v.x), value(v.y), value(v.z)});
}
tinygltf::Value texture_value(std::int32_t image) {
  return tinygltf::Value(tinygltf::Value::Object{{"index", tinygltf::Value(image)}});
}

}  // namespace

void add_material(const Material& m, ModelWriter& writer) {
  tinygltf::Material out;
  out.name = m.name;
  out.pbrMetallicRoughness.baseColorFactor = numbers(m.base_color);
  out.pbrMetallicRoughness.metallicFactor = static_cast<double>(m.metallic);
  out.pbrMetallicRoughness.roughnessFactor = static_cast<double>(m.roughness);
  out.pbrMetallicRoughness.baseColorTexture.index = m.base_color_texture;
  out.pbrMetallicRoughness.metallicRoughnessTexture.index = m.metallic_roughness_texture;
  out.normalTexture.index = m.normal_texture;
  out.normalTexture.scale = static_cast<double>(m.normal_scale);
  out.occlusionTexture.index = m.occlusion_texture;
  out.occlusionTexture.strength = static_cast<double>(m.occlusion_strength);
  out.emissiveTexture.index = m.emissive_texture;
  if (m.height_texture >= 0)
    out.extras = tinygltf::Value(tinygltf::Value::Object{{"height_texture", texture_value(m.height_texture)},
                                                         {"height_scale", value(m.height_scale)}});
  // glTF limits the factor to 1. Brighter values are scaled by a power of two, which is exact.
  float strength = 1.0f;
  while (std::max({m.emissive.x, m.emissive.y, m.emissive.z}) > strength) strength *= 2.0f;
  out.emissiveFactor = numbers(m.emissive / strength);
  tinygltf::Value::Object emission, ior, transmission, volume, specular, clearcoat, diffuse;
  if (strength != 1.0f) emission["emissiveStrength"] = value(strength);
  if (m.ior != 1.5f) ior["ior"] = value(m.ior);
  if (m.transmission != 0.0f) transmission["transmissionFactor"] = value(m.transmission);
  if (m.transmission_texture >= 0) transmission["transmissionTexture"] = texture_value(m.transmission_texture);
  if (m.thickness != 0.0f) volume["thicknessFactor"] = value(m.thickness);
  if (m.thickness_texture >= 0) volume["thicknessTexture"] = texture_value(m.thickness_texture);
  if (m.attenuation_color != vec3(1)) volume["attenuationColor"] = value(m.attenuation_color);
  if (m.attenuation_distance != 0.0f) volume["attenuationDistance"] = value(m.attenuation_distance);
  if (m.specular != 1.0f) specular["specularFactor"] = value(m.specular);
  if (m.specular_color != vec3(1)) specular["specularColorFactor"] = value(m.specular_color);
  if (m.clearcoat != 0.0f) clearcoat["clearcoatFactor"] = value(m.clearcoat);
  if (m.clearcoat_roughness != 0.0f) clearcoat["clearcoatRoughnessFactor"] = value(m.clearcoat_roughness);
  if (m.diffuse_transmission != 0.0f) diffuse["diffuseTransmissionFactor"] = value(m.diffuse_transmission);
  if (m.diffuse_transmission_color != vec3(1))
    diffuse["diffuseTransmissionColorFactor"] = value(m.diffuse_transmission_color);
  writer.extend(out.extensions, "KHR_materials_specular", std::move(specular));
  writer.extend(out.extensions, "KHR_materials_clearcoat", std::move(clearcoat));
  writer.extend(out.extensions, "KHR_materials_diffuse_transmission", std::move(diffuse));
  writer.extend(out.extensions, "KHR_materials_emissive_strength", std::move(emission));
  writer.extend(out.extensions, "KHR_materials_ior", std::move(ior));
  writer.extend(out.extensions, "KHR_materials_transmission", std::move(transmission));
  writer.extend(out.extensions, "KHR_materials_volume", std::move(volume));
  if (m.alpha != Material::Alpha::kOpaque) out.alphaMode = m.alpha == Material::Alpha::kMask ? "MASK" : "BLEND";
  out.alphaCutoff = static_cast<double>(m.alpha_cutoff);
  out.doubleSided = m.double_sided;
  writer.model.materials.push_back(std::move(out));
}

}  // namespace pliant
