// Writes a Level that was not loaded from glTF as glTF. load_level reads back the same Level, bit for bit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "content/files/image.h"
#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_model.h"
#include "content/gltf/write/gltf_save.h"
#include "content/mesh/painted.h"

namespace pliant {

namespace {

template <class Vector>
std::vector<double> numbers(const Vector& v) {
  std::vector<double> out;
  for (int i = 0; i < Vector::length(); ++i) out.push_back(static_cast<double>(v[i]));
  return out;
}

tinygltf::Value value(float number) {
  return tinygltf::Value(static_cast<double>(number));
}
tinygltf::Value value(const vec3& v) {
  return tinygltf::Value(tinygltf::Value::Array{value(v.x), value(v.y), value(v.z)});
}
tinygltf::Value texture_value(std::int32_t image) {
  return tinygltf::Value(tinygltf::Value::Object{{"index", tinygltf::Value(image)}});
}

class Builder {
 public:
  explicit Builder(const Level& level) : level_(level) {}

  Result<SourceDocument> build() {
    model_.asset.generator = "pliant";
    if (!level_.about.empty())
      model_.asset.extras = tinygltf::Value(tinygltf::Value::Object{{"about", tinygltf::Value(level_.about)}});
    for (const Material& material : level_.materials) add_material(material);
    for (const LevelMesh& mesh : level_.meshes)
      if (const Status status = add_mesh(mesh); !status) return status.error();
    nodes();
    animations();
    images();
    return document();
  }

  Result<BuiltParts> build(const LevelParts& parts) {
    for (std::size_t m = parts.first_material; m < level_.materials.size(); ++m) add_material(level_.materials[m]);
    for (const std::size_t m : parts.meshes)
      if (const Status status = add_mesh(level_.meshes[m]); !status) return status.error();
    for (const std::size_t a : parts.animations) add_animation(level_.animations[a]);
    images(parts.first_image);
    return BuiltParts{document(), std::move(mesh_number_)};
  }

