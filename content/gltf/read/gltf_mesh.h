// Reads glTF meshes as triangles in plain arrays.
#pragma once

#include <set>
#include <string>

#include "content/gltf/form/gltf_document.h"
#include "content/gltf/read/gltf_draco_reader.h"

namespace pliant {

class MeshReader {
 public:
  explicit MeshReader(const SourceDocument& document);

  // Reads every primitive that has triangles; resolves strips, fans, quantised, sparse and Draco data. Points and lines
  // are skipped with a note; Primitive::source identifies the rest. Errors: invalid Draco data, non-finite numbers.
  Result<LevelMesh> read(std::size_t mesh);

  // The mesh as deformed by `skin` at rest: vertices times joint matrices times inverse bind matrices, transformed back
  // into the node's frame. `world`: of every /nodes/i.
  Result<LevelMesh> read_skinned(std::size_t mesh, std::size_t skin, const std::vector<dmat4>& world, std::size_t node);

  const std::set<std::string>& notes() const { return notes_; }

 private:
  struct Source;  // one primitive's attributes from either source
  Result<Primitive> read_primitive(std::size_t mesh, std::size_t primitive);
  Status read_draco(const Json& extension, const std::string& pointer, Source& source);
  std::vector<float> attribute(const Source& source, const char* name) const;

  const SourceDocument& document_;
  DracoReader draco_;
  std::set<std::string> notes_;
};

}  // namespace pliant
