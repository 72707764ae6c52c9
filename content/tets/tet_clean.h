// Turns the cells of a file into tetrahedra that can be simulated.
#pragma once

#include <map>

#include "content/tets/tet_file.h"

namespace pliant {

struct RawTets {
  std::vector<dvec3> nodes;                   // finite
  std::vector<Tet> tets;                      // indices below nodes.size(), any orientation
  std::vector<std::int64_t> group;            // of each tetrahedron: the tag of its physical group, 0 none; empty: none
  std::map<std::int64_t, std::string> names;  // of groups, by tag
  std::size_t second_order = 0;               // cells of which only the corners were used
  std::size_t other_cells = 0;                // points, lines, triangles, hexahedra ...: skipped
  std::vector<std::string> notes;             // from the reader
};

// Turns inverted tetrahedra, drops flat ones and unreferenced nodes, with notes. Errors: nothing left, more than
// limits::kTets, a node beyond 1e9 m.
Result<TetFile> clean(RawTets raw, const std::string& name);

}  // namespace pliant