 private:
  SourceDocument document() {
    SourceDocument out;
    out.json = model_as_json(model_);
    if (!bytes_.empty()) {
      out.json["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
      out.buffers.push_back(std::move(bytes_));
    }
    out.images.resize(model_.images.size());  // stored in the buffer
    out.model = std::move(model_);
    return out;
  }

  // Texture i uses picture i.
  void images(std::size_t first = 0) {
    for (std::size_t i = first; i < level_.images.size(); ++i) {
      const Image& image = level_.images[i];
      const Bytes png = encode_png(image.width, image.height, image.rgba.data());
      tinygltf::Image out;
      out.name = image.name;
      out.mimeType = "image/png";
      out.bufferView = add_view(png.data(), png.size(), 0);
      tinygltf::Texture texture;
      texture.source = static_cast<int>(model_.images.size());
      model_.images.push_back(std::move(out));
      model_.textures.push_back(std::move(texture));
    }
  }

  void add_material(const Material& m) {
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
    tinygltf::Value::Object emission, ior, transmission, volume;
    if (strength != 1.0f) emission["emissiveStrength"] = value(strength);
    if (m.ior != 1.5f) ior["ior"] = value(m.ior);
    if (m.transmission != 0.0f) transmission["transmissionFactor"] = value(m.transmission);
    if (m.transmission_texture >= 0) transmission["transmissionTexture"] = texture_value(m.transmission_texture);
    if (m.thickness != 0.0f) volume["thicknessFactor"] = value(m.thickness);
    if (m.thickness_texture >= 0) volume["thicknessTexture"] = texture_value(m.thickness_texture);
    if (m.attenuation_color != vec3(1)) volume["attenuationColor"] = value(m.attenuation_color);
    if (m.attenuation_distance != 0.0f) volume["attenuationDistance"] = value(m.attenuation_distance);
    extend(out.extensions, "KHR_materials_emissive_strength", std::move(emission));
    extend(out.extensions, "KHR_materials_ior", std::move(ior));
    extend(out.extensions, "KHR_materials_transmission", std::move(transmission));
    extend(out.extensions, "KHR_materials_volume", std::move(volume));
    if (m.alpha != Material::Alpha::kOpaque) out.alphaMode = m.alpha == Material::Alpha::kMask ? "MASK" : "BLEND";
    out.alphaCutoff = static_cast<double>(m.alpha_cutoff);
    out.doubleSided = m.double_sided;
    model_.materials.push_back(std::move(out));
  }

  // All values are defaults: no extension.
  void extend(tinygltf::ExtensionMap& extensions, const char* name, tinygltf::Value::Object members) {
    if (members.empty()) return;
    extensions[name] = tinygltf::Value(std::move(members));
    std::vector<std::string>& used = model_.extensionsUsed;
    if (std::find(used.begin(), used.end(), name) == used.end()) used.emplace_back(name);
  }

  // Appends an array to the buffer in a new bufferView.
  int add_view(const void* data, std::size_t size, int target) {
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes_.size();
    view.byteLength = size;
    view.target = target;
    bytes_.insert(bytes_.end(), begin, begin + size);
    model_.bufferViews.push_back(std::move(view));
    return static_cast<int>(model_.bufferViews.size() - 1);
  }
  // Appends an array with an accessor.
  int add_accessor(const void* data, std::size_t count, std::size_t element, int component, int type, int target) {
    tinygltf::Accessor accessor;
    accessor.bufferView = add_view(data, count * element, target);
    accessor.componentType = component;
    accessor.count = count;
    accessor.type = type;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size() - 1);
  }
  template <class T>
  int add_attribute(const std::vector<T>& values, int type) {
    return add_accessor(values.data(), values.size(), sizeof(T), kFloat, type, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
  void set_bounds(int accessor, std::vector<double> low, std::vector<double> high) {
    model_.accessors[static_cast<std::size_t>(accessor)].minValues = std::move(low);
    model_.accessors[static_cast<std::size_t>(accessor)].maxValues = std::move(high);
  }

  bool has_textures(std::int32_t material) const {
    if (material < 0 || material >= static_cast<std::int32_t>(level_.materials.size())) return false;
    const Material& m = level_.materials[static_cast<std::size_t>(material)];
    return std::max({m.base_color_texture, m.metallic_roughness_texture, m.normal_texture, m.occlusion_texture,
                     m.emissive_texture, m.height_texture}) >= 0;
  }

  Status add_mesh(const LevelMesh& mesh) {
    tinygltf::Mesh out;
    out.name = mesh.name;
    for (const Primitive& primitive : mesh.primitives) {
      if (primitive.index.empty() || primitive.position.empty()) continue;
      const std::size_t count = primitive.position.size();
      const auto fits = [&](const auto& values) { return values.empty() || values.size() == count; };
      if (!fits(primitive.normal) || !fits(primitive.tangent) || !fits(primitive.uv) || !fits(primitive.stiffness) ||
          !fits(primitive.friction) || !fits(primitive.damping) || !fits(primitive.relaxation) ||
          !fits(primitive.pinned) || !fits(primitive.handle))
        return Error{mesh.name, "has attributes of different lengths and cannot be saved",
                     "give each one value a vertex"};
      Box box;
      for (const vec3 p : primitive.position) {
        if (!std::isfinite(p.x + p.y + p.z))
          return Error{mesh.name, "has a position that is not finite and cannot be saved", "repair the mesh"};
        box.add(p);
      }
      tinygltf::Primitive made;
      std::map<std::string, int>& attributes = made.attributes;
      attributes["POSITION"] = add_attribute(primitive.position, TINYGLTF_TYPE_VEC3);
      set_bounds(attributes["POSITION"], numbers(box.min), numbers(box.max));
      if (!primitive.normal.empty()) attributes["NORMAL"] = add_attribute(primitive.normal, TINYGLTF_TYPE_VEC3);
      if (!primitive.tangent.empty()) attributes["TANGENT"] = add_attribute(primitive.tangent, TINYGLTF_TYPE_VEC4);
      if (!primitive.uv.empty()) attributes["TEXCOORD_0"] = add_attribute(primitive.uv, TINYGLTF_TYPE_VEC2);
      // glTF requires texture coordinates for a textured material: without any, all are (0, 0).
      else if (has_textures(primitive.material))
        attributes["TEXCOORD_0"] = add_attribute(std::vector<vec2>(count, vec2(0)), TINYGLTF_TYPE_VEC2);
      for (const PaintedAttribute& painted : kPainted)
        if (const std::vector<float>& values = primitive.*painted.values; !values.empty())
          attributes[painted.name] = add_attribute(values, TINYGLTF_TYPE_SCALAR);
      const std::vector<std::uint32_t>& index = primitive.index;
      if (count < 65535) {
        const std::vector<std::uint16_t> small(index.begin(), index.end());
        made.indices = add_accessor(small.data(), small.size(), 2, kUnsignedShort, TINYGLTF_TYPE_SCALAR,
                                    TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
      } else {
        made.indices = add_accessor(index.data(), index.size(), 4, kUnsignedInt, TINYGLTF_TYPE_SCALAR,
                                    TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
      }
      made.material = primitive.material;
      made.mode = TINYGLTF_MODE_TRIANGLES;
      out.primitives.push_back(std::move(made));
    }
    if (out.primitives.empty()) {  // a glTF mesh needs at least one primitive
      mesh_number_.push_back(-1);
      return Done{};
    }
    mesh_number_.push_back(static_cast<std::int32_t>(model_.meshes.size()));
    model_.meshes.push_back(std::move(out));
    return Done{};
  }

  void nodes() {
    tinygltf::Scene scene;
    for (std::size_t i = 0; i < level_.nodes.size(); ++i) {
      const LevelNode& node = level_.nodes[i];
      tinygltf::Node out;
      const quat& q = node.local.rotation;
      if (node.local.translation != vec3(0)) out.translation = numbers(node.local.translation);
      if (q != quat(1, 0, 0, 0)) out.rotation = numbers(vec4(q.x, q.y, q.z, q.w));
      if (node.local.scale != vec3(1)) out.scale = numbers(node.local.scale);
      out.name = node.name;
      out.children.assign(node.children.begin(), node.children.end());
      if (node.mesh >= 0) out.mesh = mesh_number_[static_cast<std::size_t>(node.mesh)];
      if (node.light) {
        add_light(*node.light);
        extend(out.extensions, "KHR_lights_punctual",
               {{"light", tinygltf::Value(static_cast<int>(model_.lights.size() - 1))}});
      }
      if (node.camera) {
        tinygltf::Camera camera;
        camera.type = "perspective";
        camera.perspective.yfov = static_cast<double>(node.camera->yfov);
        camera.perspective.znear = static_cast<double>(node.camera->znear);
        camera.perspective.zfar = static_cast<double>(node.camera->zfar);
        out.camera = static_cast<int>(model_.cameras.size());
        model_.cameras.push_back(std::move(camera));
      }
      if (node.parent < 0 && node.in_scene) scene.nodes.push_back(static_cast<int>(i));
      model_.nodes.push_back(std::move(out));
    }
    model_.scenes.push_back(std::move(scene));
    model_.defaultScene = 0;
  }

  void add_light(const Light& light) {
    constexpr const char* kTypes[] = {"directional", "point", "spot"};
    tinygltf::Light out;
    out.type = kTypes[static_cast<std::size_t>(light.kind)];
    out.color = numbers(light.color);
    out.intensity = static_cast<double>(light.intensity);
    out.range = static_cast<double>(std::max(light.range, 0.0f));
    out.spot.innerConeAngle = static_cast<double>(light.inner_cone);
    out.spot.outerConeAngle = static_cast<double>(light.outer_cone);
    model_.lights.push_back(std::move(out));
  }

  // Every channel has its own accessors, with the bounds of times that glTF requires.
  void animations() {
    for (const LevelAnimation& animation : level_.animations) add_animation(animation);
  }
  void add_animation(const LevelAnimation& animation) {
    constexpr const char* kPaths[] = {"translation", "rotation", "scale"};
    constexpr const char* kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    tinygltf::Animation out;
    out.name = animation.name;
    for (const LevelChannel& from : animation.channels) {
      const Track& track = from.track;
      const bool turns = from.property == NodeProperty::kRotation;
      const std::vector<float> times(track.times.begin(), track.times.end());
      std::vector<float> values;
      for (const glm::dvec4& key : track.values)
        for (int i = 0; i < (turns ? 4 : 3); ++i) values.push_back(static_cast<float>(key[i]));
      tinygltf::AnimationSampler sampler;
      sampler.input = add_accessor(times.data(), times.size(), 4, kFloat, TINYGLTF_TYPE_SCALAR, 0);
      set_bounds(sampler.input, {static_cast<double>(times.front())}, {static_cast<double>(times.back())});
      sampler.output = turns ? add_accessor(values.data(), track.values.size(), 16, kFloat, TINYGLTF_TYPE_VEC4, 0)
                             : add_accessor(values.data(), track.values.size(), 12, kFloat, TINYGLTF_TYPE_VEC3, 0);
      sampler.interpolation = kInterpolations[int(track.interpolation)];
      tinygltf::AnimationChannel channel;
      channel.sampler = static_cast<int>(out.samplers.size());
      channel.target_node = from.node;
      channel.target_path = kPaths[int(from.property)];
      out.samplers.push_back(std::move(sampler));
      out.channels.push_back(std::move(channel));
    }
    if (!out.channels.empty()) model_.animations.push_back(std::move(out));
  }

  const Level& level_;
  tinygltf::Model model_;
  Bytes bytes_;
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

Json light_json(const Light& light) {
  constexpr const char* kTypes[] = {"directional", "point", "spot"};
  Json json = {{"type", kTypes[static_cast<std::size_t>(light.kind)]},
               {"color", numbers(light.color)},
               {"intensity", static_cast<double>(light.intensity)}};
  if (light.range > 0.0f) json["range"] = static_cast<double>(light.range);
  if (light.kind == Light::Kind::kSpot)
    json["spot"] = {{"innerConeAngle", static_cast<double>(light.inner_cone)},
                    {"outerConeAngle", static_cast<double>(light.outer_cone)}};
  return json;
}

Json camera_json(const Camera& camera) {
  return {{"type", "perspective"},
          {"perspective",
           {{"yfov", static_cast<double>(camera.yfov)},
            {"znear", static_cast<double>(camera.znear)},
            {"zfar", static_cast<double>(camera.zfar)}}}};
}

Result<SourceDocument> build_document(const Level& level) {
  return Builder(level).build();
}

Result<BuiltParts> build_parts(const Level& level, const LevelParts& parts) {
  return Builder(level).build(parts);
}

}  // namespace pliant
