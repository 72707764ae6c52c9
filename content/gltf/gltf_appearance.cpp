#include "content/gltf/gltf_appearance.h"

#include <fmt/format.h>

#include "content/files/image.h"

namespace pliant {

namespace {

// The picture of a texture slot, -1: none.
std::int32_t texture_of(const SourceDocument& document, const Json& object, const char* key, Level& level) {
  if (!object.contains(key)) return -1;
  const Json& info = object[key];
  if (extension_of(info, "KHR_texture_transform"))
    level.notes.push_back("KHR_texture_transform is ignored: textures are laid as they are");
  if (value_of(info, "texCoord", 0) != 0)
    level.notes.push_back("textures on another set than TEXCOORD_0 use TEXCOORD_0");
  return value_of(document.json["textures"][info["index"].get<std::size_t>()], "source", -1);
}

// Relief that glTF has no place for, in the material's extras: {"height_texture": {"index": n}, "height_scale":
// metres}. Extras are anybody's: what does not have this form is not ours, and is left alone.
void read_relief(const SourceDocument& document, const Json& json, Material& out) {
  if (!json.contains("extras") || !json["extras"].is_object()) return;
  const Json& extras = json["extras"];
  if (!extras.contains("height_texture") || !extras["height_texture"].is_object()) return;
  if (!extras.contains("height_scale") || !extras["height_scale"].is_number()) return;
  const Json& texture = extras["height_texture"];
  const float scale = extras["height_scale"].get<float>();
  if (!texture.contains("index") || !texture["index"].is_number_unsigned() || !document.json.contains("textures"))
    return;
  const std::size_t index = texture["index"].get<std::size_t>();
  if (index >= document.json["textures"].size() || !(scale > 0.0f && scale < 1e3f)) return;
  out.height_texture = value_of(document.json["textures"][index], "source", -1);
  out.height_scale = scale;
}

}  // namespace

Material material_of(const SourceDocument& document, const Json& json, Level& level) {
  static const Json kEmpty = Json::object();
  const auto part = [&](const Json* found) -> const Json& { return found ? *found : kEmpty; };
  const Json& pbr = json.contains("pbrMetallicRoughness") ? json["pbrMetallicRoughness"] : kEmpty;
  Material out;
  out.name = value_of<std::string>(json, "name", "");
  out.base_color = vector_of(pbr, "baseColorFactor", vec4(1));
  out.metallic = value_of(pbr, "metallicFactor", 1.0f);
  out.roughness = value_of(pbr, "roughnessFactor", 1.0f);
  out.emissive = vector_of(json, "emissiveFactor", vec3(0)) *
                 value_of(part(extension_of(json, "KHR_materials_emissive_strength")), "emissiveStrength", 1.0f);
  out.base_color_texture = texture_of(document, pbr, "baseColorTexture", level);
  out.metallic_roughness_texture = texture_of(document, pbr, "metallicRoughnessTexture", level);
  out.normal_texture = texture_of(document, json, "normalTexture", level);
  out.occlusion_texture = texture_of(document, json, "occlusionTexture", level);
  out.emissive_texture = texture_of(document, json, "emissiveTexture", level);
  read_relief(document, json, out);
  if (json.contains("normalTexture")) out.normal_scale = value_of(json["normalTexture"], "scale", 1.0f);
  if (json.contains("occlusionTexture")) out.occlusion_strength = value_of(json["occlusionTexture"], "strength", 1.0f);
  out.ior = value_of(part(extension_of(json, "KHR_materials_ior")), "ior", 1.5f);
  const Json& transmission = part(extension_of(json, "KHR_materials_transmission"));
  out.transmission = value_of(transmission, "transmissionFactor", 0.0f);
  out.transmission_texture = texture_of(document, transmission, "transmissionTexture", level);
  const Json& volume = part(extension_of(json, "KHR_materials_volume"));
  out.thickness = value_of(volume, "thicknessFactor", 0.0f);
  out.thickness_texture = texture_of(document, volume, "thicknessTexture", level);
  out.attenuation_color = vector_of(volume, "attenuationColor", vec3(1));
  out.attenuation_distance = value_of(volume, "attenuationDistance", 0.0f);
  const std::string alpha = value_of<std::string>(json, "alphaMode", "OPAQUE");
  out.alpha = alpha == "MASK"    ? Material::Alpha::kMask
              : alpha == "BLEND" ? Material::Alpha::kBlend
                                 : Material::Alpha::kOpaque;
  out.alpha_cutoff = value_of(json, "alphaCutoff", 0.5f);
  out.double_sided = value_of(json, "doubleSided", false);
  return out;
}

std::optional<Light> light_of(const SourceDocument& document, const Json& node) {
  const Json* reference = extension_of(node, "KHR_lights_punctual");
  if (!reference) return std::nullopt;
  const Json& json =
      (*extension_of(document.json, "KHR_lights_punctual"))["lights"][(*reference)["light"].get<std::size_t>()];
  Light out;
  const std::string type = json["type"].get<std::string>();
  if (type == "point")
    out.kind = Light::Kind::kPoint;
  else if (type == "spot")
    out.kind = Light::Kind::kSpot;
  else if (type != "directional")
    return std::nullopt;
  out.color = vector_of(json, "color", vec3(1));
  out.intensity = value_of(json, "intensity", 1.0f);
  out.range = value_of(json, "range", 0.0f);
  if (out.kind == Light::Kind::kSpot) {
    out.inner_cone = value_of(json["spot"], "innerConeAngle", 0.0f);
    out.outer_cone = value_of(json["spot"], "outerConeAngle", 0.7853982f);
  }
  return out;
}

std::optional<Camera> camera_of(const SourceDocument& document, const Json& node, Level& level) {
  if (!node.contains("camera")) return std::nullopt;
  const Json& json = document.json["cameras"][node["camera"].get<std::size_t>()];
  if (!json.contains("perspective")) {
    level.notes.push_back("orthographic cameras are ignored");
    return std::nullopt;
  }
  Camera out;
  out.yfov = json["perspective"]["yfov"].get<float>();
  out.znear = json["perspective"]["znear"].get<float>();
  out.zfar = value_of(json["perspective"], "zfar", out.zfar);
  return out;
}

Status read_images(const SourceDocument& document, Level& level) {
  // All of them are looked at before the first is decoded: that takes a second for each hundred megabytes.
  std::uint64_t decoded = 0;
  for (const Bytes& image : document.images) decoded += decoded_size(image);
  if (decoded > most(limits::kPictures))
    return Error{"/images", "make " + beyond(limits::kPictures, static_cast<double>(decoded), "shrink the pictures")};
  const Json& images = array_of(document.json, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    std::string name = value_of<std::string>(images[i], "name", "");
    if (document.images[i].empty()) {
      level.images.push_back({name, 1, 1, {255, 255, 255, 255}});
      continue;
    }
    Result<Image> image = decode_image(document.images[i], "picture");
    if (!image) return Error{fmt::format("/images/{}", i), image.error().message()};
    image->name = std::move(name);
    level.images.push_back(std::move(*image));
  }
  return Done{};
}

}  // namespace pliant
