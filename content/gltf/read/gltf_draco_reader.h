// Reads the Draco data of a document's primitives. Shared data are decoded once, small blobs are decoded together in
// one process, and all share one CPU time limit.
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "content/gltf/form/gltf_document.h"
#include "content/gltf/form/gltf_draco.h"

namespace pliant {

class DracoReader {
 public:
  explicit DracoReader(const SourceDocument& document);

  // Of a primitive with Draco data: its attributes by name; normalised integers as in read_floats.
  Result<DracoMesh> read(const Json& primitive, const std::string& pointer);

 private:
  using Key = std::pair<std::size_t, std::vector<std::uint32_t>>;  // bufferView, Draco's ids
  static Key key_of(const Json& primitive);
  std::span<const std::uint8_t> bytes_of(const Key& key) const;  // empty: a placeholder
  Result<DracoMesh> take(const Key& key, const std::string& where);
  Status decode(const Key& key, const std::string& where);
  Result<std::vector<DracoMesh>> decode(const std::vector<Key>& keys);

  const SourceDocument& document_;
  std::vector<Key> order_;                  // order of first appearance in the document
  std::map<Key, std::size_t> place_;        // index in order_
  std::map<Key, std::size_t> uses_;         // upper bound of the remaining reads
  std::map<Key, DracoMesh> decoded_;        // cached for the remaining reads
  double left_ = limits::kReaderTime.most;  // [s] in addition to the allowance for the bytes
};

}  // namespace pliant
