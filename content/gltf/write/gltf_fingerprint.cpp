// 64-bit hashes of meshes and animation channels as they were read. Saving uses them to detect changes; copies would
// double the memory of a level.
#include "content/gltf/form/gltf_document.h"
#include "runtime/hash.h"

namespace pliant {

namespace {

template <class T>
void add(Hash& hash, const std::vector<T>& values) {
  hash.add(values.size());
  if (!values.empty()) hash.add_bytes(values.data(), values.size() * sizeof(T));
}

}  // namespace

MeshAsRead fingerprint(const LevelMesh& mesh) {
  MeshAsRead out{mesh.source, mesh.skinned, {}};
  for (const Primitive& primitive : mesh.primitives) {
    PrimitiveAsRead& made = out.primitives.emplace_back();
    made.source = primitive.source;
    Hash shape;
    add(shape, primitive.position);
    add(shape, primitive.normal);
    add(shape, primitive.tangent);
    add(shape, primitive.uv);
    add(shape, primitive.index);
    shape.add(primitive.material);
    made.shape = shape.value();
    for (std::size_t k = 0; k < kPainted.size(); ++k) {
      Hash painted;
      add(painted, primitive.*kPainted[k].values);
      made.painted[k] = painted.value();
    }
  }
  return out;
}

ChannelAsRead fingerprint(const LevelChannel& channel, std::int32_t node) {
  Hash hash;
  hash.add(static_cast<int>(channel.property));
  hash.add_bytes(channel.key.data(), channel.key.size());
  hash.add(static_cast<int>(channel.track.interpolation));
  add(hash, channel.track.times);
  add(hash, channel.track.values);
  return {node, hash.value()};
}

}  // namespace pliant
