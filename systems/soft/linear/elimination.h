// How a sparse symmetric matrix of blocks is eliminated: in which order, and which columns go together. Symbolic work
// of block_cholesky.h; depends on the pattern alone, done once.
// Order: approximate minimum degree on the graph of blocks (Amestoy, Davis, Duff 1996), then a postorder of the
// elimination tree. Supernodes: runs of columns with (nearly) the same rows, merged while few zeros are taken along
// (relaxed supernodes, Ashcraft and Grimes 1989).
#pragma once

#include <cstdint>
#include <vector>

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

struct Supernode {
  std::uint32_t first = 0, count = 0;  // block columns, in the new order
  std::vector<std::uint32_t> below;    // block rows under them, ascending
  std::uint32_t parent = 0xffffffff;   // where its update goes: the supernode that eliminates below.front()
};

struct Elimination {
  std::vector<std::uint32_t> old_of_new, new_of_old;
  std::vector<Supernode> supernodes;  // children before parents, a subtree in one run
};

Elimination plan_elimination(const BlockMatrix& a);

}  // namespace pliant
