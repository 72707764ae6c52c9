// What glTF 2.0 and the extensions we know say about types, ranges and references, as one table that a small
// interpreter walks. A line is
//
//   object  key[!]  kind [arguments]          ! = required
//   string [a|b]       one of a list, if given (another value: a warning, as the Khronos validator has it)
//   int RANGE, number RANGE, numbers COUNT RANGE          RANGE: 0..  >0..  0..1  ..; COUNT: 3 or 1+
//   ints a|b           an integer of a list (another value: a warning)
//   index COLLECTION, indices COLLECTION      into a root array; indices are unique and at least one
//   object TYPE, objects TYPE                 a nested object, an array of at least one
//   map COLLECTION, maps COLLECTION           names -> indices, an array of such
//   ext TYPE           this extension may stand on this object; nowhere else
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "content/gltf_check.h"

namespace pliant {

namespace {

constexpr const char* kTable = R"(
root asset! object asset
root accessors objects accessor
root animations objects animation
root buffers objects buffer
root bufferViews objects bufferView
root cameras objects camera
root images objects image
root materials objects material
root meshes objects mesh
root nodes objects node
root samplers objects sampler
root scenes objects scene
root skins objects skin
root textures objects texture
root scene index scenes
root extensionsUsed strings
root extensionsRequired strings
root KHR_lights_punctual ext lights
root KHR_materials_variants ext variants
root KHR_xmp_json_ld ext any
asset version! string
asset minVersion string
asset copyright string
asset generator string
accessor bufferView index bufferViews
accessor byteOffset int 0..
accessor componentType! ints 5120|5121|5122|5123|5125|5126
accessor normalized bool
accessor count! int 1..
accessor type! string SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4
accessor min numbers 1+ ..
accessor max numbers 1+ ..
accessor sparse object sparse
sparse count! int 1..
sparse indices! object sparseIndices
sparse values! object sparseValues
sparseIndices bufferView! index bufferViews
sparseIndices byteOffset int 0..
sparseIndices componentType! ints 5121|5123|5125
sparseValues bufferView! index bufferViews
sparseValues byteOffset int 0..
buffer uri string
buffer byteLength! int 1..
bufferView buffer! index buffers
bufferView byteOffset int 0..
bufferView byteLength! int 1..
bufferView byteStride int 4..252
bufferView target ints 34962|34963
camera type! string perspective|orthographic
camera perspective object perspective
camera orthographic object orthographic
perspective aspectRatio number >0..
perspective yfov! number >0..
perspective zfar number >0..
perspective znear! number >0..
orthographic xmag! number ..
orthographic ymag! number ..
orthographic zfar! number >0..
orthographic znear! number 0..
image uri string
image mimeType string image/png|image/jpeg|image/webp|image/ktx2
image bufferView index bufferViews
sampler magFilter ints 9728|9729
sampler minFilter ints 9728|9729|9984|9985|9986|9987
sampler wrapS ints 33071|33648|10497
sampler wrapT ints 33071|33648|10497
texture sampler index samplers
texture source index images
texture EXT_texture_webp ext textureSource
texture KHR_texture_basisu ext textureSource
textureSource source index images
textureInfo index! index textures
textureInfo texCoord int 0..
textureInfo KHR_texture_transform ext textureTransform
textureInfo scale number ..
textureInfo strength number 0..1
textureTransform offset numbers 2 ..
textureTransform rotation number ..
textureTransform scale numbers 2 ..
textureTransform texCoord int 0..
material pbrMetallicRoughness object pbr
material normalTexture object textureInfo
material occlusionTexture object textureInfo
material emissiveTexture object textureInfo
material emissiveFactor numbers 3 0..1
material alphaMode string OPAQUE|MASK|BLEND
material alphaCutoff number 0..
material doubleSided bool
pbr baseColorFactor numbers 4 0..1
pbr baseColorTexture object textureInfo
pbr metallicFactor number 0..1
pbr roughnessFactor number 0..1
pbr metallicRoughnessTexture object textureInfo
material KHR_materials_anisotropy ext anisotropy
anisotropy anisotropyStrength number 0..1
anisotropy anisotropyRotation number ..
anisotropy anisotropyTexture object textureInfo
material KHR_materials_clearcoat ext clearcoat
clearcoat clearcoatFactor number 0..1
clearcoat clearcoatTexture object textureInfo
clearcoat clearcoatRoughnessFactor number 0..1
clearcoat clearcoatRoughnessTexture object textureInfo
clearcoat clearcoatNormalTexture object textureInfo
material KHR_materials_diffuse_transmission ext diffuseTransmission
diffuseTransmission diffuseTransmissionFactor number 0..1
diffuseTransmission diffuseTransmissionTexture object textureInfo
diffuseTransmission diffuseTransmissionColorFactor numbers 3 0..
diffuseTransmission diffuseTransmissionColorTexture object textureInfo
material KHR_materials_dispersion ext dispersion
dispersion dispersion number 0..
material KHR_materials_emissive_strength ext emissiveStrength
emissiveStrength emissiveStrength number 0..
material KHR_materials_ior ext ior
ior ior number 0..
material KHR_materials_iridescence ext iridescence
iridescence iridescenceFactor number 0..1
iridescence iridescenceTexture object textureInfo
iridescence iridescenceIor number 1..
iridescence iridescenceThicknessMinimum number 0..
iridescence iridescenceThicknessMaximum number 0..
iridescence iridescenceThicknessTexture object textureInfo
material KHR_materials_pbrSpecularGlossiness ext specularGlossiness
specularGlossiness diffuseFactor numbers 4 0..1
specularGlossiness diffuseTexture object textureInfo
specularGlossiness specularFactor numbers 3 0..1
specularGlossiness glossinessFactor number 0..1
specularGlossiness specularGlossinessTexture object textureInfo
material KHR_materials_sheen ext sheen
sheen sheenColorFactor numbers 3 0..1
sheen sheenColorTexture object textureInfo
sheen sheenRoughnessFactor number 0..1
sheen sheenRoughnessTexture object textureInfo
material KHR_materials_specular ext specular
specular specularFactor number 0..1
specular specularTexture object textureInfo
specular specularColorFactor numbers 3 0..
specular specularColorTexture object textureInfo
material KHR_materials_transmission ext transmission
transmission transmissionFactor number 0..1
transmission transmissionTexture object textureInfo
material KHR_materials_unlit ext any
material KHR_materials_volume ext volume
volume thicknessFactor number 0..
volume thicknessTexture object textureInfo
volume attenuationDistance number >0..
volume attenuationColor numbers 3 0..1
mesh primitives! objects primitive
mesh weights numbers 1+ ..
primitive attributes! map accessors
primitive indices index accessors
primitive material index materials
primitive mode ints 0|1|2|3|4|5|6
primitive targets maps accessors
primitive KHR_draco_mesh_compression ext draco
primitive KHR_materials_variants ext variantMappings
draco bufferView! index bufferViews
draco attributes! map
variants variants! objects variant
variant name! string
variantMappings mappings! objects variantMapping
variantMapping variants! indices extensions/KHR_materials_variants/variants
variantMapping material! index materials
variantMapping name string
node camera index cameras
node children indices nodes
node skin index skins
node matrix numbers 16 ..
node mesh index meshes
node rotation numbers 4 -1..1
node scale numbers 3 ..
node translation numbers 3 ..
node weights numbers 1+ ..
node KHR_lights_punctual ext lightReference
node KHR_node_visibility ext visibility
node EXT_mesh_gpu_instancing ext any
visibility visible bool
lightReference light! index extensions/KHR_lights_punctual/lights
lights lights! objects light
light color numbers 3 0..1
light intensity number 0..
light range number >0..
light type! string directional|point|spot
light spot object spot
spot innerConeAngle number 0..1.5707963267948966
spot outerConeAngle number >0..1.5707963267948966
scene nodes indices nodes
skin inverseBindMatrices index accessors
skin skeleton index nodes
skin joints! indices nodes
animation channels! objects channel
animation samplers! objects animationSampler
channel sampler! int 0..
channel target! object target
target node index nodes
target path! string translation|rotation|scale|weights|pointer
target KHR_animation_pointer ext animationPointer
animationPointer pointer! string
animationSampler input! index accessors
animationSampler output! index accessors
animationSampler interpolation string LINEAR|STEP|CUBICSPLINE
node PLIANT_deformable ext any
node PLIANT_probe ext any
node PLIANT_haptic_device ext any
node PLIANT_soft_body ext any
node PLIANT_handle ext any
node PLIANT_rigid_body ext any
scene PLIANT_environment ext any
scene PLIANT_simulation ext any
)";

struct Range {
  double min = -INFINITY, max = INFINITY;
  bool open = false;  // min itself is out
  std::string text;
  bool holds(double value) const { return (open ? value > min : value >= min) && value <= max; }
};

struct Rule {
  std::string key, kind, argument;
  bool required = false;
  std::vector<std::string> list;
  std::size_t count = 0;
  bool or_more = false;
  Range range;
};

Range parse_range(const std::string& text) {
  Range range;
  range.text = text;
  const std::size_t dots = text.find("..");
  std::string low = text.substr(0, dots), high = text.substr(dots + 2);
  if (!low.empty() && low[0] == '>') {
    range.open = true;
    low.erase(0, 1);
  }
  if (!low.empty()) range.min = std::strtod(low.c_str(), nullptr);
  if (!high.empty()) range.max = std::strtod(high.c_str(), nullptr);
  return range;
}

struct Table {
  std::map<std::string, std::vector<Rule>> rules;         // by object
  std::map<std::string, std::map<std::string, std::string>> extensions;  // by object: name -> type
  std::set<std::string> known_extensions;

