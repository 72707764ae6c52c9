// Materials of the parts of a soft body: paint on its surface, physical groups of its file, and closed meshes
// inside of it (TissuePart).
#pragma once

#include "content/level/spawn_soft.h"

namespace pliant {

// Sets TetMesh::factors, and the volumes of nodes where a part has its own density, of the body of `node`.
// - _STIFFNESS and _DAMPING of the nearest place of the surface reach inwards.
// - A part's material replaces the body's and the paint's, by the share of an element inside of it.
// `to_object`: the world to the body's frame; `world`: each node's frame. Notes on what is not used are added to the
// report. Errors: a part that is neither a group nor a node with a mesh, or that holds no element.
Status set_materials(const Level& level, const LevelNode& node, const dmat4& to_object, const std::vector<dmat4>& world,
                     SoftParts& parts);

// The mesh of the node of this name in the body's frame; empty: no such node.
Result<std::optional<BuiltMesh>> mesh_in_body(const std::string& name, const Level& level, const dmat4& to_object,
                                              const std::vector<dmat4>& world);

}  // namespace pliant
