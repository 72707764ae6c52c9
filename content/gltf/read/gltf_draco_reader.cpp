#include "content/gltf/read/gltf_draco_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "content/files/isolation.h"
#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_accessor.h"

namespace pliant {

namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr double kOfEach = 2e-3;  // [s] overhead per process
// Blobs decoded by one process: a level may have thousands of a few bytes each.
constexpr std::size_t kTogether = 256, kTogetherBytes = 1 << 20;

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
  // Each mesh is read once, and twice more for each node with a skin: its surface and its weights.
  std::vector<std::size_t> reads(meshes.size(), 1);
  for (const Json& node : array_of(document.json, "nodes"))
    if (node.contains("skin")) reads[node["mesh"].get<std::size_t>()] += 2;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (const Json& primitive : meshes[m]["primitives"])
      if (extension_of(primitive, kDraco)) {
        const Key key = key_of(primitive);
        if (place_.try_emplace(key, order_.size()).second) order_.push_back(key);
        uses_[key] += reads[m];
      }
}

DracoReader::Key DracoReader::key_of(const Json& primitive) {
  const Json& extension = *extension_of(primitive, kDraco);
  Key key{extension["bufferView"].get<std::size_t>(), {}};
  for (const Json& id : extension["attributes"]) key.second.push_back(id.get<std::uint32_t>());
  return key;
}

std::span<const std::uint8_t> DracoReader::bytes_of(const Key& key) const {
  const Json& view = document_.json["bufferViews"][key.first];
  const Bytes& buffer = document_.buffers[view["buffer"].get<std::size_t>()];
  if (buffer.empty()) return {};
  return std::span(buffer).subspan(value_of<std::size_t>(view, "byteOffset", 0), view["byteLength"].get<std::size_t>());
}

Result<std::vector<DracoMesh>> DracoReader::decode(const std::vector<Key>& keys) {
  std::vector<DracoBlob> blobs;
  std::size_t size = 0;
  for (const Key& key : keys) {
    blobs.push_back({bytes_of(key), key.second});
    size += blobs.back().bytes.size();
  }
  double used = 0.0;
  Result<std::vector<DracoMesh>> meshes = decode_draco(blobs, left_, &used);
  left_ -= std::max(used / std::max(limit_factor(), 1.0) - reading_time(size) - kOfEach, 0.0);
  return meshes;
}

// Decodes this blob together with the next small ones of the document.
Status DracoReader::decode(const Key& key, const std::string& where) {
  if (bytes_of(key).empty()) return Error{where, "stands on a buffer without data", "add its bytes"};
  std::vector<Key> keys;
  std::size_t size = 0;
  for (std::size_t i = place_.at(key); i < order_.size() && keys.size() < kTogether; ++i) {
    const std::size_t bytes = bytes_of(order_[i]).size();
    if (!keys.empty() && size + bytes > kTogetherBytes) break;
    if (order_[i] != key && (bytes == 0 || uses_.at(order_[i]) == 0 || decoded_.count(order_[i]) != 0)) continue;
    keys.push_back(order_[i]);
    size += bytes;
  }
  while (left_ > 0.0) {
    Result<std::vector<DracoMesh>> meshes = decode(keys);
    if (meshes) {
      for (std::size_t i = 0; i < keys.size(); ++i) decoded_[keys[i]] = std::move((*meshes)[i]);
      return Done{};
    }
    if (keys.size() == 1) return Error{where, meshes.error().message()};
    keys.resize(1);  // another blob is damaged; its error is reported when it is read
  }
  return Error{where, "takes too long to read with the Draco data before it", "split the level"};
}

Result<DracoMesh> DracoReader::take(const Key& key, const std::string& where) {
  if (decoded_.count(key) == 0)
    if (const Status status = decode(key, where); !status) return status.error();
  DracoMesh& mesh = decoded_.at(key);
  std::size_t& uses = uses_.at(key);
  if (uses > 0) --uses;
  if (uses > 0) return mesh;
  DracoMesh last = std::move(mesh);
  decoded_.erase(key);
  return last;
}

Result<DracoMesh> DracoReader::read(const Json& primitive, const std::string& pointer) {
  const std::string here = pointer + "/extensions/" + kDraco;
  const Json& attributes = primitive["attributes"];
  const Json& extension = *extension_of(primitive, kDraco);
  for (const auto& [name, id] : extension["attributes"].items())
    if (!attributes.contains(name)) return Error{here, "names " + name + ", which the primitive does not have"};
  Result<DracoMesh> mesh = take(key_of(primitive), here);
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
    return Error{here, fmt::format("holds {} corners, its accessor of indices says {}", mesh->index.size(), declared),
                 "compress the mesh again"};
  return mesh;
}

}  // namespace pliant
