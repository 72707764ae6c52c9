// A node with PLIANT_soft_body as tissue: tetrahedra, and the surface embedded in them.
#pragma once

#include <filesystem>

#include "content/level/level.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/lattice.h"
#include "content/tets/tet_order.h"

namespace pliant {

struct SoftParts {
  BuiltMesh surface;
  TetMesh tets;                     // nodes in the order free, handle, pinned
  std::vector<std::string> notes;   // on the tetrahedra file
  std::vector<std::string> groups;  // names of the file's physical groups: of TetMesh::group, from 1 on
  bool split = false;               // its contacts are
};

// From this Poisson's ratio on, linear tetrahedra lock. A patch pressed into a block with the lattice's usual number of
// tetrahedra is over 10 % too stiff, relative to the same lattice at 0.3; 20 % at 0.49, a third at 0.499
// (tests/soft/locking_test.cpp). With kManyTets, half the cell, the same holds from the second ratio on.
inline constexpr double kLockingPoisson = 0.47, kLockingPoissonOfMany = 0.49;  // [1]
inline constexpr std::size_t kManyTets = 8 * kUsualTets;
// A sentence (without the body's name) if a body with so many tetrahedra locks; else "".
std::optional<Note> locking_doubt(const SoftBody& body, std::size_t tetrahedra);

// Conflicting extensions of a node, as text that follows "node X"; "": none.
std::optional<Note> soft_fault(const LevelNode& node);
// The part of it that depends on keys that may change while a session runs.
std::optional<Note> law_fault(const LevelNode& node);

// Fills a surface with tetrahedra as the body specifies, without embedding. Groups the nodes (handle, pinned), drops
// small parts (tet_parts.h), and fills TetReport. Errors: those of fill_surface and group_nodes, and if most of the
// tissue is in small parts because it is thinner than the cell.
struct FilledBody {
  TetMesh tets;  // all nodes in Hilbert order
  std::vector<NodeGroup> group;
};
Result<FilledBody> make_tissue(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle,
                               const std::stop_token& stop = {});
// The same with a lattice focus that differs from the author's.
Result<FilledBody> make_tissue(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle,
                               const LatticeFocus& focus, const std::stop_token& stop = {});

// `mesh`: the node's surface, or null to use the boundary of the tetrahedra file. `to_object`: the node's frame to the
// object frame. Errors: no surface, no interior, an unreadable file, boxes and paint that contain no node.
Result<SoftParts> make_soft_parts(const LevelNode& node, const LevelMesh* mesh, const mat4& to_object,
                                  const std::filesystem::path& folder);

}  // namespace pliant
