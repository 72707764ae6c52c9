// Compresses a document with Draco (KHR_draco_mesh_compression) and removes data that is no longer used.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_draco.h"
#include "content/gltf/read/gltf_mesh.h"
#include "content/gltf/write/gltf_save.h"
#include "content/level_file.h"

namespace pliant {

namespace {

// Calls visit(reference) for every number under `key`, at any depth.
template <class Visit>
void each_reference(Json& json, const char* key, const Visit& visit) {
  if (!json.is_structured()) return;
  if (json.is_object() && json.contains(key) && json[key].is_number_unsigned()) visit(json[key]);
  for (Json& child : json) each_reference(child, key, visit);
}

// Calls visit(reference) for every accessor index of glTF 2.0 and EXT_mesh_gpu_instancing.
template <class Visit>
void each_accessor(Json& json, const Visit& visit) {
  const auto all_of = [&](Json& map) {
    for (Json& number : map) visit(number);
  };
  if (json.contains("meshes"))
    for (Json& mesh : json["meshes"])
      for (Json& primitive : mesh["primitives"]) {
        all_of(primitive["attributes"]);
        if (primitive.contains("indices")) visit(primitive["indices"]);
        if (primitive.contains("targets"))
          for (Json& target : primitive["targets"]) all_of(target);
      }
  if (json.contains("nodes"))
    for (Json& node : json["nodes"])
      if (const Json* copies = extension_of(node, "EXT_mesh_gpu_instancing"); copies && copies->contains("attributes"))
        all_of(node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]);
  if (json.contains("skins"))
    for (Json& skin : json["skins"])
      if (skin.contains("inverseBindMatrices")) visit(skin["inverseBindMatrices"]);
  if (json.contains("animations"))
    for (Json& animation : json["animations"])
      for (Json& sampler : animation["samplers"]) {
        visit(sampler["input"]);
        visit(sampler["output"]);
      }
}

// Removes unreferenced elements of json[collection] and renumbers the references.
template <class EachReference>
void drop_unused(Json& json, const char* collection, const EachReference& each_reference_of) {
  if (!json.contains(collection)) return;
  std::set<std::size_t> used;
  each_reference_of(json, [&](Json& number) { used.insert(number.get<std::size_t>()); });
  std::map<std::size_t, std::size_t> renumbered;
  Json kept = Json::array();
  for (const std::size_t i : used) {
    renumbered[i] = kept.size();
    kept.push_back(std::move(json[collection][i]));
  }
  each_reference_of(json, [&](Json& number) { number = renumbered[number.get<std::size_t>()]; });
  if (kept.empty())
    json.erase(collection);
  else
    json[collection] = std::move(kept);
}

// Whether the primitive consists of triangles with plain attributes, all with data.
bool can_compress(const SourceDocument& document, const Json& primitive) {
  const int mode = value_of(primitive, "mode", 4);
  const Json& attributes = primitive["attributes"];
  if (mode < 4 || mode > 6 || primitive.contains("targets") || !attributes.contains("POSITION")) return false;
  if (extension_of(primitive, "KHR_draco_mesh_compression")) return false;
  for (const Json& number : attributes) {
    const std::size_t i = number.get<std::size_t>();
    if (layout_of(document.json["accessors"][i]).columns != 1 || !has_data(document, i)) return false;
  }
  return true;
}

Status compress_primitive(SourceDocument& document, Json& primitive, int bits, const std::string& pointer) {
  Json& accessors = document.json["accessors"];
  const Json attributes = primitive["attributes"];
  DracoMesh mesh;
  mesh.vertices = accessors[attributes["POSITION"].get<std::size_t>()]["count"].get<std::size_t>();
  if (primitive.contains("indices")) {
    mesh.index = read_integers(document, primitive["indices"].get<std::size_t>());
  } else {
    mesh.index.resize(mesh.vertices);
    std::iota(mesh.index.begin(), mesh.index.end(), 0u);
  }
  mesh.index = as_triangles(value_of(primitive, "mode", 4), std::move(mesh.index));
  if (mesh.index.empty()) return Done{};
  for (const auto& [name, number] : attributes.items()) {
    const std::size_t i = number.get<std::size_t>();
    mesh.attributes.push_back(
        {name, 0, layout_of(accessors[i]).rows, name.rfind("JOINTS_", 0) == 0, read_floats(document, i)});
  }
  std::vector<float> position;
  for (const DracoAttribute& each : mesh.attributes)
    if (each.name == "POSITION") position = each.values;
  Result<Bytes> blob = encode_draco(mesh, bits);
  if (!blob) return Error{pointer, blob.error().message()};

  Json named = Json::object();
  for (const DracoAttribute& each : mesh.attributes) {
    named[each.name] = each.id;
    Json accessor = {{"componentType", each.integer ? kUnsignedShort : kFloat},
                     {"count", mesh.vertices},
                     {"type", each.width == 1 ? "SCALAR" : fmt::format("VEC{}", each.width)}};
    if (each.name == "POSITION")
      for (std::size_t c = 0; c < 3; ++c) {
        float low = position[c], high = position[c];
        for (std::size_t k = c; k < position.size(); k += 3) {
          low = std::min(low, position[k]);
          high = std::max(high, position[k]);
        }
        accessor["min"].push_back(low);
        accessor["max"].push_back(high);
      }
    primitive["attributes"][each.name] = accessors.size();
    accessors.push_back(std::move(accessor));
  }
  primitive["indices"] = accessors.size();
  accessors.push_back({{"componentType", kUnsignedInt}, {"count", mesh.index.size()}, {"type", "SCALAR"}});
  primitive.erase("mode");
  // Each blob has its own buffer until the document is packed.
  document.json["bufferViews"].push_back({{"buffer", document.buffers.size()}, {"byteLength", blob->size()}});
  document.json["buffers"].push_back({{"byteLength", blob->size()}});
  document.buffers.push_back(std::move(*blob));
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", document.json["bufferViews"].size() - 1},
                                                           {"attributes", named}};
  return Done{};
}

