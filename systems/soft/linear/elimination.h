// Symbolic elimination of a sparse symmetric matrix of blocks: its order, and the grouping of columns. For
// block_cholesky.h; depends only on the pattern, done once. Order: approximate minimum degree on the graph of blocks
// (Amestoy, Davis, Duff 1996) or nested dissection (nested_dissection.h), whichever factor has less work: compact
// bodies gain up to half by the latter, slender ones nothing. Then a postorder of the elimination tree. Supernodes:
// runs of columns with (nearly) the same rows, merged while few zeros are included (relaxed supernodes, Ashcraft and
// Grimes 1989).
#pragma once

#include <cstdint>
#include <vector>

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

struct Supernode {
  std::uint32_t first = 0, count = 0;  // block columns, in the new order
  std::vector<std::uint32_t> below;    // block rows under them, ascending
  std::uint32_t parent = 0xffffffff;   // receives its update: the supernode that eliminates below.front()
};

double flops_of(const Supernode& supernode);  // additions and multiplications of its panel and its update

struct Elimination {
  std::vector<std::uint32_t> old_of_new, new_of_old;
  std::vector<Supernode> supernodes;  // children before parents, each subtree contiguous
  double flops = 0;                   // additions and multiplications of the factor
};

Elimination plan_elimination(const BlockMatrix& a);

}  // namespace pliant
