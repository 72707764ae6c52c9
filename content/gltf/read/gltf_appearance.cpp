#include "content/gltf/read/gltf_appearance.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/files/image.h"
#include "content/keys/json_integer.h"
#include "runtime/long_work.h"

namespace pliant {

namespace {

std::int32_t picture_of(const SourceDocument& document, std::size_t texture) {
  return document.model.textures[texture].source;
}

// The picture of the texture slot `holder[key]`; -1: none.
std::int32_t texture_of(const SourceDocument& document, const Json& holder, const char* key, Level& level) {
  if (!holder.contains(key)) return -1;
  const Json& info = holder[key];
  if (extension_of(info, "KHR_texture_transform"))
    level.notes.push_back("KHR_texture_transform is ignored: textures are laid as they are");
  if (value_of(info, "texCoord", 0) != 0)
    level.notes.push_back("textures on another set than TEXCOORD_0 use TEXCOORD_0");
  return picture_of(document, info["index"].get<std::size_t>());
}

// Height maps, which glTF lacks, in the material's extras: {"height_texture": {"index": n}, "height_scale": metres}.
// Other programs may use extras too; anything of another form is ignored.
void read_relief(const SourceDocument& document, const Json& json, Material& out) {
  if (!json.contains("extras") || !json["extras"].is_object()) return;
  const Json& extras = json["extras"];
  if (!extras.contains("height_texture") || !extras["height_texture"].is_object()) return;
  if (!extras.contains("height_scale") || !extras["height_scale"].is_number()) return;
  Json texture = extras["height_texture"];
  const float scale = extras["height_scale"].get<float>();
  if (!texture.contains("index") || !as_integer(texture["index"]) || !texture["index"].is_number_unsigned()) return;
  const std::size_t index = texture["index"].get<std::size_t>();
  if (index >= document.model.textures.size() || !(scale > 0.0f && scale < 1e3f)) return;
  out.height_texture = picture_of(document, index);
  out.height_scale = scale;
}

// Notes, once each, the parts of a material that are not drawn.
void note_undrawn(const Json& material, Level& level) {
  const auto say = [&](const std::string& sentence) {
    if (std::find(level.notes.begin(), level.notes.end(), sentence) == level.notes.end())
      level.notes.push_back(sentence);
  };
  for (const char* extension :
       {"KHR_materials_sheen", "KHR_materials_anisotropy", "KHR_materials_dispersion", "KHR_materials_iridescence",
        "KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness"})
    if (extension_of(material, extension)) say(std::string(extension) + " is not drawn");
  for (const char* extension :
       {"KHR_materials_specular", "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission"})
    if (const Json* found = extension_of(material, extension))
      for (const auto& [key, value] : found->items())
        if (key.ends_with("Texture")) say(fmt::format("{}: its textures are not drawn, its factors are", extension));
}

}  // namespace

Material material_of(const SourceDocument& document, std::size_t material, Level& level) {
  static const Json kEmpty = Json::object();
  const auto part = [&](const Json* found) -> const Json& { return found ? *found : kEmpty; };
  const tinygltf::Material& from = document.model.materials[material];
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  // Texture slots and extensions are read from the JSON; SourceDocument explains why.
  const Json& json = document.json["materials"][material];
  const Json& slots = json.contains("pbrMetallicRoughness") ? json["pbrMetallicRoughness"] : kEmpty;
  Material out;
  out.name = from.name;
  out.base_color = vector_of(pbr.baseColorFactor, vec4(1));
  out.metallic = static_cast<float>(pbr.metallicFactor);
  out.roughness = static_cast<float>(pbr.roughnessFactor);
  out.emissive = vector_of(from.emissiveFactor, vec3(0)) *
                 value_of(part(extension_of(json, "KHR_materials_emissive_strength")), "emissiveStrength", 1.0f);
  out.base_color_texture = texture_of(document, slots, "baseColorTexture", level);
  out.metallic_roughness_texture = texture_of(document, slots, "metallicRoughnessTexture", level);
  out.normal_texture = texture_of(document, json, "normalTexture", level);
  out.occlusion_texture = texture_of(document, json, "occlusionTexture", level);
  out.emissive_texture = texture_of(document, json, "emissiveTexture", level);
  read_relief(document, json, out);
  out.normal_scale = static_cast<float>(from.normalTexture.scale);
  out.occlusion_strength = static_cast<float>(from.occlusionTexture.strength);
  out.ior = value_of(part(extension_of(json, "KHR_materials_ior")), "ior", 1.5f);
  const Json& transmission = part(extension_of(json, "KHR_materials_transmission"));
  out.transmission = value_of(transmission, "transmissionFactor", 0.0f);
  out.transmission_texture = texture_of(document, transmission, "transmissionTexture", level);
  const Json& volume = part(extension_of(json, "KHR_materials_volume"));
  out.thickness = value_of(volume, "thicknessFactor", 0.0f);
  out.thickness_texture = texture_of(document, volume, "thicknessTexture", level);
  out.attenuation_color = vector_of(value_of(volume, "attenuationColor", std::vector<double>{}), vec3(1));
  out.attenuation_distance = value_of(volume, "attenuationDistance", 0.0f);
  const Json& specular = part(extension_of(json, "KHR_materials_specular"));
  out.specular = value_of(specular, "specularFactor", 1.0f);
  out.specular_color = vector_of(value_of(specular, "specularColorFactor", std::vector<double>{}), vec3(1));
  const Json& clearcoat = part(extension_of(json, "KHR_materials_clearcoat"));
  out.clearcoat = value_of(clearcoat, "clearcoatFactor", 0.0f);
  out.clearcoat_roughness = value_of(clearcoat, "clearcoatRoughnessFactor", 0.0f);
  const Json& diffuse = part(extension_of(json, "KHR_materials_diffuse_transmission"));
  out.diffuse_transmission = value_of(diffuse, "diffuseTransmissionFactor", 0.0f);
  out.diffuse_transmission_color =
      vector_of(value_of(diffuse, "diffuseTransmissionColorFactor", std::vector<double>{}), vec3(1));
  note_undrawn(json, level);
  out.alpha = from.alphaMode == "MASK"    ? Material::Alpha::kMask
              : from.alphaMode == "BLEND" ? Material::Alpha::kBlend
                                          : Material::Alpha::kOpaque;
  out.alpha_cutoff = static_cast<float>(from.alphaCutoff);
  out.double_sided = from.doubleSided;
  return out;
}

std::optional<Light> light_of(const SourceDocument& document, std::size_t node) {
  const Json* reference = extension_of(document.json["nodes"][node], "KHR_lights_punctual");
  if (!reference) return std::nullopt;
  const tinygltf::Light& from = document.model.lights[(*reference)["light"].get<std::size_t>()];
  Light out;
  if (from.type == "point")
    out.kind = Light::Kind::kPoint;
  else if (from.type == "spot")
    out.kind = Light::Kind::kSpot;
  else if (from.type != "directional")
    return std::nullopt;
  out.color = vector_of(from.color, vec3(1));
  out.intensity = static_cast<float>(from.intensity);
  out.range = static_cast<float>(from.range);
  if (out.kind == Light::Kind::kSpot) {
    out.inner_cone = static_cast<float>(from.spot.innerConeAngle);
    out.outer_cone = static_cast<float>(from.spot.outerConeAngle);
  }
  return out;
}

std::optional<Camera> camera_of(const SourceDocument& document, std::size_t node, Level& level) {
  const int number = document.model.nodes[node].camera;
  if (number < 0) return std::nullopt;
  const tinygltf::Camera& from = document.model.cameras[static_cast<std::size_t>(number)];
  if (from.type != "perspective") {
    level.notes.push_back("orthographic cameras are ignored");
    return std::nullopt;
  }
  Camera out;
  out.yfov = static_cast<float>(from.perspective.yfov);
  out.znear = static_cast<float>(from.perspective.znear);
  if (from.perspective.zfar > 0.0) out.zfar = static_cast<float>(from.perspective.zfar);
  return out;
}

Status read_images(const SourceDocument& document, Level& level) {
  // Check the total size before decoding the first picture: decoding takes about a second per hundred megabytes.
  std::uint64_t decoded = 0;
  for (const Bytes& image : document.images) decoded += decoded_size(image);
  if (decoded > most(limits::kPictures))
    return error_at("/images", beyond("make", limits::kPictures, static_cast<double>(decoded), "shrink the pictures"));
  for (std::size_t i = 0; i < document.images.size(); ++i) {
    std::string name = value_of<std::string>(document.json["images"][i], "name", "");
    if (document.images[i].empty()) {
      level.images.push_back({name, 1, 1, {255, 255, 255, 255}});
      continue;
    }
    check_in("reading pictures");
    Result<Image> image = decode_image(document.images[i], "picture");
    if (!image) return Error{fmt::format("/images/{}", i), image.error().message()};
    image->name = std::move(name);
    level.images.push_back(std::move(*image));
  }
  return Done{};
}

}  // namespace pliant