  Table() {
    std::istringstream lines(kTable);
    std::string line;
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      std::string object, extra;
      Rule rule;
      if (!(words >> object >> rule.key >> rule.kind)) continue;
      words >> rule.argument >> extra;
      if (rule.kind == "ext") {
        extensions[object][rule.key] = rule.argument;
        known_extensions.insert(rule.key);
        continue;
      }
      if (rule.key.back() == '!') {
        rule.required = true;
        rule.key.pop_back();
      }
      if (rule.kind == "string" || rule.kind == "ints") {
        std::istringstream list(rule.argument);
        for (std::string item; std::getline(list, item, '|');) rule.list.push_back(item);
      }
      if (rule.kind == "int" || rule.kind == "number") rule.range = parse_range(rule.argument);
      if (rule.kind == "numbers") {
        rule.range = parse_range(extra);
        rule.count = std::strtoul(rule.argument.c_str(), nullptr, 10);
        rule.or_more = rule.argument.back() == '+';
      }
      rules[object].push_back(rule);
    }
  }
};

class Structure {
 public:
  Structure(const Json& root, Findings& findings) : root_(root), findings_(findings) {
    if (root.is_object() && array_of(root, "extensionsUsed").is_array())
      for (const Json& name : array_of(root, "extensionsUsed"))
        if (name.is_string()) used_.insert(name.get<std::string>());
  }

