// A fill-reducing order by nested dissection: separators last. Its elimination tree has balanced subtrees, which
// threads share (block_cholesky.h). METIS (Karypis and Kumar 1998).
#pragma once

#include <cstdint>
#include <vector>

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

// old_of_new; the same for the same pattern. Any graph, also without edges and of many pieces.
std::vector<std::uint32_t> nested_dissection(const BlockMatrix& a);

}  // namespace pliant