// Gives every bufferView its own buffer, so that packing copies only used bytes.
void split_buffers(SourceDocument& document) {
  if (!document.json.contains("bufferViews")) return;
  std::vector<Bytes> buffers;
  Json described = Json::array();
  for (Json& view : document.json["bufferViews"]) {
    const Bytes& old = document.buffers[view["buffer"].get<std::size_t>()];
    const std::size_t offset = value_of<std::size_t>(view, "byteOffset", 0),
                      length = view["byteLength"].get<std::size_t>();
    view["buffer"] = buffers.size();
    if (!old.empty()) view.erase("byteOffset");
    described.push_back({{"byteLength", old.empty() ? offset + length : length}});
    buffers.push_back(old.empty() ? Bytes{}
                                  : Bytes(old.begin() + static_cast<std::ptrdiff_t>(offset),
                                          old.begin() + static_cast<std::ptrdiff_t>(offset + length)));
  }
  document.buffers = std::move(buffers);
  document.json["buffers"] = std::move(described);
}

}  // namespace

Status compress_document(SourceDocument& document, int bits) {
  constexpr Range kBits = SaveOptions::kDracoBits;
  if (!kBits.holds(bits))
    return Error{"--draco", fmt::format("is {}", bits), fmt::format("use {} to {} bits", kBits.min, kBits.max)};
  if (!document.json.contains("meshes")) return Done{};
  bool any = false;
  for (std::size_t m = 0; m < document.json["meshes"].size(); ++m)
    for (std::size_t p = 0; p < document.json["meshes"][m]["primitives"].size(); ++p) {
      Json& primitive = document.json["meshes"][m]["primitives"][p];
      if (!can_compress(document, primitive)) continue;
      if (const Status status =
              compress_primitive(document, primitive, bits, fmt::format("/meshes/{}/primitives/{}", m, p));
          !status)
        return status;
      any = true;
    }
  if (!any) return Done{};
  declare_extension(document.json, "KHR_draco_mesh_compression", true);
  drop_unused_data(document);
  return Done{};
}

void drop_unused_data(SourceDocument& document) {
  drop_unused(document.json, "accessors", [](Json& json, const auto& visit) { each_accessor(json, visit); });
  drop_unused(document.json, "bufferViews",
              [](Json& json, const auto& visit) { each_reference(json, "bufferView", visit); });
  split_buffers(document);
}

}  // namespace pliant
