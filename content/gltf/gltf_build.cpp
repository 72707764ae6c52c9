// A Level that did not come from glTF, as glTF. What load_level reads of the result is the Level again, bit for bit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "content/files/image.h"
#include "content/gltf/gltf_accessor.h"
#include "content/gltf/gltf_save.h"
#include "content/mesh/painted.h"

namespace pliant {

namespace {

template <class Vector>
Json numbers(const Vector& v) {
  Json out = Json::array();
  for (int i = 0; i < Vector::length(); ++i) out.push_back(v[i]);
  return out;
}

class Builder {
 public:
  explicit Builder(const Level& level) : level_(level) {}

  Result<SourceDocument> build() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "pliant"}};
    if (!level_.about.empty()) json_["asset"]["extras"] = {{"about", level_.about}};
    images();
    for (const Material& material : level_.materials) json_["materials"].push_back(material_json(material));
    for (const LevelMesh& mesh : level_.meshes)
      if (const Status status = add_mesh(mesh); !status) return status.error();
    nodes();
    animations();
    SourceDocument document;
    if (!bytes_.empty()) {
      json_["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
      document.buffers.push_back(std::move(bytes_));
    }
    for (std::size_t i = 0; i < level_.nodes.size(); ++i) document.json_node.push_back(static_cast<std::int32_t>(i));
    document.images = std::move(images_);
    document.json = std::move(json_);
    return document;
  }

 private:
  void images() {
    for (std::size_t i = 0; i < level_.images.size(); ++i) {
      const Image& image = level_.images[i];
      images_.push_back(encode_png(image.width, image.height, image.rgba.data()));
      // The packer gives it a bufferView.
      Json json = {{"mimeType", "image/png"}};
      if (!image.name.empty()) json["name"] = image.name;
      json_["images"].push_back(std::move(json));
      json_["textures"].push_back({{"source", i}});
    }
  }

  static void set_texture(Json& json, const char* key, std::int32_t image) {
    if (image >= 0) json[key] = {{"index", image}};
  }

  Json material_json(const Material& m) {
    Json json = Json::object();
    if (!m.name.empty()) json["name"] = m.name;
    Json& pbr = json["pbrMetallicRoughness"];
    pbr = {
        {"baseColorFactor", numbers(m.base_color)}, {"metallicFactor", m.metallic}, {"roughnessFactor", m.roughness}};
    set_texture(pbr, "baseColorTexture", m.base_color_texture);
    set_texture(pbr, "metallicRoughnessTexture", m.metallic_roughness_texture);
    set_texture(json, "normalTexture", m.normal_texture);
    set_texture(json, "occlusionTexture", m.occlusion_texture);
    set_texture(json, "emissiveTexture", m.emissive_texture);
    if (m.height_texture >= 0)
      json["extras"] = {{"height_texture", {{"index", m.height_texture}}}, {"height_scale", m.height_scale}};
    if (m.normal_texture >= 0) json["normalTexture"]["scale"] = m.normal_scale;
    if (m.occlusion_texture >= 0) json["occlusionTexture"]["strength"] = m.occlusion_strength;
    // glTF's factor ends at 1; what is brighter is scaled by a power of two, which loses no bit.
    float strength = 1.0f;
    while (std::max({m.emissive.x, m.emissive.y, m.emissive.z}) > strength) strength *= 2.0f;
    if (m.emissive != vec3(0)) json["emissiveFactor"] = numbers(m.emissive / strength);
    if (strength != 1.0f) extend(json, "KHR_materials_emissive_strength", {{"emissiveStrength", strength}});
    if (m.ior != 1.5f) extend(json, "KHR_materials_ior", {{"ior", m.ior}});
    Json transmission = Json::object();
    if (m.transmission != 0.0f) transmission["transmissionFactor"] = m.transmission;
    set_texture(transmission, "transmissionTexture", m.transmission_texture);
    if (!transmission.empty()) extend(json, "KHR_materials_transmission", transmission);
    Json volume = Json::object();
    if (m.thickness != 0.0f) volume["thicknessFactor"] = m.thickness;
    set_texture(volume, "thicknessTexture", m.thickness_texture);
    if (m.attenuation_color != vec3(1)) volume["attenuationColor"] = numbers(m.attenuation_color);
    if (m.attenuation_distance != 0.0f) volume["attenuationDistance"] = m.attenuation_distance;
    if (!volume.empty()) extend(json, "KHR_materials_volume", volume);
    if (m.alpha != Material::Alpha::kOpaque) json["alphaMode"] = m.alpha == Material::Alpha::kMask ? "MASK" : "BLEND";
    if (m.alpha_cutoff != 0.5f) json["alphaCutoff"] = m.alpha_cutoff;
    if (m.double_sided) json["doubleSided"] = true;
    return json;
  }

