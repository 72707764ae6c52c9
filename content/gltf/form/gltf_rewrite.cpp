// Content of glTF 2.0 that tinygltf 2.7 does not read, or reads wrongly. If a document has any of it, tinygltf is given
// other JSON instead of the file's own:
//   buffers     data URIs with parameters, without padding or longer than declared; files longer than declared; names
//               with '+'; buffers without data; the second of a GLB without a URI (it would get the BIN chunk again);
//               a BIN chunk that is empty or not the second: all bytes are served under our own names
//   images      by URI, or on a buffer without data: served likewise, or left without bytes
//   indices     without a bufferView (Draco data, zeros): rejected by tinygltf; removed, then restored
//   accessors   unused, of a type or component type that is not in glTF: rejected by tinygltf; replaced
//   cameras     of an unknown type: rejected by tinygltf; their type is set from their members
//   channels    without a node (KHR_animation_pointer): dropped, which renumbers the others; given node 0, then none
//   animations  with extensions: copied into every sampler, quadratic in the file's size; removed
//   text        of more than kLongText: extensions, extras and unknown members, which other programs may have written,
//               would take several hundred bytes per value; removed
// Names of attributes end at a NUL: restored. Extensions (except lights) and extras are read from the checked JSON,
// never from the Model: tinygltf's Value has 32-bit integers and neither null nor empty arrays.
#include <fmt/format.h>

#include <set>

#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_model.h"

namespace pliant {

namespace {

constexpr std::size_t kLongText = 1 << 20;  // [byte]

// Without extensions and extras, at any depth.
Json bare(const Json& json) {
  if (!json.is_structured()) return json;
  Json out = json.is_array() ? Json::array() : Json::object();
  if (json.is_array())
    for (const Json& element : json) out.push_back(bare(element));
  else
    for (const auto& [key, value] : json.items())
      if (key != "extensions" && key != "extras") out[key] = bare(value);
  return out;
}

// tinygltf keeps every member of a material twice, known or not.
void keep_known_members(Json& material) {
  static const std::set<std::string> kKnown = {
      "alphaCutoff",    "alphaMode",        "baseColorFactor",      "baseColorTexture",         "doubleSided",
      "emissiveFactor", "emissiveTexture",  "metallicFactor",       "metallicRoughnessTexture", "name",
      "normalTexture",  "occlusionTexture", "pbrMetallicRoughness", "roughnessFactor"};
  for (auto it = material.begin(); it != material.end();)
    it = kKnown.count(it.key()) ? std::next(it) : material.erase(it);
}

class Rewriting {
 public:
  Rewriting(const SourceDocument& document, const Container& container, FetchedBytes& fetched)
      : document_(document), json_(document.json), container_(container), fetched_(fetched) {}

  std::optional<Json> all() {
    if (container_.json.size() > kLongText) shorten();
    if (document_.json_is_mended) copy();
    container();
    indices();
    accessors();
    cameras();
    animations();
    buffers();
    images();
    if (copy_) serve();
    return std::move(copy_);
  }

 private:
  Json& copy() {
    if (!copy_) copy_ = json_;
    return *copy_;
  }
  bool in_bin(std::size_t buffer) const {
    return fetched_.buffers[buffer].empty() && !fetched_.is_placeholder[buffer] &&
           !json_["buffers"][buffer].contains("uri");
  }
  bool without_data(const Json& image) const {
    const std::size_t view = image["bufferView"].get<std::size_t>();
    return fetched_.is_placeholder[json_["bufferViews"][view]["buffer"].get<std::size_t>()];
  }

