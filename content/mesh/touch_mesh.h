// The touch mesh alone, with the origin of its parts: the first steps of build_mesh, for users that need neither zones
// nor a draw mesh (the editor's paint).
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

// As build_mesh, with the same errors; ignores MeshOptions::dents. Once `stop` is set it soon returns an error, which
// can be ignored.
Result<TouchMesh> build_touch_mesh(const std::string& name, std::span<const Primitive> primitives,
                                   const mat4& to_object, const MeshOptions& options = {},
                                   const std::atomic<bool>* stop = nullptr);

}  // namespace pliant
