// Right-hand sides with few non-zero block rows, three at a time: unit impulses of contacts along their three axes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

struct BlockColumns {
  // Entries of the same row are summed.
  struct Entry {
    std::uint32_t row = 0;  // block row
    Block value;            // in the three columns
  };
  std::uint32_t size = 0;  // block rows
  std::vector<Entry> entries;
  std::vector<std::uint32_t> first{0};  // count() + 1: run of each three columns in `entries`

  Eigen::Index count() const { return static_cast<Eigen::Index>(first.size()) - 1; }  // of threes
  void clear(std::uint32_t block_rows) { size = block_rows, entries.clear(), first.assign(1, 0); }
  std::span<const Entry> of(Eigen::Index three) const {
    const auto at = static_cast<std::size_t>(three);
    return std::span(entries).subspan(first[at], first[at + 1] - first[at]);
  }
  void close() {
    first.push_back(static_cast<std::uint32_t>(entries.size()));
  }  // subsequent entries belong to the
     // next triple
};

// Linear combinations of scalar columns (of BlockColumns: three for each triple).
struct ColumnMix {
  struct Part {
    Eigen::Index column = 0;
    double factor = 1.0;
  };
  std::vector<Part> parts;
  std::vector<std::size_t> first{0};  // count() + 1: run of each combination in `parts`

  Eigen::Index count() const { return static_cast<Eigen::Index>(first.size()) - 1; }
  std::span<const Part> of(Eigen::Index i) const {
    const auto at = static_cast<std::size_t>(i);
    return std::span(parts).subspan(first[at], first[at + 1] - first[at]);
  }
  void close() { first.push_back(parts.size()); }  // subsequent parts belong to the next combination
};

}  // namespace pliant