  void extend(Json& object, const char* name, Json value) {
    object["extensions"][name] = std::move(value);
    declare_extension(json_, name, false);
  }

  // Appends an array to the buffer as a bufferView and an accessor of its own.
  std::size_t add_accessor(const void* data, std::size_t count, std::size_t element, int component, const char* type,
                           int target) {
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", count * element}});
    if (target != 0) json_["bufferViews"].back()["target"] = target;
    bytes_.insert(bytes_.end(), begin, begin + count * element);
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", component},
                                  {"count", count},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
  }
  template <class T>
  std::size_t add_attribute(const std::vector<T>& values, const char* type) {
    return add_accessor(values.data(), values.size(), sizeof(T), kFloat, type, 34962);
  }

  bool has_textures(std::int32_t material) const {
    if (material < 0 || material >= static_cast<std::int32_t>(level_.materials.size())) return false;
    const Material& m = level_.materials[static_cast<std::size_t>(material)];
    return std::max({m.base_color_texture, m.metallic_roughness_texture, m.normal_texture, m.occlusion_texture,
                     m.emissive_texture, m.height_texture}) >= 0;
  }

  Status add_mesh(const LevelMesh& mesh) {
    Json primitives = Json::array();
    for (const Primitive& primitive : mesh.primitives) {
      if (primitive.index.empty() || primitive.position.empty()) continue;
      const std::size_t count = primitive.position.size();
      const auto fits = [&](const auto& values) { return values.empty() || values.size() == count; };
      if (!fits(primitive.normal) || !fits(primitive.tangent) || !fits(primitive.uv) || !fits(primitive.stiffness) ||
          !fits(primitive.friction) || !fits(primitive.damping) || !fits(primitive.relaxation) ||
          !fits(primitive.pinned) || !fits(primitive.handle))
        return Error{mesh.name, "has attributes of different lengths and cannot be saved"};
      Box box;
      for (const vec3 p : primitive.position) {
        if (!std::isfinite(p.x + p.y + p.z))
          return Error{mesh.name, "has a position that is not finite and cannot be saved"};
        box.add(p);
      }
      Json json;
      Json& attributes = json["attributes"];
      const std::size_t position = add_attribute(primitive.position, "VEC3");
      json_["accessors"][position]["min"] = numbers(box.min);
      json_["accessors"][position]["max"] = numbers(box.max);
      attributes["POSITION"] = position;
      if (!primitive.normal.empty()) attributes["NORMAL"] = add_attribute(primitive.normal, "VEC3");
      if (!primitive.tangent.empty()) attributes["TANGENT"] = add_attribute(primitive.tangent, "VEC4");
      if (!primitive.uv.empty()) attributes["TEXCOORD_0"] = add_attribute(primitive.uv, "VEC2");
      // A textured material on a primitive without coordinates is not glTF: all of it takes the texture's corner.
      else if (has_textures(primitive.material))
        attributes["TEXCOORD_0"] = add_attribute(std::vector<vec2>(count, vec2(0)), "VEC2");
      for (const PaintedAttribute& painted : kPainted)
        if (const std::vector<float>& values = primitive.*painted.values; !values.empty())
          attributes[painted.name] = add_attribute(values, "SCALAR");
      if (count < 65535) {
        const std::vector<std::uint16_t> small(primitive.index.begin(), primitive.index.end());
        json["indices"] = add_accessor(small.data(), small.size(), 2, kUnsignedShort, "SCALAR", 34963);
      } else {
        json["indices"] =
            add_accessor(primitive.index.data(), primitive.index.size(), 4, kUnsignedInt, "SCALAR", 34963);
      }
      if (primitive.material >= 0) json["material"] = primitive.material;
      primitives.push_back(std::move(json));
    }
    if (primitives.empty()) {  // glTF has no mesh without primitives
      mesh_number_.push_back(-1);
      return Done{};
    }
    mesh_number_.push_back(static_cast<std::int32_t>(json_["meshes"].size()));
    json_["meshes"].push_back({{"primitives", std::move(primitives)}});
    if (!mesh.name.empty()) json_["meshes"].back()["name"] = mesh.name;
    return Done{};
  }