  void check_object(const Json& json, const std::string& type, const std::string& pointer) {
    if (!json.is_object()) return mismatch(pointer, json, "an object");
    if (const auto rules = table().rules.find(type); rules != table().rules.end())
      for (const Rule& rule : rules->second) {
        const auto member = json.find(rule.key);
        if (member != json.end())
          check_member(*member, rule, pointer + "/" + rule.key);
        else if (rule.required)
          error(pointer, "lacks '" + rule.key + "', which glTF requires here");
      }
    if (json.contains("name") && !json["name"].is_string()) mismatch(pointer + "/name", json["name"], "a string");
    if (json.contains("extensions")) check_extensions(json["extensions"], type, pointer + "/extensions");
  }

 private:
  static const Table& table() {
    static const Table table;
    return table;
  }
  void error(const std::string& pointer, std::string message) {
    if (findings_.size() < 1000) findings_.push_back({Severity::kError, pointer, std::move(message)});
  }
  void warn(const std::string& pointer, std::string message) {
    if (findings_.size() < 1000) findings_.push_back({Severity::kWarning, pointer, std::move(message)});
  }
  static std::string shown(const Json& json) {
    if (json.is_array()) return "an array";
    if (json.is_object()) return "an object";
    return json.dump().substr(0, 40);
  }
  void mismatch(const std::string& pointer, const Json& json, const std::string& wanted) {
    error(pointer, fmt::format("is {}, not {}", shown(json), wanted));
  }

  void check_extensions(const Json& extensions, const std::string& type, const std::string& pointer) {
    if (!extensions.is_object()) return mismatch(pointer, extensions, "an object");
    for (const auto& [name, json] : extensions.items()) {
      const std::string here = pointer + "/" + escaped(name);
      if (!json.is_object()) {
        mismatch(here, json, "an object");
        continue;
      }
      if (!used_.count(name)) error(here, "is not declared; add '" + name + "' to extensionsUsed");
      std::string content = "any";
      if (table().known_extensions.count(name)) {
        const auto allowed = table().extensions.find(type);
        const auto found = allowed == table().extensions.end() ? std::map<std::string, std::string>::const_iterator{}
                                                               : allowed->second.find(name);
        if (allowed == table().extensions.end() || found == allowed->second.end()) {
          error(here, "stands where this extension has no meaning; move or remove it");
          continue;
        }
        content = found->second;
      }
      if (content != "any") check_object(json, content, here);
    }
  }

  // Calls check(element, pointer) over an array of at least one element.
  template <class Check>
  void each(const Json& json, const std::string& pointer, bool unique, const Check& check) {
    if (!json.is_array()) return mismatch(pointer, json, "an array");
    if (json.empty()) return error(pointer, "is empty; leave it out instead");
    std::set<Json> seen;
    for (std::size_t i = 0; i < json.size(); ++i) {
      const std::string here = fmt::format("{}/{}", pointer, i);
      check(json[i], here);
      if (unique && json[i].is_primitive() && !seen.insert(json[i]).second) error(here, "repeats an earlier element");
    }
  }

