// Disjoint sets of 0 ... n - 1, joined one by one. The lowest member represents a set. Path halving.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace pliant {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size), count_(static_cast<std::uint32_t>(size)) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --count_;
  }
  std::uint32_t count() const { return count_; }

 private:
  std::vector<std::uint32_t> parent_;
  std::uint32_t count_;
};

}  // namespace pliant
