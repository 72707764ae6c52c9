// A node with PLIANT_soft_body as flesh: tetrahedra, and the surface that rides on them.
#pragma once

#include <filesystem>

#include "content/level.h"
#include "content/mesh_build.h"

namespace pliant {

struct SoftParts {
  BuiltMesh surface;
  TetMesh tets;                    // nodes in the order free, handle, pinned
  std::vector<std::string> notes;  // of the tetrahedra file
};

// What about a node's extensions cannot go together, as what follows "node X"; "": nothing.
std::string soft_fault(const LevelNode& node);

// `mesh`: the node's surface, or null: the boundary of the tetrahedra file is taken. `to_object` takes the node's frame
// to the object frame. Errors: no surface, no inside, a file that cannot be read, boxes and paint that hold no node.
Result<SoftParts> make_soft_parts(const LevelNode& node, const LevelMesh* mesh, const mat4& to_object,
                                  const std::filesystem::path& folder);

}  // namespace pliant