  void check_index(const Json& json, const std::string& collection, const std::string& pointer) {
    if (!json.is_number_integer()) return mismatch(pointer, json, "an integer");
    const Json* target = &root_;
    std::istringstream path(collection);
    for (std::string key; target && std::getline(path, key, '/');)
      target = target->is_object() && target->contains(key) ? &(*target)[key] : nullptr;
    const std::size_t count = target && target->is_array() ? target->size() : 0;
    if (json.is_number_unsigned() ? json.get<std::uint64_t>() >= count : true)
      error(pointer, fmt::format("refers to element {} of {}, which has {}", json.dump(), collection, count));
  }
  void check_number(const Json& json, const Range& range, const std::string& pointer) {
    if (!json.is_number()) return mismatch(pointer, json, "a number");
    const double value = json.get<double>();
    // Everything is read into single precision: a number beyond it would become infinite.
    if (!std::isfinite(static_cast<float>(value))) return error(pointer, "is too large a number");
    if (!range.holds(value)) error(pointer, fmt::format("is {}, out of the range {}", json.dump(), range.text));
  }
  void check_map(const Json& json, const std::string& collection, const std::string& pointer) {
    if (!json.is_object()) return mismatch(pointer, json, "an object");
    if (json.empty()) return error(pointer, "is empty");
    for (const auto& [name, value] : json.items()) {
      const std::string here = pointer + "/" + escaped(name);
      if (!collection.empty()) check_index(value, collection, here);
      else if (!value.is_number_unsigned()) mismatch(here, value, "an integer of at least 0");
    }
  }

  void check_member(const Json& json, const Rule& rule, const std::string& pointer) {
    const auto nested = [&](const Json& element, const std::string& here) { check_object(element, rule.argument, here); };
    const auto index = [&](const Json& element, const std::string& here) { check_index(element, rule.argument, here); };
    const auto map = [&](const Json& element, const std::string& here) { check_map(element, rule.argument, here); };
    const auto number = [&](const Json& element, const std::string& here) { check_number(element, rule.range, here); };
    const auto string = [&](const Json& element, const std::string& here) {
      if (!element.is_string()) mismatch(here, element, "a string");
    };
    if (rule.kind == "object") nested(json, pointer);
    if (rule.kind == "objects") each(json, pointer, false, nested);
    if (rule.kind == "index") index(json, pointer);
    if (rule.kind == "indices") each(json, pointer, true, index);
    if (rule.kind == "map") map(json, pointer);
    if (rule.kind == "maps") each(json, pointer, false, map);
    if (rule.kind == "strings") each(json, pointer, true, string);
    if (rule.kind == "number") number(json, pointer);
    if (rule.kind == "bool" && !json.is_boolean()) mismatch(pointer, json, "true or false");
    if (rule.kind == "int") {
      if (!json.is_number_integer()) mismatch(pointer, json, "an integer");
      else if (!rule.range.holds(json.get<double>()) || json.get<double>() > 4e9)
        error(pointer, fmt::format("is {}, out of the range {}", json.dump(), rule.range.text));
    }
    if (rule.kind == "numbers") {
      each(json, pointer, false, number);
      if (json.is_array() && (rule.or_more ? json.size() < rule.count : json.size() != rule.count))
        error(pointer, fmt::format("has {} numbers instead of {}", json.size(), rule.count));
    }
    if (rule.kind == "string") {
      string(json, pointer);
      if (json.is_string() && !rule.list.empty()) check_list(json.get<std::string>(), rule, pointer);
    }
    if (rule.kind == "ints") {
      if (!json.is_number_integer()) mismatch(pointer, json, "an integer");
      else check_list(json.dump(), rule, pointer);
    }
  }
  void check_list(const std::string& value, const Rule& rule, const std::string& pointer) {
    for (const std::string& each : rule.list)
      if (each == value) return;
    warn(pointer, fmt::format("is {}, which is none of {}", value.substr(0, 40), rule.argument));
  }

  const Json& root_;
  Findings& findings_;
  std::set<std::string> used_;  // extensionsUsed
};

}  // namespace

void check_structure(const Json& json, Findings& findings) { Structure(json, findings).check_object(json, "root", ""); }

bool extension_is_used(const Json& json, const std::string& name) {
  const auto used = json.find("extensionsUsed");
  if (used == json.end() || !used->is_array()) return false;
  for (const Json& each : *used)
    if (each == name) return true;
  return false;
}

}  // namespace pliant
