// Rows written by one clock and kept by another: the writer pushes into a ring and never waits; whoever owns the file
// drains the ring between ticks (lockstep) or from another thread (real time). A row that found the ring full is
// counted.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/exchange.h"

namespace pliant {

template <class Row>
class Recorder {
 public:
  explicit Recorder(std::size_t capacity) : ring_(capacity) {}

  // Writing clock. Does not allocate or wait.
  void record(const Row& row) {
    if (!ring_.push(row)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
  // Owning side: moves what has come since into `rows`.
  void drain(std::vector<Row>& rows) {
    Row row;
    while (ring_.pop(row)) rows.push_back(row);
  }
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  Ring<Row> ring_;
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace pliant
