#include "systems/soft/linear/nested_dissection.h"

#include <metis.h>

#include <mutex>
#include <numeric>

#include "runtime/assert.h"
#include "runtime/disjoint_sets.h"

namespace pliant {
namespace {

constexpr std::uint32_t kLeastPiece = 8;  // nodes; smaller pieces keep their order

// METIS draws from the C library's rand(), after it has seeded it.
std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

// Of a connected graph: neighbours of node i are next[first[i]] up to next[first[i + 1]].
std::vector<idx_t> dissect(std::vector<idx_t>& first, std::vector<idx_t>& next) {
  idx_t options[METIS_NOPTIONS], size = static_cast<idx_t>(first.size()) - 1;
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  std::vector<idx_t> old_of_new(first.size() - 1), new_of_old(first.size() - 1);
  const std::lock_guard lock(one_at_a_time());
  const int done =
      METIS_NodeND(&size, first.data(), next.data(), nullptr, options, old_of_new.data(), new_of_old.data());
  if (done != METIS_OK) std::iota(old_of_new.begin(), old_of_new.end(), idx_t{0});  // out of memory: any order is valid
  return old_of_new;
}

}  // namespace

std::vector<std::uint32_t> nested_dissection(const BlockMatrix& a) {
  DisjointSets pieces(a.size);
  for (std::uint32_t row = 0; row < a.size; ++row)
    for (std::uint32_t k = a.first[row]; k < a.first[row + 1]; ++k) pieces.join(row, a.column[k]);
  std::vector<std::vector<std::uint32_t>> members(a.size);
  for (std::uint32_t row = 0; row < a.size; ++row) members[pieces.find(row)].push_back(row);

  std::vector<std::uint32_t> order;
  std::vector<idx_t> local(a.size), first, next;
  for (const std::vector<std::uint32_t>& piece : members) {
    if (piece.size() < kLeastPiece) {
      order.insert(order.end(), piece.begin(), piece.end());
      continue;
    }
    for (std::uint32_t i = 0; i < piece.size(); ++i) local[piece[i]] = static_cast<idx_t>(i);
    first.assign(1, 0), next.clear();
    for (const std::uint32_t row : piece) {
      for (std::uint32_t k = a.first[row]; k < a.first[row + 1]; ++k)
        if (a.column[k] != row) next.push_back(local[a.column[k]]);
      first.push_back(static_cast<idx_t>(next.size()));
    }
    for (const idx_t i : dissect(first, next)) order.push_back(piece[static_cast<std::size_t>(i)]);
  }
  ASSERT(order.size() == a.size);
  return order;
}

}  // namespace pliant
