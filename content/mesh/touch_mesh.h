// The touch mesh alone, and where its parts come from: what build_mesh begins with, for those who need neither zones
// nor what is drawn (the editor's paint).
#pragma once

#include <atomic>

#include "content/mesh/mesh_surface.h"
#include "content/mesh/mesh_weld.h"

namespace pliant {

struct TouchMesh {
  Mesh mesh;  // without tree, zones and painted factors; `of_source` is welded.touch_vertex
  Gathered gathered;
  Welded welded;
  Corners corners;
  MeshReport report;
};

// As build_mesh, and fails as it does; MeshOptions::dents is not looked at. Once `stop` is set it soon returns an
// error, which nobody needs to read.
Result<TouchMesh> build_touch_mesh(const std::string& name, std::span<const Primitive> primitives,
                                   const mat4& to_object, const MeshOptions& options = {},
                                   const std::atomic<bool>* stop = nullptr);

}  // namespace pliant
