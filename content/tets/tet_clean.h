// From cells as a file has them to tetrahedra that can be simulated.
#pragma once

#include "content/tets/tet_file.h"

namespace pliant {

struct RawTets {
  std::vector<dvec3> nodes;        // finite
  std::vector<Tet> tets;           // indices below nodes.size(), any orientation
  std::size_t second_order = 0;    // cells of which only the corners were taken
  std::size_t other_cells = 0;     // points, lines, triangles, hexahedra ...: skipped
  std::vector<std::string> notes;  // of the reader
};

// Turns inverted tetrahedra, drops flat ones and nodes that none names, and notes it. Errors: nothing left, more than
// limits::kTets, a node beyond 1e9 m.
Result<TetFile> clean(RawTets raw, const std::string& name);

}  // namespace pliant
