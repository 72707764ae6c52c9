// A node with PLIANT_soft_body as tissue: tetrahedra, and the surface that rides on them.
#pragma once

#include <filesystem>

#include "content/level/level.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/lattice.h"
#include "content/tets/tet_order.h"

namespace pliant {

struct SoftParts {
  BuiltMesh surface;
  TetMesh tets;                    // nodes in the order free, handle, pinned
  std::vector<std::string> notes;  // of the tetrahedra file
};

// From this Poisson's ratio on, linear tetrahedra lock: a patch pressed into a block of the lattice's usual number of
// them meets over 10 % too much resistance beside what the same lattice has at 0.3, 20 % at 0.49, a third at 0.499
// (tests/soft/locking_test.cpp). With kManyTets, half the cell, the same is so from the second ratio on.
inline constexpr double kLockingPoisson = 0.47, kLockingPoissonOfMany = 0.49;  // [1]
inline constexpr std::size_t kManyTets = 8 * kUsualTets;
// A sentence for a body of so many tetrahedra that locks, without its name; "": it does not.
std::string locking_doubt(const SoftBody& body, std::size_t tetrahedra);

// What about a node's extensions cannot go together, as what follows "node X"; "": nothing.
std::string soft_fault(const LevelNode& node);

// Tetrahedra that fill a surface as the body's author wants it, without embedding: which of their nodes are held, what
// was too small to keep (tet_parts.h) dropped, TetReport as a whole. Errors: those of fill_surface and group_nodes, and
// that most of the tissue is in crumbs because it is thinner than the cell.
struct FilledBody {
  TetMesh tets;  // all nodes in Hilbert order
  std::vector<NodeGroup> group;
};
Result<FilledBody> make_tissue(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle,
                               const std::stop_token& stop = {});
// ... with a lattice that is finer elsewhere than the body's author says.
Result<FilledBody> make_tissue(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle,
                               const LatticeFocus& focus, const std::stop_token& stop = {});

// `mesh`: the node's surface, or null: the boundary of the tetrahedra file is taken. `to_object` takes the node's frame
// to the object frame. Errors: no surface, no inside, a file that cannot be read, boxes and paint that hold no node.
Result<SoftParts> make_soft_parts(const LevelNode& node, const LevelMesh* mesh, const mat4& to_object,
                                  const std::filesystem::path& folder);

}  // namespace pliant