  void nodes() {
    Json roots = Json::array();
    for (std::size_t i = 0; i < level_.nodes.size(); ++i) {
      const LevelNode& node = level_.nodes[i];
      Json json = transform_json(node.local);
      json["name"] = node.name;
      if (!node.children.empty()) json["children"] = node.children;
      if (node.mesh >= 0 && mesh_number_[static_cast<std::size_t>(node.mesh)] >= 0)
        json["mesh"] = mesh_number_[static_cast<std::size_t>(node.mesh)];
      if (node.light) extend(json, "KHR_lights_punctual", {{"light", add_light(*node.light)}});
      if (node.camera) {
        const Camera& camera = *node.camera;
        json_["cameras"].push_back(
            {{"type", "perspective"},
             {"perspective", {{"yfov", camera.yfov}, {"znear", camera.znear}, {"zfar", camera.zfar}}}});
        json["camera"] = json_["cameras"].size() - 1;
      }
      if (node.parent < 0 && node.in_scene) roots.push_back(i);
      json_["nodes"].push_back(std::move(json));
    }
    json_["scenes"] = Json::array({roots.empty() ? Json::object() : Json{{"nodes", roots}}});
    json_["scene"] = 0;
  }

  std::size_t add_light(const Light& light) {
    constexpr const char* kTypes[] = {"directional", "point", "spot"};
    Json json = {{"type", kTypes[static_cast<std::size_t>(light.kind)]},
                 {"color", numbers(light.color)},
                 {"intensity", light.intensity}};
    if (light.range > 0.0f) json["range"] = light.range;
    if (light.kind == Light::Kind::kSpot)
      json["spot"] = {{"innerConeAngle", light.inner_cone}, {"outerConeAngle", light.outer_cone}};
    Json& lights = json_["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(json));
    return lights.size() - 1;
  }

  // Every channel has accessors of its own; the times' bounds are as glTF wants them.
  void animations() {
    constexpr const char* kPaths[] = {"translation", "rotation", "scale"};
    constexpr const char* kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    for (const LevelAnimation& animation : level_.animations) {
      Json json = {{"channels", Json::array()}, {"samplers", Json::array()}};
      if (!animation.name.empty()) json["name"] = animation.name;
      for (const LevelChannel& channel : animation.channels) {
        const Track& track = channel.track;
        const bool turns = channel.property == NodeProperty::kRotation;
        const std::vector<float> times(track.times.begin(), track.times.end());
        std::vector<float> values;
        for (const glm::dvec4& value : track.values)
          for (int i = 0; i < (turns ? 4 : 3); ++i) values.push_back(static_cast<float>(value[i]));
        const std::size_t input = add_accessor(times.data(), times.size(), 4, kFloat, "SCALAR", 0);
        json_["accessors"][input]["min"] = Json::array({times.front()});
        json_["accessors"][input]["max"] = Json::array({times.back()});
        const std::size_t output = turns ? add_accessor(values.data(), track.values.size(), 16, kFloat, "VEC4", 0)
                                         : add_accessor(values.data(), track.values.size(), 12, kFloat, "VEC3", 0);
        json["channels"].push_back({{"sampler", json["samplers"].size()},
                                    {"target", {{"node", channel.node}, {"path", kPaths[int(channel.property)]}}}});
        json["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", kInterpolations[int(track.interpolation)]}});
      }
      if (!json["channels"].empty()) json_["animations"].push_back(std::move(json));
    }
  }

  const Level& level_;
  Json json_;
  Bytes bytes_;
  std::vector<Bytes> images_;
  std::vector<std::int32_t> mesh_number_;  // Level mesh -> /meshes/i, -1: empty
};

}  // namespace

void declare_extension(Json& json, const std::string& name, bool required) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (list == std::string("extensionsRequired") && !required) continue;
    Json& names = json[list];
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
}

Json transform_json(const LocalTransform& local) {
  Json json = Json::object();
  const quat& q = local.rotation;
  if (local.translation != vec3(0)) json["translation"] = numbers(local.translation);
  if (q != quat(1, 0, 0, 0)) json["rotation"] = Json::array({q.x, q.y, q.z, q.w});
  if (local.scale != vec3(1)) json["scale"] = numbers(local.scale);
  return json;
}

Result<SourceDocument> build_document(const Level& level) {
  return Builder(level).build();
}

}  // namespace pliant
