#include "content/gltf/gltf_draco_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "content/files/isolation.h"
#include "content/gltf/gltf_accessor.h"
#include "content/gltf/gltf_check.h"

namespace pliant {

namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr double kOfEach = 2e-3;  // [s] that a process takes to begin and to end

void normalize(std::vector<float>& values, int component_type) {
  const float scale = component_type == kUnsignedByte ? 255.0f
                      : component_type == kByte       ? 127.0f
                      : component_type == kShort      ? 32767.0f
                                                      : 65535.0f;
  for (float& value : values) value = std::max(value / scale, -1.0f);
}

}  // namespace

DracoReader::DracoReader(const SourceDocument& document) : document_(document) {
  const Json& meshes = array_of(document.json, "meshes");
  std::vector<std::size_t> reads(meshes.size(), 1);  // once as it is, once for each node with a skin
  for (const Json& node : array_of(document.json, "nodes"))
    if (node.contains("skin")) ++reads[node["mesh"].get<std::size_t>()];
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (const Json& primitive : meshes[m]["primitives"])
      if (extension_of(primitive, kDraco)) uses_[key_of(primitive)] += reads[m];
}

DracoReader::Key DracoReader::key_of(const Json& primitive) {
  const Json& extension = *extension_of(primitive, kDraco);
  Key key{extension["bufferView"].get<std::size_t>(), {}};
  for (const Json& id : extension["attributes"]) key.second.push_back(id.get<std::uint32_t>());
  return key;
}

Result<DracoMesh> DracoReader::decode(const Key& key, const std::string& where) {
  const auto known = decoded_.find(key);
  std::size_t& uses = uses_[key];
  if (uses > 0) --uses;
  if (known != decoded_.end()) {
    if (uses > 0) return known->second;
    DracoMesh last = std::move(known->second);
    decoded_.erase(known);
    return last;
  }
  const Json& view = document_.json["bufferViews"][key.first];
  const Bytes& buffer = document_.buffers[view["buffer"].get<std::size_t>()];
  if (buffer.empty()) return Error{where, "stands on a buffer without data"};
  if (left_ <= 0.0) return Error{where, "takes too long to read with the Draco data before it; split the level"};
  const std::span<const std::uint8_t> blob =
      std::span(buffer).subspan(value_of<std::size_t>(view, "byteOffset", 0), view["byteLength"].get<std::size_t>());
  double used = 0.0;
  Result<DracoMesh> mesh = decode_draco(blob, key.second, left_, &used);
  left_ -= std::max(used / std::max(limit_factor(), 1.0) - reading_time(blob.size()) - kOfEach, 0.0);
  if (!mesh) return Error{where, mesh.error().message()};
  if (uses > 0) decoded_[key] = *mesh;
  return mesh;
}

Result<DracoMesh> DracoReader::read(const Json& primitive, const std::string& pointer) {
  const std::string here = pointer + "/extensions/" + kDraco;
  const Json& attributes = primitive["attributes"];
  const Json& extension = *extension_of(primitive, kDraco);
  for (const auto& [name, id] : extension["attributes"].items())
    if (!attributes.contains(name)) return Error{here, "names " + name + ", which the primitive does not have"};
  Result<DracoMesh> mesh = decode(key_of(primitive), here);
  if (!mesh) return mesh;
  std::size_t i = 0;
  for (const auto& [name, id] : extension["attributes"].items()) {
    const AccessorLayout layout = layout_of(document_.json["accessors"][attributes[name].get<std::size_t>()]);
    DracoAttribute& attribute = mesh->attributes[i++];
    attribute.name = name;
    if (layout.components() != attribute.width || layout.count != mesh->vertices)
      return Error{here, fmt::format("holds {} x {} numbers for {}, its accessor says {} x {}", mesh->vertices,
                                     attribute.width, name, layout.count, layout.components())};
    if (layout.normalized) normalize(attribute.values, layout.component_type);
  }
  const std::uint64_t declared =
      primitive.contains("indices")
          ? layout_of(document_.json["accessors"][primitive["indices"].get<std::size_t>()]).count
          : mesh->vertices;
  if (mesh->index.size() > most_draco_corners(declared, mesh->vertices))
    return Error{here, fmt::format("holds {} corners, its accessor of indices says {}; compress the mesh again",
                                   mesh->index.size(), declared)};
  return mesh;
}

}  // namespace pliant
