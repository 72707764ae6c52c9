// The Draco data of a document's primitives. What several of them name is decoded once, small blobs are decoded many in
// one process, and all share one total of processor time.
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "content/gltf/gltf_document.h"
#include "content/gltf/gltf_draco.h"

namespace pliant {

class DracoReader {
 public:
  explicit DracoReader(const SourceDocument& document);

  // Of a primitive that has any: its attributes by name, normalised integers as in read_floats.
  Result<DracoMesh> read(const Json& primitive, const std::string& pointer);

 private:
  using Key = std::pair<std::size_t, std::vector<std::uint32_t>>;  // bufferView, Draco's ids
  static Key key_of(const Json& primitive);
  std::span<const std::uint8_t> bytes_of(const Key& key) const;  // none: a placeholder's
  Result<DracoMesh> take(const Key& key, const std::string& where);
  Status decode(const Key& key, const std::string& where);
  Result<std::vector<DracoMesh>> decode(const std::vector<Key>& keys);

  const SourceDocument& document_;
  std::vector<Key> order_;                  // in which they first stand in the document
  std::map<Key, std::size_t> place_;        // in it
  std::map<Key, std::size_t> uses_;         // that are still to come, at most
  std::map<Key, DracoMesh> decoded_;        // for those
  double left_ = limits::kReaderTime.most;  // [s] beside what the bytes allow
};

}  // namespace pliant