  void shorten() {
    copy_ = bare(json_);
    if (const Json* lights = extension_of(json_, "KHR_lights_punctual"))
      (*copy_)["extensions"]["KHR_lights_punctual"] = bare(*lights);  // whose members tinygltf knows
    if (!copy_->contains("materials")) return;
    for (Json& material : (*copy_)["materials"]) {
      keep_known_members(material);
      if (material.contains("pbrMetallicRoughness")) keep_known_members(material["pbrMetallicRoughness"]);
    }
  }
  void container() {
    const bool ends_after_json =
        container_.json.data() + container_.json.size() == container_.glb.data() + container_.glb.size();
    if (!container_.glb.empty() && (container_.has_bin ? container_.bin.empty() : !ends_after_json)) copy();
  }
  void indices() {
    const Json& meshes = array_of(json_, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m)
      for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p) {
        const Json& primitive = meshes[m]["primitives"][p];
        if (primitive.contains("indices") &&
            !json_["accessors"][primitive["indices"].get<std::size_t>()].contains("bufferView"))
          copy()["meshes"][m]["primitives"][p].erase("indices");
      }
  }
  void accessors() {
    const Json& accessors = array_of(json_, "accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i)
      if (!layout_of(accessors[i]).known)
        copy()["accessors"][i] = {{"type", "SCALAR"}, {"componentType", kUnsignedByte}, {"count", 1}};
  }
  void cameras() {
    const Json& cameras = array_of(json_, "cameras");
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const std::string type = cameras[i]["type"].get<std::string>();
      if (type == "perspective" || type == "orthographic") continue;
      Json& camera = copy()["cameras"][i];
      camera["type"] = camera.contains("perspective") ? "perspective" : "orthographic";
      if (!camera.contains("perspective"))
        camera["orthographic"] = {{"xmag", 1}, {"ymag", 1}, {"zfar", 1}, {"znear", 0}};
    }
  }
  void animations() {
    const Json& animations = array_of(json_, "animations");
    for (std::size_t a = 0; a < animations.size(); ++a) {
      if (animations[a].contains("extensions")) copy()["animations"][a].erase("extensions");
      for (std::size_t c = 0; c < animations[a]["channels"].size(); ++c)
        if (!animations[a]["channels"][c]["target"].contains("node"))
          copy()["animations"][a]["channels"][c]["target"]["node"] = 0;
    }
  }
  void buffers() {
    for (std::size_t i = 0; i < fetched_.buffers.size(); ++i)
      if (!in_bin(i)) copy();
  }
  void images() {
    for (const Json& image : array_of(json_, "images"))
      if (image.contains("uri") || without_data(image)) copy();
  }

  // Serves all bytes under our own names; a buffer without data gets one byte.
  void serve() {
    for (std::size_t i = 0; i < fetched_.buffers.size(); ++i) {
      Bytes& bytes = fetched_.buffers[i];
      Json& buffer = (*copy_)["buffers"][i];
      if (in_bin(i))
        bytes.assign(container_.bin.begin(), container_.bin.begin() + buffer["byteLength"].get<std::ptrdiff_t>());
      if (fetched_.is_placeholder[i]) bytes.assign(1, 0);
      buffer = {{"uri", fmt::format("buffer/{}", i)}, {"byteLength", bytes.size()}};
    }
    for (std::size_t i = 0; i < array_of(json_, "images").size(); ++i)
      if (const Json& image = json_["images"][i]; image.contains("uri") || without_data(image))
        (*copy_)["images"][i] = {{"uri", fmt::format("image/{}", i)}};
  }

  const SourceDocument& document_;
  const Json& json_;
  const Container& container_;
  FetchedBytes& fetched_;
  std::optional<Json> copy_;
};

}  // namespace

std::optional<Json> rewritten_for_tinygltf(const SourceDocument& document, const Container& container,
                                           FetchedBytes& fetched) {
  return Rewriting(document, container, fetched).all();
}

void restore_rewritten(const Json& json, tinygltf::Model& model) {
  for (std::size_t i = 0; i < model.accessors.size(); ++i)
    if (!layout_of(json["accessors"][i]).known) model.accessors[i].type = -1;
  for (std::size_t m = 0; m < model.meshes.size(); ++m)
    for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
      const Json& from = json["meshes"][m]["primitives"][p];
      tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
      primitive.indices = value_of(from, "indices", -1);
      primitive.attributes.clear();
      for (const auto& [name, accessor] : from["attributes"].items()) primitive.attributes[name] = accessor.get<int>();
    }
  for (std::size_t a = 0; a < model.animations.size(); ++a)
    for (std::size_t c = 0; c < model.animations[a].channels.size(); ++c)
      model.animations[a].channels[c].target_node =
          value_of(json["animations"][a]["channels"][c]["target"], "node", -1);
}

}  // namespace pliant
